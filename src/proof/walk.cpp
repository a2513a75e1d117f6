// SPDX-License-Identifier: GPL-3.0-or-later
#include "proof/walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace leapmap {
namespace {

constexpr const char* appears = "a pair of lift-offs that only just appears";
constexpr double angle_step = 0.4;  // of the first look, in rad
template <std::size_t N>
constexpr double smallest_piece = N == 0 ? 1e-11 : 0.01;

}  // namespace

template <std::size_t N>
template <class T>
T Walk<N>::value_of_parameter(double Design::*member) const {
  const double from = box_.from.*member, to = box_.to.*member;
  if constexpr (has_derivatives<T>) {
    for (std::size_t k = 0; k < N; ++k)
      if (varying_[k] == member) return T::parameter(Ball::between(from, to), k + 1);
    return T(Ball(from));
  } else {
    return T(from + 0.5 * (to - from));
  }
}

template <std::size_t N>
template <class T>
Hoop<T> Walk<N>::hoop_of(int resists) const {
  const auto value = [&](double Design::*member) { return value_of_parameter<T>(member); };
  return resisted(reduce(value(&Design::slope), value(&Design::mass_ratio), value(&Design::offset_ratio),
                         value(&Design::inertia_factor), value(&Design::drive_torque)),
                  T(resists) * value(&Design::resisting_torque));
}

template <std::size_t N>
int Walk<N>::sets_out(const BothHoops& hoop) const {
  const D angle = value_of_parameter<D>(&Design::release_angle),
          spin_of_all = value_of_parameter<D>(&Design::release_spin);
  const Ball rounding = Ball(4.0 * std::numeric_limits<double>::epsilon()) * (Ball(1) + abs(angle.value)),
             &spin = spin_of_all.value;
  const Hoop<D>& of = hoop.all;
  const Ball push = torque(of, trig(angle)).value,
             terms = rounding * (abs(of.sin_slope.value) + abs(of.drive.value) + of.rho.value);
  if (abs(push) <= terms && abs(spin) <= rounding) return 0;
  if (!(abs(push) > terms || abs(spin) > rounding)) throw Undecided{"a release in an equilibrium"};
  if (const int way = spin.sign(); way != 0 && abs(spin) > Ball(1e-150)) return way;
  if (!(spin == Ball(0)) || push.sign() == 0) throw Undecided{"a release nearly at rest"};
  return push.sign();
}

/// Which way the resisting torque acts against; 0: there is none, or it holds the hoop where it is.
template <std::size_t N>
int Walk<N>::resists() const {
  const Ball torque_of_all = value_of_parameter<D>(&Design::resisting_torque).value;
  if (torque_of_all == Ball(0)) return 0;
  const Ball spin = value_of_parameter<D>(&Design::release_spin).value;
  if (spin.sign() != 0) return spin.sign();
  const Hoop<D> hoop = hoop_of<D>(0);
  const Ball push = torque(hoop, trig(value_of_parameter<D>(&Design::release_angle))).value;
  const Ball spare = abs(push) - torque_of_all, near(1e-12);
  if (!(spin == Ball(0)) || !(abs(spare) > near)) throw Undecided{"a release that is hardly held"};
  return spare > Ball(0) ? push.sign() : 0;
}

template <std::size_t N>
bool Walk<N>::is_airborne(const BothHoops& hoop) const {
  const auto force = [&]<class T>(const Hoop<T>& of) {
    const Trig<T> phi = trig(value_of_parameter<T>(&Design::release_angle));
    const T spin = value_of_parameter<T>(&Design::release_spin);
    return normal_force(of, phi, spin, angular_acceleration(of, phi, spin));
  };
  const Ball all = forms_.narrowed(force(hoop.all), force(hoop.middle)).all.value;
  if (all > Ball(0)) return false;
  if (all <= Ball(0)) return true;
  throw Undecided{"a release that only just touches the plane"};
}

