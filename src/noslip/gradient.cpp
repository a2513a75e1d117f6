// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/gradient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "hoop/units.hpp"
#include "noslip/lift_off_dual.hpp"
#include "noslip/model.hpp"
#include "noslip/way.hpp"
#include "trajectory/jump_measures.hpp"
#include "trajectory/sequence_gradient.hpp"

namespace leapmap {
namespace {

/// Times are quadratures of which the derivatives have steeper terms: they get as many nodes as there are
/// digits.
constexpr double finest = 1e-14;

/// The roll of a design of these parameters, seen from the side where it goes.
template <class D>
Roll<D> dual_roll(const std::array<D, without_slip>& parameter, const Scene& scene, const D& way = D(1.0)) {
  return begin_roll(seen(reduce(parameter, scene), way), way * parameter[by_release_angle],
                    way * parameter[by_release_spin]);
}

}  // namespace

/// A block of designs that was solved.
struct RollingGradients::Lot {
  std::span<const Design> designs;
  const Scene& scene;
  std::span<const Outcome> outcomes;
  Gradients& gradients;
  std::size_t first;  ///< the place of its first design in gradients
  double second;
  std::vector<LiftOffAt>& hard;  ///< whose times could not be told in lanes
};

RollingGradients::RollingGradients(double tolerance, const Wanted& wanted, const GradientWanted& gradients)
    : of_first_(gradients.wants(&Outcome::first_jump_height) || gradients.wants(&Outcome::first_jump_time)),
      of_time_(gradients.wants(&Outcome::jump_time)),
      of_first_time_(gradients.wants(&Outcome::first_jump_time)),
      of_dip_(gradients.wants(&Outcome::dip)),
      of_landing_(std::any_of(gradients.of.begin(), gradients.of.end(), is_measure)),
      of_way_(std::any_of(gradients.of.begin(), gradients.of.end(), is_of_way)),
      solver_(tolerance,
              [&] {
                Wanted all = wanted;
                all.landing = all.landing || of_landing_;
                all.descent = all.descent || of_landing_ || gradients.wants(&Outcome::flight_time);
                return all;
              }()),
      teller_(tolerance, {.first_jump_time = false, .jump_time = false, .descent = false, .landing = false}),
      clock_(finest) {
  of_jump_ = std::any_of(gradients.of.begin(), gradients.of.end(), [](const OutcomeNumber& quantity) {
    return quantity != &Outcome::first_jump_height && quantity != &Outcome::first_jump_time;
  });
}

void RollingGradients::solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
                             Gradients& gradients) {
  gradients.begin(designs.size());
  std::vector<LiftOffAt> lift_offs, hard;
  std::vector<std::uint32_t> turn_round;
  for (std::size_t first = 0; first < designs.size(); first += Block<T>::most_designs) {
    const std::size_t count = std::min(Block<T>::most_designs, designs.size() - first);
    const Lot lot{designs.subspan(first, count),
                  scene,
                  outcomes.subspan(first, count),
                  gradients,
                  first,
                  time_unit(scene),
                  hard};
    solver_.solve(lot.designs, scene, outcomes.subspan(first, count));
    lift_offs.clear(), hard.clear(), turn_round.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      const Outcome& outcome = lot.outcomes[i];
      const auto& found = solver_.block().found[i];
      if (of_way_ && outcome.status == Status::jumped) way(lot, i);
      if (outcome.candidates == 0 || outcome.status == Status::failed) continue;
      if (found.leg > 1) {
        turn_round.push_back(i);
        continue;
      }
      const bool jumps = outcome.status == Status::jumped, same = jumps && outcome.candidates == 1;
      if (jumps && (of_jump_ || (same && of_first_))) lift_offs.push_back({i, found.jump_angle, true, same});
      if (!same && of_first_) lift_offs.push_back({i, found.first_angle, false, true});
    }
    // Those that have about as far to roll side by side: they have the quadrature's panels in common.
    const auto half_turns = [](const LiftOffAt& at) { return std::floor(at.angle * (1.0 / pi_of<double>)); };
    if (of_time_ || of_first_time_)
      std::stable_sort(lift_offs.begin(), lift_offs.end(),
                       [&](const LiftOffAt& a, const LiftOffAt& b) { return half_turns(a) < half_turns(b); });
    for (std::size_t i = 0; i < lift_offs.size(); i += Lanes<T>::count)
      in_lanes(lot, std::span(lift_offs).subspan(i, std::min(Lanes<T>::count, lift_offs.size() - i)));
    for (const LiftOffAt& lift_off : hard) alone(lot, lift_off);
    for (const std::uint32_t design : turn_round) turning(lot, design);
  }
}

