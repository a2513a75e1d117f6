// SPDX-License-Identifier: GPL-3.0-or-later
/// Rolling, sliding, flying and landing, one after the other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "referee/referee.hpp"

namespace leapmap::referee {
namespace {

constexpr int most_phases = 2'000;
constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();

enum class Next { rolls, slides_forwards, slides_backwards, flies };

/// Upwards acceleration of the hoop's centre if the plane did not hold it, but still resisted its rotation
/// [m/s^2].
double free_rise(const Body& body, const Motion& at) { return forces_of(body, {Mode::unheld}, at).y; }

/// What static friction has left to hold with, one way (sign 1: against sliding backwards) or the other [N].
double hold(const Body& body, const Motion& at, double mu, double sign) {
  const Forces forces = forces_of(body, {Mode::rolls}, at);
  const double slack = rounding * (mu * std::abs(forces.normal) + std::abs(forces.friction) +
                                   body.mass() * std::abs(body.g_along));
  return mu * forces.normal - sign * forces.friction + slack;
}

/// Whether a hoop that would leave the plane, were it not held, does.
enum class Leaving { unless_it_sticks, always, never };

Next next_of(const Body& body, const Motion& at, double mu_static, Leaving leaving) {
  const double slip = slip_of(body, at);
  const bool would_leave = leaving != Leaving::never && free_rise(body, at) >= 0.0;
  if (would_leave && (leaving == Leaving::always || slip != 0.0)) return Next::flies;
  if (slip != 0.0) return slip > 0.0 ? Next::slides_forwards : Next::slides_backwards;
  const double forwards = hold(body, at, mu_static, -1.0), backwards = hold(body, at, mu_static, 1.0);
  if (forces_of(body, {Mode::rolls}, at).normal > 0.0 && forwards >= 0.0 && backwards >= 0.0)
    return Next::rolls;
  if (would_leave) return Next::flies;
  return forwards > backwards ? Next::slides_backwards : Next::slides_forwards;
}

}  // namespace

/// One design on its way from phase to phase. Each phase moves the hoop to its end, and returns what comes
/// next; nothing: the design has ended, as `end` says.
class Referee::Slipping {
 public:
  Slipping(Referee& referee, const Design& design)
      : referee_(referee),
        body_(referee.system_.body),
        at_(referee.at_),
        outcome_(referee.outcome_),
        mu_kinetic_(std::isnan(design.mu_kinetic) ? design.mu_static : design.mu_kinetic),
        mu_static_(std::max(design.mu_static, mu_kinetic_)),
        restitution_(design.restitution),
        runway_(2.0 * std::numbers::pi * referee.scene_.runway * referee.scene_.radius),
        released_(energy(body_, at_)) {}

  Outcome solve() {
    std::optional<Next> next = next_of(body_, at_, mu_static_, Leaving::unless_it_sticks);
    if (next == Next::flies) next = ended(Status::airborne_at_release);
    for (; next && phases_ < most_phases;)
      next = next == Next::rolls ? roll() : next == Next::flies ? fly_and_land() : slide(*next);
    if (next) ended(Status::failed);
    if (end_ == Status::failed || end_ == Status::indeterminate) {
      const std::uint64_t sequence = outcome_.phase_sequence;
      outcome_ = failed_outcome("the reference solver failed");
      outcome_.phase_sequence = sequence;
    } else {
      outcome_.slip_distance = slipped_ / referee_.scene_.radius;
    }
    outcome_.status = end_;
    return outcome_;
  }

 private:
  std::nullopt_t ended(Status status) {
    end_ = status;
    return std::nullopt;
  }
  void begin(Phase phase) {
    if (phases_ < 32) outcome_.phase_sequence |= static_cast<std::uint64_t>(phase) << (2 * phases_);
    ++phases_;
  }
  /// On in a mode to the first event, whose guard happened_ is then. False: it could not be followed.
  bool follow(const Mode& mode, const std::vector<Guard>& guards) {
    const Motion from = at_;
    const bool followed = referee_.follow(mode, guards, [&](std::size_t guard) {
      happened_ = guard;
      return true;
    });
    driven_ += body_.motor * (at_.phi - from.phi);
    return followed;
  }
  double runway_left(const Motion& at) const { return runway_ - std::abs(at.x); }