template <std::size_t N>
auto Walk<N>::first_leg(const BothHoops& hoop, int way) const -> Leg {
  const auto roll = [&]<class T>(const Hoop<T>& of) {
    const T seen_as(way), angle = value_of_parameter<T>(&Design::release_angle);
    return begin_roll(seen(of, seen_as), seen_as * angle, seen(trig(angle), seen_as),
                      seen_as * value_of_parameter<T>(&Design::release_spin));
  };
  const Ball length = Ball(2) * Ball::pi() * Ball(scene_.runway);
  return {{roll(hoop.all), roll(hoop.middle)}, {D(length), length}, 1};
}

template <std::size_t N>
auto Walk<N>::next_leg(const Leg& leg, const BothNumbers<N>& turn) const -> Leg {
  const auto roll = [&]<class T>(const Roll<T>& before, const T& x) {
    return begin_roll(seen(before.hoop, T(-1)), T(-(before.release + x)), T(0));
  };
  const bool is_last = leg.number == 2;
  const Ball runway = Ball(2) * Ball::pi() * Ball(scene_.runway);
  const auto length = [&]<class T>(const T& x, const T& way_before) {
    return is_last ? x - way_before : T(runway) + x;
  };
  // Before the second leg the way was x, so that its length is the runway and x; and the third leads back.
  return {{roll(leg.roll.all, turn.all), roll(leg.roll.middle, turn.middle)},
          {length(turn.all, leg.length.all - D(runway)), length(turn.middle, leg.length.middle - runway)},
          leg.number + 1};
}

template <std::size_t N>
std::optional<BothNumbers<N>> Walk<N>::turn_of(const Leg& leg) const {
  constexpr int most_halvings = 60;
  if (leg.number == 3) return {};
  double from = 0.0;
  if (leg.roll.middle.released == Ball(0)) {  // from rest
    from = angle_step;
    for (int k = 0; forms_.range(Push{}, leg.roll, 0.0, from).value.sign() <= 0; ++k, from *= 0.5)
      if (k == most_halvings) throw Undecided{"a release in an equilibrium"};
  }
  const double perhaps = leg.length.all.value.upper();
  ZeroSearch search([&](double a, double b) { return forms_.range(VisViva{}, leg.roll, a, b); }, from,
                    perhaps, angle_step, smallest_piece<N>);
  const auto turn = search.next();
  if (!turn) return {};
  if (!turn->falls()) throw Undecided{"a hoop that nearly stalls"};
  const BothNumbers<N> x = forms_.zero(VisViva{}, leg.roll, turn->from, turn->to);
  if (x.all.value > leg.length.all.value) return {};
  if (!(x.all.value < leg.length.all.value)) throw Undecided{"a turn where the way ends"};
  return x;
}

template <std::size_t N>
auto Walk<N>::taking_off(const Leg& leg, const BothNumbers<N>& x) const -> Both<TakingOff, N> {
  const BothNumbers<N> spin =
      forms_.narrowed(spin_past_release(leg.roll.all, x.all), spin_past_release(leg.roll.middle, x.middle));
  const auto off = [&]<class T>(const Roll<T>& roll, const T& at, const T& turning) {
    return TakingOff<T>{in_flight(roll.hoop, scene_), trig(T(roll.release + at)), turning};
  };
  return {off(leg.roll.all, x.all, spin.all), off(leg.roll.middle, x.middle, spin.middle)};
}

template <std::size_t N>
BothNumbers<N> Walk<N>::flight_at(const Leg& leg, const BothNumbers<N>& x) const {
  const Both<TakingOff, N> flight = taking_off(leg, x);
  try {
    return apex_height(forms_, flight);
  } catch (const Undecided&) {
    // That no hoop comes as high as the threshold may be plain all the same.
    const double most = most_height(forms_, flight);
    if (!(most < scene_.hop_height)) throw;
    const Ball low = Ball::between(0.0, most);
    return {D(low), low};
  }
}