void RollingGradients::in_lanes(const Lot& lot, std::span<const LiftOffAt> lift_offs) {
  const std::size_t count = lift_offs.size();
  const auto lane_of = [&](std::size_t k) -> const LiftOffAt& { return lift_offs[k < count ? k : 0]; };
  DesignLanes<T> index, place;
  std::array<LaneArray<T>, without_slip> parameters;
  LaneArray<T> ways, angles, apexes, flights;
  unsigned jump_bits = 0, first_bits = 0;
  for (std::size_t k = 0; k < Lanes<T>::count; ++k) {
    const LiftOffAt& at = lane_of(k);
    index[k] = at.design, place[k] = static_cast<std::uint32_t>(lot.first) + at.design;
    const auto& found = solver_.block().found[at.design];
    for (std::size_t p = 0; p < without_slip; ++p)
      parameters[p][k] = lot.designs[at.design].*differentiable[p];
    parameters[by_release_angle][k] = found.way * found.release;
    ways[k] = found.way, angles[k] = at.angle;
    apexes[k] = at.jumps ? lot.outcomes[at.design].apex_time / lot.second : 0.0;
    flights[k] = at.jumps ? lot.outcomes[at.design].flight_time / lot.second : 0.0;
    if (k < count) jump_bits |= unsigned{at.jumps} << k, first_bits |= unsigned{at.first} << k;
  }
  const auto load = [](const LaneArray<T>& lanes) { return Lanes<T>::load(lanes.data()); };
  std::array<D, without_slip> parameter;
  for (std::size_t p = 0; p < without_slip; ++p) parameter[p] = D::parameter(load(parameters[p]), p);
  const T way = load(ways), angle = load(angles);
  const Roll<D> roll = dual_roll(parameter, lot.scene, D(way));
  const LiftOffDual<D> off = lift_off_at(roll, angle);

  T apex = load(apexes);
  if (jump_bits != (1u << count) - 1u) {
    const Hoop<T> hoop = plain(roll).hoop;
    const T& spin = off.spin.value;
    const MaskOf<T> driven = hoop.aloft != T(0.0);
    T found = ascend(toss_of(hoop, angle, trig(angle), spin), angle == angle).apex / spin;
    if (any(driven))
      found = select(driven, fly_driven(hoop, angle, spin, T(0.0), driven).flight.apex_time, found);
    apex = select(apex == T(0.0), found, apex);
  }
  const Trig<D> phi = trig(off.angle);
  const FlightDual<D> flight = with_derivatives(roll.hoop, phi, off.spin, D(0.0), apex, load(flights));

  const auto put_to = [&](unsigned lanes) {
    return [&lot, &place, lanes](double Outcome::*quantity, const D& value, double unit) {
      lot.gradients.put(quantity, place, lanes, value, unit);
    };
  };
  const auto put_first = put_to(first_bits), put = put_to(jump_bits);
  MaskOf<T> hard = angle != angle;
  if (first_bits != 0) put_first(&Outcome::first_jump_height, flight.height, 1.0);
  if (jump_bits != 0) {
    const D seen_from(way);
    put_jump(put, seen_from * off.angle, seen_from * off.spin, seen_from * (off.angle - roll.release), flight,
             lot.second);
    if (of_landing_)
      put_measures(measures_of(roll.hoop, off.angle, off.spin, flight.flight_time), seen_from,
                   [&](double Outcome::*kept, const D& value) { put(kept, value, 1.0); });
    if (of_dip_) {
      const T lowest = lowest_time(plain(roll).hoop, angle, off.spin.value, T(0.0), apex);
      put(&Outcome::dip, D(0.5) * height_above_plane(roll.hoop, phi, off.spin, D(lowest)).value, 1.0);
    }
  }
  if ((of_time_ && jump_bits != 0) || (of_first_time_ && first_bits != 0)) {
    const D time = time_in_lanes(index, roll, off.angle, way, hard);
    put(&Outcome::jump_time, time, lot.second);
    put_first(&Outcome::first_jump_time, time, lot.second);
  }
  const unsigned left = Lanes<T>::bits(hard);
  for (std::size_t k = 0; k < count; ++k)
    if (left >> k & 1u) lot.hard.push_back(lift_offs[k]);
}

