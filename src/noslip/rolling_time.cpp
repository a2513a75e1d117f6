// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/rolling_time.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "noslip/halved_time.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

constexpr std::size_t most_starts = 64;  // beyond it the spans met are forgotten: memory stays bounded

/// The square of acosh(1 + x), from below; within 1 % for x < 1. Without a logarithm: it is only for node
/// numbers.
template <class T>
T square_acosh(const T& x) {
  return T(12) * x / (T(6) + x);
}

/// The square of log(r), of the ellipse about a panel through a point beside its end, or beside its middle;
/// from below. `height` is the point's distance from the panel over its half-length.
template <class T>
T square_growth_beside_end(const T& height) {
  using std::sqrt;
  return square_acosh(T(0.5) * (height + sqrt(T(4) + height * height)) - T(1));
}
template <class T>
T square_growth_beside(const T& height) {
  const T square = height * height;
  return T(3) * square / (T(3) + square);  // of asinh(height)
}

/// The rule of n nodes, at most RollingTime's most, worked out when a thread first asks for it and then kept.
template <class S>
const GaussRule<S>& rule_of(std::size_t n) {
  static std::array<std::atomic<const GaussRule<S>*>, RollingTime<S>::most_nodes + 1> kept{};
  const GaussRule<S>* rule = kept[n].load(std::memory_order_acquire);
  if (rule) return *rule;
  auto made = std::make_unique<const GaussRule<S>>(gauss_rule<S>(n));
  // Another thread may have been first: then `rule` becomes its.
  if (kept[n].compare_exchange_strong(rule, made.get(), std::memory_order_acq_rel)) rule = made.release();
  return *rule;
}

}  // namespace

template <class T>
RollingTime<T>::RollingTime(double tolerance) : starts_(most_nodes + 1), panels_(2 * (most_nodes + 1)) {
  using std::log;
  // A hundred times finer than asked for costs a few nodes, and the bounds on r are not strict in every
  // corner.
  tolerance_ = std::max(S(tolerance) * S(0.01L), S(450) * std::numeric_limits<S>::epsilon());
  digits_ = -log(tolerance_);
}

/// The number of nodes for a panel whose r has this square of its logarithm.
template <class T>
T RollingTime<T>::nodes_for(const T& square_growth, MaskOf<T>& hard) const {
  const T need = T(digits_ * S(0.5L)) * reciprocal_sqrt(square_growth) + T(2);
  const MaskOf<T> too_many = !(need < T(S(most_nodes + 1)));
  hard = hard | too_many;
  return select(too_many, T(2), need);
}

template <class T>
NodesNeeded<T> RollingTime<T>::needed(const Roll<T>& roll, const Quiet<T>& quiet, MaskOf<T>& hard) const {
  using std::sqrt;
  const T per_rho = T(1) / (T(2) * roll.hoop.rho);
  NodesNeeded<T> nodes;
  nodes.needle = sqrt(square_acosh(roll.hoop.J_min * per_rho));
  nodes.strip = sqrt(square_acosh(larger(quiet.vis_viva, T(0)) * per_rho));
  nodes.panel = nodes_for_length(nodes, T(pi_of<S>), hard);
  return nodes;
}

/// For a stretch of angle whose ends are as near to needles as can be.
template <class T>
T RollingTime<T>::nodes_for_length(const NodesNeeded<T>& needed, const T& length, MaskOf<T>& hard) const {
  const T per_half = T(2) / length;
  return nodes_for(smaller(square_growth_beside_end(needed.needle * per_half),
                           square_growth_beside(needed.strip * per_half)),
                   hard);
}

template <class T>
T RollingTime<T>::stretch(const Roll<T>& roll, const Quiet<T>& quiet, const NodesNeeded<T>& needed,
                          const T& span, MaskOf<T>& hard) {
  using std::floor;
  const MaskOf<T> slowing = !(roll.push > T(0));
  if (any(slowing)) {  // E is least ahead of the release, not behind it: there is nothing to take out
    const T turns = floor(roll.release / (T(2) * pi_of<T>)), half = T(0.5) * span;  // half: less than pi
    const T from = roll.release - T(2) * pi_of<T> * turns;
    MaskOf<T> too_hard = !(quiet.vis_viva > T(0));
    const T plainly = between(roll, needed, T(2) * turns, from, half, too_hard) +
                      between(roll, needed, T(2) * turns, from + half, half, too_hard);
    MaskOf<T> others_hard(false);
    const T others = all(slowing) ? plainly : stretched(roll, quiet, needed, span, others_hard);
    hard = hard | (slowing & too_hard) | ((!slowing) & others_hard);
    return select(slowing, plainly, others);
  }
  return stretched(roll, quiet, needed, span, hard);
}