/// Whether what may lift off between two angles past the release, and need not, is of no account: no jump.
/// Then there has to be a surer lift-off that is none either.
template <std::size_t N>
bool Walk<N>::may_be_passed_over(const Leg& leg, double from, double to) const {
  if (N == 0) return false;
  const Ball x = Ball::between(from, to);
  return most_height(forms_, taking_off(leg, {D(x), x})) < scene_.hop_height;
}

/// Some designs may jump so high, and others go on. Of a single design nobody would know.
template <std::size_t N>
void Walk<N>::note_jump(const Ball& height, const char* event) {
  if (N == 0 || !height.is_finite()) throw Undecided{event};
  if (height < Ball(scene_.hop_height)) {  // none does, as is seen now
    counts_ = false;
    return;
  }
  const Ball jumps = Ball::between(std::max(height.lower(), scene_.hop_height), height.upper());
  may_jump_ = may_jump_ ? hull(*may_jump_, jumps) : jumps;
  event_ = event;
}

/// The same of what may lift off between two angles past the release, and need not.
template <std::size_t N>
void Walk<N>::may_jump(const Leg& leg, double from, double to, const char* event) {
  if constexpr (N == 0) throw Undecided{event};
  const Ball x = Ball::between(from, to);
  note_jump(flight_at(leg, {D(x), x}).all.value, event);
}

/// Looks for the jump up to where the leg ends.
template <std::size_t N>
auto Walk<N>::look_for_jump(const Leg& leg, const Ball& end) -> End {
  constexpr double beyond = 1.0;  // so that what lies about the end is seen whole
  ZeroSearch search([&](double a, double b) { return forms_.range(Lift{}, leg.roll, a, b); }, 0.0,
                    end.upper() + beyond, angle_step, smallest_piece<N>);
  std::optional<Ball> last;
  std::optional<double> unsure;  // the end of what may hold lift-offs
  while (const auto fall = search.next()) {
    if (fall->slope > 0) continue;  // it rises, if it is zero there at all
    if (Ball(fall->from) > end) break;
    std::optional<BothNumbers<N>> root;
    if (fall->falls()) root = forms_.zero(Lift{}, leg.roll, fall->from, fall->to);
    if (root && root->all.value > end) break;
    if (!root || !(root->all.value < end)) {
      const char* event = root ? "a lift-off where the way ends" : appears;
      if (may_be_passed_over(leg, fall->from, fall->to))
        counts_ = false;
      else
        may_jump(leg, fall->from, fall->to, event);
      unsure = fall->to;
      continue;
    }
    const BothNumbers<N>& x = *root;
    const Ball angle = release_ + x.all.value;
    // As rolling between them is not told from none, the model counts two so near each other as one.
    const Ball one_fall = Ball(1e-6) * (Ball(1) + abs(angle));
    if (unsure && !(x.all.value - Ball(*unsure) > one_fall)) throw Undecided{appears};
    if (last) {
      const Ball between = x.all.value - *last;
      const bool is_far = between > one_fall;
      if (!is_far && !(between < Ball(1e-6))) throw Undecided{"two lift-offs that nearly are one"};
      if (!is_far) continue;
    }
    last = x.all.value;
    const BothNumbers<N> height = flight_at(leg, x);
    ++proof_.lift_offs;
    const bool is_jump = height.all.value >= Ball(scene_.hop_height);
    if (!is_jump && !(height.all.value < Ball(scene_.hop_height))) {
      --proof_.lift_offs;
      note_jump(height.all.value, "a lift-off as high as the jump threshold");
      continue;
    }
    if (proof_.lift_offs == 1) {
      proof_.spurious_first_jump = static_cast<std::uint8_t>(is_jump ? 0 : 1);
      if (counts_) {  // else another may be the first
        proof_.first_height = enclosure_of(height.all.value);
        proof_.first_time = time_at(leg, x);
      }
    }
    if (!is_jump) continue;
    if (!counts_) note_jump(height.all.value, appears);
    proof_.height = enclosure_of(height.all.value);
    proof_.time = time_at(leg, x);
    return End::jump;
  }
  return leg.number == 3 ? End::back : End::runway;
}