/// As the clock reads it (noslip/clock.hpp), with the panels of all lanes one after the other.
auto RollingGradients::time_in_lanes(const DesignLanes<T>& index, const Roll<D>& roll, const D& angle,
                                     const T& way, MaskOf<T>& hard) -> D {
  using std::floor;
  const D pi(pi_of<double>);
  const Quiet<T> known = solver_.block().load_quiet<T>(index.data());
  const Quiet<D> quiet{D(known.vis_viva), D(known.distance)};
  const NodesNeeded<D> needed = clock_.needed(roll, quiet, hard);
  const T first = RollingTime<D>::first_panel(roll).value, last = floor(angle.value * T(1.0 / pi_of<double>));
  const MaskOf<T> early = last < first;
  const D span = select(early, angle - roll.release, D(first) * pi - roll.release);
  D time = clock_.stretch(roll, quiet, needed, span, hard);
  if (!all(early)) {
    const auto firsts = lanes_of(first), lasts = lanes_of(last), nodes = lanes_of(needed.panel.value);
    const unsigned by_halving = Lanes<T>::bits(hard | early);
    double from = 1e9, to = -1e9, most = 2.0;
    for (std::size_t k = 0; k < firsts.size(); ++k) {
      if (by_halving >> k & 1u) continue;
      from = std::min(from, firsts[k]), to = std::max(to, lasts[k]), most = std::max(most, nodes[k]);
    }
    for (double panel = from; panel < to; ++panel) {
      const D part = clock_.panel(roll, static_cast<long>(panel), static_cast<int>(most));
      time = select((T(panel) >= first) & (T(panel) < last) & !early, time + part, time);
    }
    const D end(select(early, first, last));
    const D rest = clock_.rest(roll, needed, end, select(early | hard, D(0.0), angle - end * pi));
    time = select(early, time, time + rest);
  }
  // As in DualTime::time.
  const MaskOf<T> at_rest = roll.released.value == T(0.0);
  const T acceleration = roll.push.value / contact_inertia(roll.hoop, roll.release_trig).value;
  time.by[by_release_spin] =
      select(at_rest, time.by[by_release_spin] - way / acceleration, time.by[by_release_spin]);
  hard = hard | (time.value != time.value);
  return time;
}

/// A time that is hard.
void RollingGradients::alone(const Lot& lot, const LiftOffAt& lift_off) {
  using S = RollingDual;
  const Design& design = lot.designs[lift_off.design];
  const auto& found = solver_.block().found[lift_off.design];
  const Roll<S> roll = dual_roll(dual_parameters<S>(design), lot.scene);
  const double angle = found.way * lift_off.angle + found.turned_back;
  const S time = time_.time(roll.hoop, roll.release, S::parameter(design.release_spin, by_release_spin), {},
                            lift_off_at(roll, angle).angle);
  const std::size_t place = lot.first + lift_off.design;
  if (lift_off.jumps) lot.gradients.put(&Outcome::jump_time, place, time, lot.second);
  if (lift_off.first) lot.gradients.put(&Outcome::first_jump_time, place, time, lot.second);
}

