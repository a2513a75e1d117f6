// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/coulomb_lanes.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "support/stop.hpp"

namespace leapmap {

template <class T>
void CoulombLanes<T>::solve(std::span<const Design> designs, const Scene& scene,
                            std::span<Outcome> outcomes) {
  releases_.clear();
  for (const Design& design : designs) releases_.push_back(released<S>(design));
  run(Start::release, designs, releases_, scene, outcomes, followed_, {});
}

template <class T>
void CoulombLanes<T>::solve(Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
                            const Scene& scene, std::span<Outcome> outcomes, const GoesOn& goes_on) {
  run(start, designs, states, scene, outcomes, std::max(followed_, Followed::to_landing), goes_on);
}

template <class T>
void CoulombLanes<T>::run(Start start, std::span<const Design> designs, std::span<ContactState<S>> states,
                          const Scene& scene, std::span<Outcome> outcomes, Followed followed,
                          const GoesOn& goes_on) {
  const CoulombObserver no_observer;
  const bool lands = followed != Followed::to_lift_off;
  constexpr std::size_t width = Lanes<T>::count;
  look_at_pivots(designs, scene);
  // A call that ended by an exception leaves phases behind.
  free_.clear(), flying_.clear(), rebounding_.clear(), rolling_.clear(), sliding_.clear();
  for (std::size_t place = most_on_their_way; place-- > 0;)
    free_.push_back(static_cast<std::uint32_t>(place));
  const auto take_up = [&](std::uint32_t place, NextPhase next) {
    auto& [design, machine] = on_their_way_[place];
    while (next == NextPhase::ends) {
      const bool jumps = outcomes[design].status == Status::jumped;
      if (jumps) states[design] = machine->at();
      if (!with_times_) outcomes[design].jump_time = outcomes[design].first_jump_time = Outcome::none;
      if (!lands) outcomes[design].flight_time = Outcome::none;
      if (!with_dips_) outcomes[design].dip = Outcome::none;
      if (!jumps || !goes_on || !goes_on(design)) {
        machine.reset();
        return free_.push_back(place);
      }
      machine->put(states[design]);
      next = machine->begin(Start::landing);
    }
    go_on(place, next);
  };
  for (std::size_t unbegun = 0; unbegun < designs.size() || free_.size() < most_on_their_way;) {
    throw_if_stopped();
    while (unbegun < designs.size() && !free_.empty()) {
      const std::uint32_t place = free_.back();
      free_.pop_back();
      auto& [design, machine] = on_their_way_[place];
      design = unbegun++;
      machine.emplace(designs[design], states[design], scene, no_observer, outcomes[design], followed);
      take_up(place, machine->begin(start));
    }
    ended_.clear(), flown_.clear();
    for (const std::uint32_t place : rebounding_) {
      const PhaseMachine<S>& machine = *on_their_way_[place].machine;
      flown_.push_back({place, flight_from(machine.hoop(), machine.at())});
    }
    rebounding_.clear();
    if (flying_.size() >= width || sliding_.waiting() + rolling_.waiting() == 0)
      fly_some({T(S(lands ? HUGE_VAL : scene.hop_height)), with_dips_});
    else if (sliding_.waiting() >= width || rolling_.waiting() == 0)
      sliding_.pass(ended_);
    else
      rolling_.pass(ended_);
    for (const Flown& flown : flown_)
      take_up(flown.place, on_their_way_[flown.place].machine->after(flown.flight));
    for (const EndedPhase<S>& phase : ended_)
      take_up(phase.place, on_their_way_[phase.place].machine->after(phase.end, phase.at));
  }
}

template <class T>
void CoulombLanes<T>::look_at_pivots(std::span<const Design> designs, const Scene& scene) {
  constexpr std::size_t width = Lanes<W>::count;
  pivots_.resize(designs.size());
  for (std::size_t first = 0; first < designs.size(); first += width) {
    const std::size_t count = std::min(width, designs.size() - first);
    const auto design_of = [&](std::size_t i) -> const Design& {
      return designs[first + (i < count ? i : 0)];
    };
    const W mu_kinetic =
        gathered<W>([&](std::size_t i) { return contact_of<S>(design_of(i), scene).mu_kinetic; });
    const Hoop<W> hoop = gathered_designs<W>(design_of).hoop;
    const PivotZeros<W> zeros = pivot_zeros(hoop, mu_kinetic);
    const auto least = lanes_of(edge_looks_.least_pivot(hoop, mu_kinetic));
    for (std::size_t i = 0; i < count; ++i) pivots_[first + i].least = least[i];
    for (std::size_t k = 0; k < zeros.angle.size(); ++k) {
      const auto angles = lanes_of(zeros.angle[k]), heights = lanes_of(zeros.height[k]);
      for (std::size_t i = 0; i < count; ++i)
        pivots_[first + i].zeros.angle[k] = angles[i], pivots_[first + i].zeros.height[k] = heights[i];
    }
  }
}

template <class T>
void CoulombLanes<T>::go_on(std::uint32_t place, NextPhase next) {
  assert(next != NextPhase::ends);
  const PhaseMachine<S>& machine = *on_their_way_[place].machine;
  const Contact<S>& contact = machine.contact();
  if (next == NextPhase::leaves)
    (machine.at().normal > S(0) ? rebounding_ : flying_).push_back(place);
  else if (next == NextPhase::rolls)
    rolling_.begin(place, machine.hoop(), contact.mu_static, machine.at(), machine.runway());
  else
    sliding_.begin(place, machine.hoop(), contact.mu_kinetic, pivots_[on_their_way_[place].design],
                   machine.at(), machine.runway(), direction_of(next));
}

template <class T>
void CoulombLanes<T>::fly_some(const FlightAsked<T>& asked) {
  constexpr std::size_t width = Lanes<T>::count;
  const std::size_t count = std::min(width, flying_.size()), first = flying_.size() - count;
  if (count == 0) return;
  const auto machine_of = [&](std::size_t i) -> const PhaseMachine<S>& {
    return *on_their_way_[flying_[first + (i < count ? i : 0)]].machine;
  };
  const auto of_hoop = [&](S Hoop<S>::*member) {
    return gathered<T>([&](std::size_t i) { return machine_of(i).hoop().*member; });
  };
  const auto of_state = [&](S ContactState<S>::*member) {
    return gathered<T>([&](std::size_t i) { return machine_of(i).at().*member; });
  };
  Hoop<T> hoop{};  // of which a flight takes these
  hoop.cos_slope = of_hoop(&Hoop<S>::cos_slope), hoop.rho = of_hoop(&Hoop<S>::rho);
  hoop.aloft = of_hoop(&Hoop<S>::aloft);
  const Flight<T> flights = fly(
      hoop, LiftOff<T>{T(S(0)), of_state(&ContactState<S>::angle), of_state(&ContactState<S>::spin)}, asked);
  const auto height = lanes_of(flights.height), apex_time = lanes_of(flights.apex_time),
             flight_time = lanes_of(flights.flight_time), dip = lanes_of(flights.dip);
  for (std::size_t i = 0; i < count; ++i)
    flown_.push_back({flying_[first + i], {height[i], apex_time[i], flight_time[i], dip[i]}});
  flying_.resize(first);
}

#ifdef LEAPMAP_KERNELS
template class CoulombLanes<Batch>;
#endif

}  // namespace leapmap
