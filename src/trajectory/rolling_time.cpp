// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/rolling_time.hpp"

namespace leapmap {
namespace {

template <class T>
const T pi_of = T(std::numbers::pi_v<ScalarOf<T>>);

/// sqrt(J / E) = dt / dphi.
template <class T>
T slowness(const T& inertia, const T& vis_viva) {
  return inertia * reciprocal_sqrt(inertia * vis_viva);
}

/// acosh(1 + x), as well as is needed to choose a number of nodes.
template <class T>
T strip_of(const T& x) {
  using std::log, std::sqrt;
  return log(T(1) + x + sqrt(x * (x + T(2))));
}

/// The growth r of the ellipse about a panel of half-length `half` that touches a point `height` beside the panel's
/// end, or beside any point of it.
template <class T>
T growth_beside_end(const T& height, const T& half) {
  using std::sqrt;
  const T e = height / half, sum = e + sqrt(T(4) + e * e);
  return T(0.5) * (sum + sqrt(sum * sum - T(4)));
}
template <class T>
T growth_beside(const T& height, const T& half) {
  using std::sqrt;
  const T e = height / half;
  return e + sqrt(T(1) + e * e);
}

template <class T>
ScalarOf<T> least_of(const T& value, const MaskOf<T>& among, ScalarOf<T> start) {
  std::array<ScalarOf<T>, Lanes<T>::count> lanes;
  Lanes<T>::store(select(among, value, T(start)), lanes.data());
  return *std::min_element(lanes.begin(), lanes.end());
}
template <class T>
ScalarOf<T> most_of(const T& value, const MaskOf<T>& among, ScalarOf<T> start) {
  return -least_of(-value, among, -start);
}

}  // namespace

template <class T>
RollingTime<T>::RollingTime(double tolerance) {
  using std::log, std::max;
  tolerance_ = max(S(tolerance) * S(0.03L), std::numeric_limits<S>::epsilon());
  digits_ = -log(tolerance_);
  panels_.resize(most_nodes + 1);
  for (std::size_t n = 2; n <= most_nodes; ++n) {
    Panels& panels = panels_[n];
    panels.rule = gauss_rule<S>(n);
    for (int half = 0; half < 2; ++half)
      for (std::size_t i = 0; i < n; ++i) {
        panels.angle.push_back(pi_of<S> * (S(half) + panels.rule.node[i]));
        panels.weight.push_back(pi_of<S> * panels.rule.weight[i]);
        panels.trig.push_back(trig(panels.angle.back()));
      }
  }
}

/// The number of nodes that all lanes together need, given each one's growth r.
template <class T>
int RollingTime<T>::nodes_for(const T& growth, MaskOf<T>& hard) const {
  using std::log;
  const T need = T(digits_ * S(0.5L)) / log(growth) + T(2);
  const MaskOf<T> too_many = !(need < T(S(most_nodes + 1)));
  hard = hard | too_many;
  return std::max(2, static_cast<int>(most_of(need, !hard, S(2))));
}

/// From the release to `end`, at most a turn and a bit further, in x = x1 + q^2.
template <class T>
T RollingTime<T>::stretch(const Roll<T>& roll, const T& strip, const T& end, MaskOf<T>& hard) const {
  using std::floor, std::sqrt;
  const Hoop<T>& hoop = roll.hoop;
  const T bend = -hoop.rho * cos_from_vertical(hoop, roll.release_trig);
  const T discriminant = roll.push * roll.push - roll.released * bend;
  const T root = sqrt(larger(discriminant, T(0)));
  const MaskOf<T> real = discriminant >= T(0);
  // Without real zeros E is far from zero if its least value is, over the distance that takes: x1 = -1 will do then.
  const T x1 = select(real, -roll.released / (roll.push + root), T(-1));
  hard = hard | !(roll.push > T(0)) | !(real | (-discriminant > T(4) * bend * bend));

  const T span = end - roll.release;
  const T q0 = sqrt(-x1), q1 = sqrt(span - x1), half = T(0.5) * (q1 - q0);
  // The other zero, x2 < x1 where bend > 0: the ellipse through it has the sum of distances to the panel's ends.
  const T x2 = select(real & (bend > T(0)), -(roll.push + root) / bend, T(-1e6));
  const T sum = larger((sqrt(-x2) + sqrt(span - x2)) / half, T(2));
  const T behind = T(0.5) * (sum + sqrt(sum * sum - T(4)));
  const T needle = T(2) * pi_of<T> * (floor(roll.release / (T(2) * pi_of<T>)) + T(1)) - roll.release;
  const T height = T(0.5) * strip / q1;
  const T ahead = select(needle > span * T(0.999), growth_beside_end(height, half), growth_beside(height, half));
  const int n = nodes_for(smaller(behind, ahead), hard);

  const GaussRule<S>& rule = panels_[static_cast<std::size_t>(n)].rule;
  T total(0);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const T q = q0 + (q1 - q0) * T(rule.node[i]);
    const T x = x1 + q * q;
    const Trig<T> turned = trig(x);
    const T versine = roll.release_trig.versine * turned.cos + turned.versine + roll.release_trig.sin * turned.sin;
    const T E = vis_viva_past_release(roll, x, turned, x_minus_sin(x, turned.sin));
    total = total + T(rule.weight[i]) * q * slowness(hoop.J_min + T(2) * hoop.rho * versine, E);
  }
  return T(2) * (q1 - q0) * total;
}