/// A design that turns round.
void RollingGradients::turning(const Lot& lot, std::uint32_t number) {
  using S = RollingDual;
  using std::abs;
  const Design& design = lot.designs[number];
  FoundLiftOffs told;
  Outcome outcome;
  teller_.solve({&design, 1}, lot.scene, {&outcome, 1}, &told);
  const std::size_t place = lot.first + number;
  if (!same_flags(outcome, lot.outcomes[number]) || told.lift_offs.empty()) return;

  const Roll<S> roll = dual_roll(dual_parameters<S>(design), lot.scene);
  const Hoop<S>& hoop = roll.hoop;
  const auto differentiate = [&](std::size_t i, bool jumps) {
    const S way(told.lift_offs[i].spin < 0.0 ? -1.0 : 1.0);
    // The same N at every angle, whichever way it rolls.
    LiftOffDual<S> off = lift_off_at(roll, told.lift_offs[i].angle);
    off.spin = way * off.spin;
    const Trig<S> phi = trig(off.angle);
    const double spin = abs(off.spin.value);
    const Hoop<double> ahead = seen(plain(roll).hoop, way.value);
    const LiftOff<double> lift_off{0.0, way.value * off.angle.value, spin};
    const Flight<double> flown = leapmap::fly(ahead, lift_off);
    const FlightDual<S> flight =
        with_derivatives(hoop, phi, off.spin, S(0.0), flown.apex_time, flown.flight_time);
    const auto put = [&](double Outcome::*quantity, const S& value, double unit) {
      lot.gradients.put(quantity, place, value, unit);
    };
    const bool timed = jumps ? of_time_ || (i == 0 && of_first_time_) : of_first_time_;
    const S time = timed ? time_.time(hoop, roll.release, S::parameter(design.release_spin, by_release_spin),
                                      std::span(told.turns).first(told.legs[i]), off.angle)
                         : S(0.0);
    if (i == 0) {
      put(&Outcome::first_jump_height, flight.height, 1.0);
      put(&Outcome::first_jump_time, time, lot.second);
    }
    if (!jumps) return;
    put_jump(put, off.angle, off.spin, off.angle - roll.release, flight, lot.second);
    put(&Outcome::jump_time, time, lot.second);
    if (of_landing_)
      put_measures(measures_of(hoop, off.angle, off.spin, flight.flight_time), S(1.0),
                   [&](double Outcome::*kept, const S& value) { put(kept, value, 1.0); });
    if (!of_dip_) return;
    const double lowest = lowest_time(ahead, lift_off.angle, spin, 0.0, flown.apex_time);
    put(&Outcome::dip, S(0.5) * height_above_plane(hoop, phi, off.spin, S(lowest)).value, 1.0);
  };
  const bool jumps = outcome.status == Status::jumped;
  const std::size_t last = told.lift_offs.size() - 1;
  if (jumps) differentiate(last, true);
  if (!(jumps && last == 0)) differentiate(0, false);
}

/// What the way to a jump asks: once more, to be told where it turns round.
void RollingGradients::way(const Lot& lot, std::uint32_t number) {
  using S = RollingDual;
  const Design& design = lot.designs[number];
  FoundLiftOffs found;
  Outcome outcome;
  teller_.solve({&design, 1}, lot.scene, {&outcome, 1}, &found);
  if (!same_flags(outcome, lot.outcomes[number])) return;
  const Roll<S> roll = dual_roll(dual_parameters<S>(design), lot.scene);
  const S spin = S::parameter(design.release_spin, by_release_spin);
  put_way(way_to(roll, spin, found, lift_off_at(roll, found.lift_offs.back().angle).angle),
          [&](double Outcome::*quantity, const S& value) {
            lot.gradients.put(quantity, lot.first + number, value);
          });
}

namespace noslip {

GradientSolver gradients(const Scene& scene, double tolerance, const Wanted& wanted,
                         const GradientWanted& asked) {
  const GradientSolver first = [solver = std::make_shared<RollingGradients>(tolerance, wanted, asked), scene](
                                   std::span<const Design> designs, std::span<Outcome> outcomes,
                                   Gradients& gradients) {
    solver->solve(designs, scene, outcomes, gradients);
  };
  if (scene.jumps == 1) return first;
  return in_sequence(first, jumps(scene, tolerance, wanted), dual_jumps(scene, tolerance), scene);
}

}  // namespace noslip
}  // namespace leapmap
