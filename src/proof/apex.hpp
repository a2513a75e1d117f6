// SPDX-License-Identifier: GPL-3.0-or-later
/// How high a flight goes, enclosed for all designs of a box.
#pragma once

#include "proof/forms.hpp"
#include "proof/motion.hpp"
#include "proof/zeros.hpp"

namespace leapmap {

/// Thrown where something cannot be decided for all designs alike.
struct Undecided {
  const char* event;  ///< what is too near, in words
};

/// No hoop of the box comes higher than that, in any interval from a time on [hoop diameters].
template <std::size_t N>
double most_height(const Forms<N>& forms, const Both<TakingOff, N>& off, double from = 0.0);

/// The apex of the first interval in which a hoop is above the plane [hoop diameters]; 0: it never is.
/// Throws Undecided.
template <std::size_t N>
BothNumbers<N> apex_height(const Forms<N>& forms, const Both<TakingOff, N>& off);

namespace apex_detail {

inline constexpr const char* grazes = "a flight that grazes the plane";

/// The height lies between two parabolas 2 rho apart, as the centre is no farther than rho from the centre of
/// mass: P - rho <= y <= P + rho, P = -rho cos(phi) + rise t - fall t^2 / 2.
struct Arc {
  double end;                   ///< after it every hoop is below the plane
  double above_from, above_to;  ///< between them every hoop is above; from >= to: nowhere
  Ball vertex, reach;           ///< the highest apex is no farther than reach from the vertex
};
template <class D>
Arc arc_of(const TakingOff<D>& off) {
  const Ball rho = off.hoop.rho.value, fall = off.hoop.cos_slope.value,
             rise = rho * off.phi.sin.value * off.spin.value, square = rise * rise,
             high = Ball(2) * fall * rho;
  const Ball below = sqrt(square + high * off.phi.versine.value);
  Arc arc{.end = ((abs(rise) + below) / fall).upper() * 1.001,
          .above_from = 0.0,
          .above_to = 0.0,
          .vertex = rise / fall,
          .reach = Ball(2) * sqrt(rho / fall)};
  arc.above_from = arc.above_to = arc.end;
  if (const Ball above = square - high * (Ball(2) - off.phi.versine.value);
      above > Ball(0) && rise > Ball(0)) {
    arc.above_from = ((rise - sqrt(above)) / fall).upper();
    arc.above_to = ((rise + sqrt(above)) / fall).lower();
    if (!(arc.above_from < arc.above_to)) arc.above_from = arc.above_to = arc.end;
  }
  return arc;
}

/// The larger of two numbers, whose derivative is one of theirs.
template <std::size_t N>
BothNumbers<N> higher(const BothNumbers<N>& a, const BothNumbers<N>& b) {
  const auto larger_of = [](const Ball& x, const Ball& y) {
    if (!x.is_finite() || !y.is_finite()) return x + y;  // not known
    if (x > y) return x;
    if (y > x) return y;
    return Ball::between(std::max(x.lower(), y.lower()), std::max(x.upper(), y.upper()));
  };
  if (a.all.value > b.all.value) return a;
  if (b.all.value > a.all.value) return b;
  BothNumbers<N> most{BoxDual<N>(larger_of(a.all.value, b.all.value)), larger_of(a.middle, b.middle)};
  for (std::size_t k = 0; k < N; ++k) most.all.by[k + 1] = hull(a.all.by[k + 1], b.all.by[k + 1]);
  return most;
}

/// The pieces in which a flight is looked at, in times.
struct Steps {
  double step, smallest;