template <class T>
T RollingTime<T>::from_release(const Roll<T>& roll, const T& quiet, const T& angle, Clock<T>& clock,
                               MaskOf<T>& hard) const {
  const T rho2 = T(2) * roll.hoop.rho;
  const T first = first_panel(roll), edge = first * pi_of<T>;
  const T strip = smaller(strip_of(roll.hoop.J_min / rho2), strip_of(quiet / rho2));
  clock = {first, stretch(roll, strip, smaller(edge, angle), hard)};
  const MaskOf<T> beyond = angle > edge;
  if (!any(beyond)) return clock.time;
  return select(beyond, onward(roll, quiet, angle, clock, hard), clock.time);
}

template <class T>
T RollingTime<T>::onward(const Roll<T>& roll, const T& quiet, const T& angle, Clock<T>& clock,
                         MaskOf<T>& hard) const {
  using std::floor;
  const Hoop<T>& hoop = roll.hoop;
  const T pi = pi_of<T>, rho2 = T(2) * hoop.rho;
  const T needle = strip_of(hoop.J_min / rho2), strip = strip_of(quiet / rho2);
  const T last = larger(floor(angle / pi), clock.panel);

  // Half-turns, their nodes shared.
  const T half = T(0.5) * pi;
  const int n = nodes_for(smaller(growth_beside_end(needle, half), growth_beside(strip, half)), hard);
  const Panels& panels = panels_[static_cast<std::size_t>(n)];
  const auto begin = static_cast<long>(least_of(clock.panel, !hard, S(1e15))),
             end = static_cast<long>(most_of(last, !hard, S(-1e15)));
  const T gain = T(2) * hoop.sin_slope;
  const T swing = rho2 * hoop.cos_slope, sway = rho2 * hoop.sin_slope;
  for (long panel = begin; panel < end; ++panel) {
    const MaskOf<T> inside = (T(S(panel)) >= clock.panel) & (T(S(panel)) < last);
    const long odd = panel & 1;
    const T level = roll.level + gain * T(pi_of<S> * S(panel - odd));
    const auto first = static_cast<std::size_t>(odd * n);
    T sum(0);
    for (std::size_t i = first; i < first + static_cast<std::size_t>(n); ++i) {
      const Trig<S>& phi = panels.trig[i];
      const T E = level + gain * T(panels.angle[i]) + swing * T(phi.cos) - sway * T(phi.sin);
      sum = sum + T(panels.weight[i]) * slowness(hoop.J_min + rho2 * T(phi.versine), E);
    }
    clock.time = clock.time + select(inside, sum, T(0));
  }
  clock.panel = last;

  // The rest of the last one.
  const T edge = last * pi, rest = angle - edge;
  const T half_rest = larger(T(0.5) * rest, T(1e-3));
  const int m = nodes_for(smaller(growth_beside_end(needle, half_rest), growth_beside(strip, half_rest)), hard);
  const GaussRule<S>& rule = panels_[static_cast<std::size_t>(m)].rule;
  T sum(0);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const T at = edge + rest * T(rule.node[i]);
    const Trig<T> phi = trig(at);
    sum = sum + T(rule.weight[i]) * slowness(contact_inertia(hoop, phi), vis_viva(roll, at, phi));
  }
  return clock.time + sum * rest;
}

template <class T>
ScalarOf<T> RollingTime<T>::halving(const Roll<S>& roll, const S& from, const S& to) const {
  using std::abs, std::floor, std::sqrt;
  const GaussRule<S>& gauss = panels_[std::min<std::size_t>(most_nodes, 6 + static_cast<std::size_t>(digits_ / 2))].rule;
  const auto rule = [&](const auto& f, S a, S b) {
    S sum(0);
    for (std::size_t i = 0; i < gauss.node.size(); ++i) sum += gauss.weight[i] * f(a + (b - a) * gauss.node[i]);
    return sum * (b - a);
  };
  S total(0);
  const auto halve = [&](const auto& self, const auto& f, S a, S b, S whole, int depth) -> void {
    const S middle = a + (b - a) * S(0.5L);
    const S left = rule(f, a, middle), right = rule(f, middle, b);
    if (depth == 0 || abs(left + right - whole) <= S(0.1L) * tolerance_ * (total + left + right)) {
      total += left + right;
      return;
    }
    self(self, f, a, middle, left, depth - 1);
    self(self, f, middle, b, right, depth - 1);
  };
  constexpr int most_halvings = 60;

  const Hoop<S>& hoop = roll.hoop;
  const S bend = -hoop.rho * cos_from_vertical(hoop, roll.release_trig);
  const S discriminant = roll.push * roll.push - roll.released * bend;
  const S x1 = discriminant >= S(0) && roll.push > S(0) ? -roll.released / (roll.push + sqrt(discriminant)) : S(-1);
  const auto past_release = [&](S q) {
    const S x = x1 + q * q;
    return S(2) * q * slowness(contact_inertia(hoop, trig(roll.release + x)), vis_viva_past_release(roll, x));
  };
  const auto at_angle = [&](S angle) {
    const Trig<S> phi = trig(angle);
    return slowness(contact_inertia(hoop, phi), vis_viva(roll, angle, phi));
  };
  S a = from;
  if (a < roll.release + S(1)) {
    const S b = std::min(to, roll.release + S(1));
    const S q0 = sqrt(a - roll.release - x1), q1 = sqrt(b - roll.release - x1);
    halve(halve, past_release, q0, q1, rule(past_release, q0, q1), most_halvings);
    a = b;
  }
  const S eighth = pi_of<S> / S(4);
  while (a < to) {
    const S b = std::min(to, (floor(a / eighth + S(1e-9L)) + S(1)) * eighth);
    halve(halve, at_angle, a, b, rule(at_angle, a, b), most_halvings);
    a = b;
  }
  return total;
}

template class RollingTime<double>;
template class RollingTime<long double>;
template class RollingTime<Batch>;

}  // namespace leapmap
