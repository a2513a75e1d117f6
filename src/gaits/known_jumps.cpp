// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaits/known_jumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace leapmap {
namespace {

constexpr std::size_t fewest = 4, most = 12;  // neighbours

/// Where a jump begins, and where it ends, each as seen from a landing of its own.
using BeginAndEnd = Eigen::Matrix<double, 8, 1>;

/// The polynomial through places that are added one after the other, at zero, by Newton's differences.
class AtZero {
 public:
  void add(double place, BeginAndEnd difference) {
    for (std::size_t k = 0; k < count_; ++k) {
      // The next order, from the differences of this one with the new place and without.
      const double inverse = 1.0 / (place - places_[count_ - 1 - k]);
      const BeginAndEnd next = (difference - last_[k]) * inverse;
      last_[k] = difference, difference = next;
    }
    last_[count_] = difference;
    places_[count_++] = place;
    const BeginAndEnd correction = difference * product_;
    product_ *= -place;
    value_ += correction;
    before_ = correction_, correction_ = correction.lpNorm<Eigen::Infinity>();
  }
  std::size_t count() const { return count_; }
  const BeginAndEnd& value() const { return value_; }
  /// Whether the last place changed it by less than `error`, and the one before by not much more.
  bool converges(double error) const {
    return count_ >= fewest && correction_ < error && before_ < 30.0 * error;
  }

 private:
  std::array<double, most> places_;
  std::array<BeginAndEnd, most> last_;  // differences of each order that end with the last place
  BeginAndEnd value_ = BeginAndEnd::Zero();
  double product_ = 1.0, correction_ = 0.0, before_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace

auto KnownJumps::at_or_after(double angle) const -> std::vector<Place>::const_iterator {
  return std::lower_bound(places_.begin(), places_.end(), angle,
                          [](const Place& place, double there) { return place.angle < there; });
}

void KnownJumps::add(const Landed& from, const Landed& to, std::uint64_t phases) {
  constexpr std::size_t most_known = 256;
  constexpr double too_close = 1e-9;  // to a known jump to be of use
  const bool holds_all_phases = phases != 0 && phases >> 62 == 0;
  if (!holds_all_phases || gives_up() || known_.size() == most_known) return;
  const auto right = at_or_after(from.angle);
  const bool is_apart = (right == places_.end() || right->angle - from.angle >= too_close) &&
                        (right == places_.begin() || from.angle - std::prev(right)->angle >= too_close);
  if (!is_apart || !std::isfinite(from.angle)) return;
  const auto way = [](double slip) { return (slip > 0.0) - (slip < 0.0); };
  known_.push_back({from, to, {phases, way(from.slip), way(to.slip), to.normal != 0.0}});
  places_.insert(right, {from.angle, known_.size() - 1});
}

bool KnownJumps::gives_up() const {
  constexpr std::size_t on_trial = 128;
  return asked_ >= on_trial && interpolated_ < on_trial / 8;
}

std::optional<Landed> KnownJumps::next(const Landed& from) {
  if (gives_up()) return {};
  ++asked_;
  const auto right = at_or_after(from.angle);
  if (right == places_.begin() || right == places_.end()) return {};
  const Known& beside = at(*right);
  const auto is_alike = [&](const Place& place) { return at(place).kind == beside.kind; };
  if (!is_alike(*std::prev(right))) return {};
  AtZero polynomial;
  const auto add = [&](const Place& place) {
    BeginAndEnd seen;
    seen << between(from, at(place).from), between(beside.to, at(place).to);
    polynomial.add(place.angle - from.angle, seen);
  };
  // One on either side, then always the nearer one.
  auto first = std::prev(right), last = std::next(right);
  add(*first), add(*right);
  while (!polynomial.converges(error)) {
    const bool more_left = first != places_.begin() && is_alike(*std::prev(first));
    const bool more_right = last != places_.end() && is_alike(*last);
    if (polynomial.count() == most || (!more_left && !more_right)) return {};
    const bool is_left_nearer =
        more_left && (!more_right || from.angle - std::prev(first)->angle < last->angle - from.angle);
    add(is_left_nearer ? *--first : *last++);
  }
  const bool is_on_curve = polynomial.value().head<4>().lpNorm<Eigen::Infinity>() < 10.0 * error;
  if (!is_on_curve || !polynomial.value().allFinite()) return {};
  ++interpolated_;
  return reduced(moved(beside.to, polynomial.value().tail<4>()));
}

}  // namespace leapmap