  std::optional<Next> roll() {
    begin(Phase::rolling);
    for (int turns = 0; turns < 2; ++turns) {  // who has turned twice has seen every angle there is
      const double sets_out = at_.spin != 0.0 ? at_.spin : forces_of(body_, {Mode::rolls}, at_).phi;
      if (sets_out == 0.0 || rests(body_, at_)) return ended(Status::stalled);
      const double way = std::copysign(1.0, sets_out);
      const std::vector<Guard> guards{[&](const Motion& at) { return hold(body_, at, mu_static_, 1.0); },
                                      [&](const Motion& at) { return hold(body_, at, mu_static_, -1.0); },
                                      [&](const Motion& at) { return way * at.spin; },
                                      [&](const Motion& at) { return runway_left(at); }};
      if (!follow({Mode::rolls}, guards)) return ended(Status::failed);
      if (happened_ != 2) break;
      at_.spin = at_.x_rate = 0.0;
    }
    if (happened_ == 2) return ended(Status::stalled);
    if (happened_ == 3) return ended(Status::no_jump);
    if (free_rise(body_, at_) >= 0.0) return Next::flies;
    return happened_ == 0 ? Next::slides_backwards : Next::slides_forwards;
  }

  std::optional<Next> slide(Next direction) {
    begin(Phase::sliding);
    const double sign = direction == Next::slides_forwards ? 1.0 : -1.0;
    const Mode slides{Mode::slides, -sign * mu_kinetic_};
    if (sliding_determinant(body_, slides, at_) <= 0.0) return ended(Status::indeterminate);
    const std::vector<Guard> guards{[&](const Motion& at) { return -free_rise(body_, at); },
                                    [&](const Motion& at) { return sign * slip_of(body_, at); },
                                    [&](const Motion& at) { return runway_left(at); },
                                    [&](const Motion& at) { return sliding_determinant(body_, slides, at); }};
    const Motion from = at_;
    const bool followed = follow(slides, guards);
    const double R = referee_.scene_.radius;
    slipped_ += std::abs((at_.x - from.x) - R * (at_.phi - from.phi));
    if (!followed) return ended(Status::failed);
    if (happened_ == 3) return ended(Status::indeterminate);
    if (happened_ == 2) return ended(Status::no_jump);
    if (happened_ == 0) return Next::flies;
    at_.x_rate = R * at_.spin;
    return next_of(body_, at_, mu_static_, Leaving::unless_it_sticks);
  }

  std::optional<Next> fly_and_land() {
    const double R = referee_.scene_.radius, weight = body_.mass() * body_.g;
    const Flown flown = fly(body_, at_);
    if (flown.failed) return ended(Status::failed);
    Body idle = body_;
    idle.motor = 0.0;  // as it may be in flight
    const bool sinks = body_.motor != 0.0 && body_.turn == 0.0 && !(at_.y_rate > 0.0) &&
                       forces_of(idle, {Mode::flies}, at_).y < -1e-9 * body_.g;
    if (sinks) return ended(Status::indeterminate);  // it would fly through the plane
    begin(Phase::flight);
    const bool jumps = referee_.count_lift_off(flown);
    if (jumps && referee_.meets_forces) outcome_.motor_energy = driven_ / (weight * R);
    if (!jumps && referee_.meets_forces) {  // a hop: its spin may be the largest, whoever turns it
      const double ends = at_.spin + body_.turn * flown.landing_time;
      for (const double spin : {at_.spin, ends}) {
        referee_.met_.spin = std::max(referee_.met_.spin, std::abs(spin));
        if (body_.turn != 0.0) referee_.met_.power = std::max(referee_.met_.power, body_.motor * spin);
      }
    }
    if (jumps) outcome_.energy_lost = (released_ + driven_ - energy(body_, at_)) / (weight * R);
    Motion before = flying(body_, at_, flown.landing_time);
    before.y = R;
    referee_.time_ += flown.landing_time;
    const double rest_speed = referee_.scene_.rest_speed * std::sqrt(referee_.scene_.gravity * R);
    const Landed landed = land(body_, before, mu_kinetic_, restitution_, rest_speed);
    if (jumps) referee_.measure(at_, before, landed);
    if (body_.turn != 0.0) driven_ += body_.motor * (before.phi - at_.phi);
    at_ = landed.after;
    if (jumps) {
      outcome_.landing_spin = at_.spin * referee_.second_;
      return ended(Status::jumped);
    }
    if (!(std::abs(at_.x) < runway_)) return ended(Status::no_jump);
    if (at_.y_rate > 0.0) return Next::flies;
    return next_of(body_, at_, mu_static_, flown.landing_time > 0.0 ? Leaving::always : Leaving::never);
  }

  Referee& referee_;
  const Body& body_;
  Motion& at_;
  Outcome& outcome_;
  double mu_kinetic_, mu_static_, restitution_, runway_, released_;
  double slipped_ = 0.0, driven_ = 0.0;
  int phases_ = 0;
  std::size_t happened_ = 0;
  Status end_ = Status::failed;
};

Outcome Referee::solve_coulomb(const Design& design) { return Slipping(*this, design).solve(); }

}  // namespace leapmap::referee
