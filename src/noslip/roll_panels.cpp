// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/roll_panels.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "noslip/halved_time.hpp"
#include "numerics/panel_place.hpp"
#include "trajectory/motion_at.hpp"

namespace leapmap {

template <class S>
RollPanels<S>::RollPanels(const Roll<S>& roll, double accuracy) : roll_(roll), accuracy_(accuracy) {
  using std::sqrt;
  q0_ = sqrt(-(roll.push > S(0.0) ? parabola_at_release(roll).nearer : S(-1.0)));
}

/// Relative rounding of J / E, which is all that is left of it beside an angle where E nearly vanishes.
template <class S>
double RollPanels<S>::rounding(double past, double E) const {
  if (!(E > 0.0)) return std::numeric_limits<double>::infinity();
  const double rho2 = 2.0 * value_of(roll_.hoop.rho), push2 = 2.0 * std::abs(value_of(roll_.push));
  const double terms = value_of(roll_.released) + past * (push2 + rho2 * std::min(past, 1.0));
  return 4.0 * std::numeric_limits<double>::epsilon() * terms / E;
}

template <class S>
auto RollPanels<S>::solve(Panel& panel, S& duration) const -> Excess {
  const Grid& grid = shared_panel<Grid>();
  typename Grid::Values rate;
  double unsure = 0.0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const S q = S(panel.begin) + panel.span * grid.node[i], past = angle_at(q);
    const S E = vis_viva_past_release(roll_, past),
            J = contact_inertia(roll_.hoop, trig(S(roll_.release + past)));
    rate[i] = 2.0 * panel.span * (q0_ + q) * slowness(J, E);
    panel.rate[i] = value_of(rate[i]);
    unsure = std::max(unsure, rounding(value_of(past), value_of(E)));
  }
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (!(unsure < 1.0)) return {infinite, infinite};
  panel.since = grid.integrals(rate);
  duration = grid.integral(rate);
  // Integrals are a hundred times finer than their integrands' tails (numerics/spectral.hpp).
  const auto excess = [&](double tail, double lasts) {
    return 0.25 * tail / (accuracy_ * (1.0 + lasts) + unsure * lasts);
  };
  return {excess(shared_panel<PlainGrid>().tail(panel.rate), value_of(duration)),
          excess(grid.tail(rate), largest_part(duration))};
}

template <class S>
bool RollPanels<S>::reach(double time, const S& past) {
  constexpr double longest = 2.5, shortest = 1e-13;  // [rad]
  constexpr std::size_t most_panels = 10'000;
  const auto q_at = [&](const S& x) {
    using std::sqrt;
    return x / (q0_ + sqrt(q0_ * q0_ + x));
  };
  while (!ends_ && value_of(end_) < time) {
    const double from = value_of(angle_at(S(reached_)));
    if (panels_.size() == most_panels) return false;
    Panel panel;
    panel.begin = reached_, panel.begun = end_;
    S duration;
    Excess excess;
    bool ends;
    double before = std::numeric_limits<double>::infinity();
    for (;; length_ *= 0.5) {
      ends = !(from + length_ < value_of(past));
      // Panels are stretches of q, but for the last one's end, which may have derivatives of its own.
      panel.span = ends ? q_at(past) - S(reached_) : S(value_of(q_at(S(from + length_))) - reached_);
      excess = solve(panel, duration);
      // Roundings of derivatives do not shrink with the panel.
      if (excess.all <= 1.0 || (excess.plain <= 1.0 && !(excess.all < 0.5 * before))) break;
      if (length_ < shortest) return false;
      before = excess.all;
    }
    ends_ = ends;
    panel.duration = value_of(duration);
    std::transform(panel.since.begin(), panel.since.end(), panel.times.begin(),
                   [](const S& since) { return value_of(since); });
    end_ += duration;
    reached_ += value_of(panel.span);
    length_ =
        std::min(longest, length_ * std::max(0.3, std::min(2.0, 0.85 * std::pow(excess.all, -1.0 / nodes))));
    panels_.push_back(panel);
  }
  return true;
}

template <class S>
auto RollPanels<S>::at(const S& time) const -> At {
  using std::sqrt;
  const auto after = std::upper_bound(panels_.begin(), panels_.end(), value_of(time),
                                      [](double t, const Panel& panel) { return t < value_of(panel.begun); });
  const Panel& panel = after == panels_.begin() ? panels_.front() : *std::prev(after);
  const double place = place_of_integral(shared_panel<PlainGrid>(), panel.times, panel.rate, panel.duration,
                                         value_of(time) - value_of(panel.begun));
  const S past = angle_at(S(panel.begin) + panel.span * place);
  const Trig<S> phi = trig(S(roll_.release + past));
  const S E = larger(vis_viva_past_release(roll_, past), S(0.0));
  const S spin = sqrt(E / contact_inertia(roll_.hoop, phi));
  const double acceleration = value_of(angular_acceleration(roll_.hoop, phi, spin));
  const S since = shared_panel<Grid>().template values<1>({&panel.since}, S(place))[0];
  const S late = time - panel.begun - since;
  return {past + spin * late, spin + acceleration * late, acceleration};
}

#ifdef LEAPMAP_KERNELS
template class RollPanels<double>;
template class RollPanels<FewDual>;
template class RollPanels<DesignDual>;
#endif

}  // namespace leapmap
