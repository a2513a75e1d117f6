// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/coulomb.hpp"

#include "friction/coulomb_automaton.hpp"

namespace leapmap {

template <class S>
Outcome CoulombSolver<S>::solve(Start start, const Design& design, ContactState<S>& from, const Scene& scene,
                                const CoulombObserver& observer, std::vector<RecordedSlide<S>>* slides) {
  return go_through_phases<S>(
      start, design, from, scene, observer,
      [&](const Hoop<S>& hoop, const Contact<S>& contact, ContactState<S>& at, const S& runway) {
        typename RollingLeg<S>::Told turns;
        if (observer.turn) turns = [&](const ContactState<S>& state) { observer.turn(in_double(state)); };
        return rolling_.run(hoop, contact.mu_static, at, runway, turns);
      },
      [&](const Hoop<S>& hoop, const Contact<S>& contact, ContactState<S>& at, const S& runway,
          int direction) {
        RecordedSlide<S>* taken = slides ? &slides->emplace_back() : nullptr;
        return sliding_.run(hoop, contact.mu_kinetic, at, runway, direction, taken);
      });
}

#ifdef LEAPMAP_KERNELS
template class CoulombSolver<double>;
#endif
#ifdef LEAPMAP_SCALARS
template class CoulombSolver<long double>;
#endif

}  // namespace leapmap