/// Where E rises from the release on.
template <class T>
T RollingTime<T>::stretched(const Roll<T>& roll, const Quiet<T>& quiet, const NodesNeeded<T>& needed,
                            const T& span, MaskOf<T>& hard) {
  using std::floor, std::sqrt;
  const auto [bend, discriminant, root, real, x1] = parabola_at_release(roll);
  hard = hard | !(real | (-discriminant > T(4) * bend * bend));

  const T q0 = sqrt(-x1), q1 = sqrt(span - x1);
  const T reach = span / (q0 + q1), half = T(0.5) * reach;  // q1 - q0, which would cancel for a fast release
  // The other zero, x2 < x1 where bend > 0: the ellipse through it has the sum of distances to the panel's
  // ends.
  const T x2 = select(real & (bend > T(0)), -(roll.push + root) / bend, T(-1e6));
  const T behind = square_acosh(larger((sqrt(-x2) + sqrt(span - x2)) / (T(2) * half) - T(1), T(0)));
  // Needles and the quiet place come nearer by the map: an x + i d beside x is d / (2 q) beside q.
  const T behind_by = roll.release - T(2) * pi_of<T> * floor(roll.release / (T(2) * pi_of<T>));
  const T nearer = T(0.5) / (q1 * half);
  const auto ahead = [&](const T& distance, const T& height) {
    return select(distance > span * T(0.999), square_growth_beside_end(height * nearer),
                  square_growth_beside(height * nearer));
  };
  T growth = smaller(behind, smaller(ahead(T(2) * pi_of<T> - behind_by, needed.needle),
                                     ahead(quiet.distance, needed.strip)));
  if (any(behind_by < T(1))) {  // a needle just behind the release
    const T u = -behind_by - x1, d = needed.needle;
    growth = smaller(growth, square_growth_beside(sqrt(T(0.5) * (sqrt(u * u + d * d) - u)) / half));
  }
  const auto nodes = lanes_of(nodes_for(growth, hard));
  const int n = static_cast<int>(*std::max_element(nodes.begin(), nodes.end()));

  const PastRelease<T> past = past_release(roll);
  const S first_span = lanes_of(span)[0];
  T total(0);
  if (all((q0 == T(0)) & (span == T(first_span)))) {
    for (const SharedNode& node : start_from_rest(first_span, n))
      total = total + node.weight * past.slowness_at(node.x, node.trig, node.x_less_sin);
    if constexpr (has_derivatives<T>) {  // of the span, which the nodes do not have
      const auto at_end =
          value_of(past.slowness_at(first_span, trig(first_span), x_minus_sin(first_span, trig(first_span))));
      total = total + span.through(at_end - at_end, at_end);
    }
    return total;
  }
  const GaussRule<S>& rule = rule_of<S>(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const T q = reach * rule.node[i], x = q * (T(2) * q0 + q);  // q: less q0
    const Trig<T> turned = trig(x);
    total = total + rule.weight[i] * (q0 + q) * past.slowness_at(x, turned, x_minus_sin(x, turned));
  }
  return T(2) * reach * total;
}

template <class T>
const std::vector<typename RollingTime<T>::SharedNode>& RollingTime<T>::start_from_rest(const S& span,
                                                                                        int nodes) {
  using std::sqrt;
  std::vector<Start>& starts = starts_[static_cast<std::size_t>(nodes)];
  const auto met =
      std::find_if(starts.begin(), starts.end(), [&](const Start& start) { return start.span == span; });
  if (met != starts.end()) return met->nodes;
  if (starts.size() >= most_starts) starts.clear();
  Start& start = starts.emplace_back(Start{span, {}});
  const GaussRule<S>& rule = rule_of<S>(static_cast<std::size_t>(nodes));
  const S q1 = sqrt(span);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const S q = q1 * rule.node[i], x = q * q;
    const Trig<S> turned = trig(x);
    start.nodes.push_back({S(2) * q1 * q * rule.weight[i], x, x_minus_sin(x, turned), turned});
  }
  return start.nodes;
}