  template <std::size_t N>
  static Steps of(const Both<TakingOff, N>& off, const Arc& arc) {
    constexpr double angle_step = 0.4;
    const double fastest = (abs(off.all.spin.value) + abs(off.all.hoop.aloft.value) * Ball(arc.end)).upper();
    const double step = std::min(angle_step / fastest, arc.end / 6.0);
    return {step, step * (N == 0 ? 1e-9 : 0.02)};
  }
};

template <class F, std::size_t N>
auto search(const Forms<N>& forms, const Both<TakingOff, N>& off, const Steps& steps, double from,
            double to) {
  constexpr double most_pieces = 200'000.0;
  if (!((to - from) / steps.step < most_pieces)) throw Undecided{"a flight of too many turns"};
  return ZeroSearch([&](double a, double b) { return forms.range(F{}, off, a, b); }, from, to, steps.step,
                    steps.smallest);
}

/// Where every hoop is above the plane for the first time; none: no hoop ever is.
///
/// A flight begins with y = y' = 0. While y'' only grows, or has grown through zero and stays above it, y is
/// below the plane at most at first and then rises for good: where it is above zero it has crossed once.
template <std::size_t N>
std::optional<double> rise_of(const Forms<N>& forms, const Both<TakingOff, N>& off, const Steps& steps,
                              const Arc& arc) {
  const auto height_at = [&](double t) { return forms.range(Height{}, off, t, t).value.sign(); };
  // How long y'' has turned upwards, and no more than that.
  double upwards = 0.0, from = 0.0;
  auto bends = search<Bend>(forms, off, steps, 0.0, arc.end);
  int sign = forms.range(Bend{}, off, 0.0, 0.0).value.sign();
  auto bend = bends.next();
  if (bend && bend->from == 0.0 && bend->slope > 0 && bend->after < 0) sign = -1, bend = bends.next();
  if (bend && bend->slope > 0 && bend->after > 0 && (sign < 0 || bend->from == 0.0))
    sign = 1, bend = bends.next();
  if (sign > 0) {
    upwards = bend ? bend->from : arc.end;
    constexpr int looks = 8;
    for (int k = 1; k <= looks; ++k)
      if (const double t = upwards * static_cast<double>(k) / looks; height_at(t) > 0) return t;
    if (height_at(upwards) == 0) throw Undecided{grazes};
    from = upwards;
  } else if (sign < 0) {
    from = bend ? bend->from : arc.end;
    if (from == 0.0) throw Undecided{grazes};
  } else {
    throw Undecided{"a flight that only just begins"};
  }
  // Below the plane there, and may rise later.
  const auto rises = search<Height>(forms, off, steps, from, arc.end).next();
  if (!rises) return {};
  if (!rises->is_root()) throw Undecided{grazes};
  return rises->to;
}

}  // namespace apex_detail

template <std::size_t N>
BothNumbers<N> apex_height(const Forms<N>& forms, const Both<TakingOff, N>& off) {
  using namespace apex_detail;
  const Arc arc = arc_of(off.all);
  const Steps steps = Steps::of(off, arc);
  const auto rise = rise_of(forms, off, steps, arc);
  if (!rise) return {BoxDual<N>(Ball(0)), Ball(0)};
  double from = *rise;
  const auto sinks_between = [&](double a, double b) {
    return a < b ? search<Height>(forms, off, steps, a, b).next() : std::nullopt;
  };
  auto sinks = sinks_between(from, arc.above_from);
  if (!sinks) sinks = sinks_between(std::max(from, arc.above_to), arc.end);
  if (!sinks) throw Undecided{grazes};
  // Some may touch the plane there and fly on.
  const bool lands = sinks->falls();
  double to = lands ? sinks->to : sinks->from;
  if (Ball(from) <= arc.vertex && arc.vertex <= Ball(to)) {
    from = std::max(from, (arc.vertex - arc.reach).lower());
    to = std::min(to, (arc.vertex + arc.reach).upper());
  }

  std::optional<BothNumbers<N>> most;
  const auto add = [&](const BothNumbers<N>& peak) { most = most ? higher(*most, peak) : peak; };
  auto climbs = search<Climb>(forms, off, steps, from, to);
  while (const auto turn = climbs.next()) {
    if (turn->slope > 0) continue;
    Ball when = Ball::between(turn->from, turn->to), when_middle = when;
    if (turn->falls()) {
      const BothNumbers<N> at = forms.zero(Climb{}, off, turn->from, turn->to);
      when = at.all.value, when_middle = at.middle;
    }
    // y' is zero there: by the parameters the height changes as it does at a fixed time.
    add(forms.narrowed(Height{}(off.all, BoxDual<N>(when)).value, Height{}(off.middle, when_middle).value));
  }
  if (!most) throw Undecided{grazes};
  if (!lands && !(most->all.value > Ball(2.0 * most_height(forms, off, sinks->from))))
    throw Undecided{grazes};
  const auto half = [](const auto& number) { return number * Ball(0.5); };
  return {half(most->all), half(most->middle)};
}

template <std::size_t N>
double most_height(const Forms<N>& forms, const Both<TakingOff, N>& off, double from) {
  using namespace apex_detail;
  const Arc arc = arc_of(off.all);
  const Steps steps = Steps::of(off, arc);
  constexpr double most_pieces = 2'000.0;
  const double length = arc.end - from, pieces = std::ceil(length / steps.step);
  if (!(pieces < most_pieces)) return HUGE_VAL;
  double most = 0.0;
  for (double k = 0.0; k < pieces; ++k) {
    const double begin = from + length * (k / pieces), end = from + length * ((k + 1.0) / pieces);
    const double here = forms.range(Height{}, off, begin, end).value.upper();
    if (std::isnan(here)) return HUGE_VAL;
    most = std::max(most, here);
  }
  return 0.5 * most;
}

}  // namespace leapmap