/// Time from the release to x on the leg [s]; of boxes of the first leg only.
template <std::size_t N>
Enclosure Walk<N>::time_at(const Leg& leg, const BothNumbers<N>& x) {
  const Ball second = sqrt(Ball(scene_.radius) * Ball(box_.from.size) / Ball(scene_.gravity));
  if constexpr (N == 0) {
    time_ = time_ + travel_time(leg.roll.middle, timed_, x.middle), timed_ = x.middle;
  } else {
    if (!times_ || leg.number > 1) return {};
    time_ = travel_time(forms_, leg.roll, x);
  }
  const Ball told = time_ * second;
  return told.is_finite() ? enclosure_of(told) : Enclosure{};
}

template <std::size_t N>
Proof Walk<N>::ended(Status status) {
  if (!counts_ && proof_.lift_offs == 0) throw Undecided{appears};
  if (!counts_) proof_.lift_offs = -1;
  if (may_jump_) {
    if (status != Status::jumped) throw Undecided{event_};
    const Ball height = hull(*may_jump_, Ball::between(proof_.height.low, proof_.height.high));
    Proof either;
    either.open = event_, either.all_jump = true, either.height = enclosure_of(height);
    return either;
  }
  proof_.proved = true, proof_.all_jump = status == Status::jumped;
  proof_.status = status;
  return proof_;
}

template <std::size_t N>
Proof Walk<N>::prove() {
  const int resists_way = resists();
  const bool is_held_at_release =
      resists_way == 0 && !(value_of_parameter<D>(&Design::resisting_torque).value == Ball(0));
  const BothHoops hoop{hoop_of<D>(resists_way), hoop_of<Ball>(resists_way)};
  if (is_held_at_release) return ended(Status::stalled);
  if (is_airborne(hoop)) return ended(Status::airborne_at_release);
  const int way = sets_out(hoop);
  if (way == 0) return ended(Status::stalled);
  Leg leg = first_leg(hoop, way);
  // Solvers take a release many turns from 0 back to the first.
  const double release = box_.from.release_angle, pi = std::numbers::pi;
  release_ = std::abs(release) > 4.0 * pi ? Ball::between(-pi, pi) : leg.roll.all.release.value;
  while (true) {
    const auto turn = turn_of(leg);
    const Ball& end = turn ? turn->all.value : leg.length.all.value;
    const End how = look_for_jump(leg, end);
    if (how == End::jump || !turn) {
      return ended(how == End::jump ? Status::jumped : how == End::back ? Status::stalled : Status::no_jump);
    }
    if (resists_way != 0) {
      const Hoop<D>& of = leg.roll.all.hoop;
      const Ball push = (torque(of, trig(D(leg.roll.all.release + turn->all))) + of.resistance).value;
      const Ball spare = abs(push) - abs(of.resistance.value);
      if (spare.sign() < 0) return ended(Status::stalled);
      throw Undecided{"a rotation that reverses against the resisting torque"};  // which no method follows
    }
    release_ = -(release_ + turn->all.value);
    const Leg next = next_leg(leg, *turn);
    if constexpr (N == 0) {  // to half-way, and from there as it would go back
      const Ball half = (timed_ + turn->middle) * Ball(0.5);
      time_ = time_ + travel_time(leg.roll.middle, timed_, half) +
              travel_time(next.roll.middle, Ball(0), turn->middle - half);
      timed_ = Ball(0);
    }
    leg = next;
  }
}

template class Walk<0>;
template class Walk<1>;
template class Walk<2>;
template class Walk<3>;
template class Walk<7>;

}  // namespace leapmap