template <class T>
T RollingTime<T>::panel(const Roll<T>& roll, long panel, int nodes) {
  const long odd = panel & 1;
  std::vector<SharedNode>& shared = panels_[static_cast<std::size_t>(2 * nodes + odd)];
  if (shared.empty()) {
    const GaussRule<S>& rule = rule_of<S>(static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const S x = pi_of<S> * (S(odd) + rule.node[i]);
      shared.push_back({pi_of<S> * rule.weight[i], x, S(0), trig(x)});
    }
  }
  const Hoop<T>& hoop = roll.hoop;
  const T gain = T(2) * hoop.thrust, rho2 = T(2) * hoop.rho;
  const T swing = rho2 * hoop.cos_slope, sway = rho2 * hoop.sin_slope;
  const T level = roll.level + gain * T(pi_of<S> * S(panel - odd));
  T total(0);
  for (const SharedNode& node : shared) {
    const T E = level + gain * node.x + swing * node.trig.cos - sway * node.trig.sin;
    total = total + node.weight * slowness(T(hoop.J_min + rho2 * node.trig.versine), E);
  }
  return total;
}

template <class T>
T RollingTime<T>::rest(const Roll<T>& roll, const NodesNeeded<T>& needed, const T& panel,
                       const T& length) const {
  using std::floor;
  MaskOf<T> hard = length != length;
  const T even = T(2) * floor(panel * T(0.5));
  return between(roll, needed, even, (panel - even) * T(pi_of<S>), length, hard);
}

/// From an angle past `even` pi over no more than a half-turn. By a rule of an even number of nodes: those at
/// +x and -x from the middle share their sine and cosine.
template <class T>
T RollingTime<T>::between(const Roll<T>& roll, const NodesNeeded<T>& needed, const T& even, const T& from,
                          const T& length, MaskOf<T>& hard) const {
  const auto need = lanes_of(nodes_for_length(needed, larger(length, T(1e-3)), hard));
  const auto half_of_nodes = (static_cast<std::size_t>(*std::max_element(need.begin(), need.end())) + 1) / 2;
  const GaussRule<S>& rule = rule_of<S>(2 * half_of_nodes);

  const Hoop<T>& hoop = roll.hoop;
  const T pi(pi_of<S>), half = T(0.5) * length, from_edge = from + half;
  const Trig<T> phi = trig(from_edge);
  const T gain = T(2) * hoop.thrust, rho2 = T(2) * hoop.rho;
  const T level = roll.level + gain * (even * pi + from_edge);
  const T swing = rho2 * cos_from_vertical(hoop, phi), sway = rho2 * sin_from_vertical(hoop, phi);
  const T J_mean = hoop.J_min + rho2, J_cos = rho2 * phi.cos, J_sin = rho2 * phi.sin;
  T total(0);
  for (std::size_t i = half_of_nodes; i < rule.node.size(); ++i) {
    const T x = half * (S(2) * rule.node[i] - S(1));  // up to pi / 2
    const SinCos<T> part = sincos_of_small(x * T(0.5));
    const T sine = T(2) * part.sin * part.cos, versine = T(2) * part.sin * part.sin, cosine = T(1) - versine;
    const T E = level + swing * cosine, E_odd = gain * x - sway * sine;
    const T J = J_mean - J_cos * cosine, J_odd = J_sin * sine;
    total = total + rule.weight[i] * (slowness(J + J_odd, E + E_odd) + slowness(J - J_odd, E - E_odd));
  }
  return length * total;
}

template <class T>
ScalarOf<T> RollingTime<T>::halving_past(const Roll<S>& roll, const S& past) const {
  // The last resort of hard designs, so that a loose tolerance saves no nodes here: too few would miss a
  // spike.
  return HalvedTime<S>(roll, std::min(tolerance_, S(1e-8L)), rule_of<S>(sizeof(S) > 8 ? 30 : 20)).until(past);
}

template class RollingTime<double>;
#ifdef LEAPMAP_KERNELS
template class RollingTime<Batch>;
template class RollingTime<LanesDual>;
#endif
#ifdef LEAPMAP_SCALARS
template class RollingTime<long double>;
#endif

}  // namespace leapmap
