// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numerics/mixed.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

/// But for their roundings.
bool is_alike(double a, double b, double spread) {
  constexpr double rounding = 1e-13;
  return std::abs(a - b) <= spread + rounding * std::abs(a);
}

}  // namespace

bool MadeLine::suits(const DrawnLine& line, std::span<const Design> drawings, const MadeHoops& hoops) {
  const bool enough = line.count >= shortest_line && hoops.samples() >= fewest_samples;
  if (!enough || hoops.samples() * shortest_line > most_hoops) return false;
  for (std::size_t j = 0; j + 1 < line.count; ++j) {
    // Only so do the hoops of several drawings see the same discontinuities.
    const double width = hoops.width_of(drawings[j], [&](double Design::*member) {
      return &(drawings[j].*member) == reinterpret_cast<const double*>(&drawings[j]) + line.place;
    });
    if (!(std::abs(line.along[j + 1] - line.along[j]) <= width)) return false;
  }
  return true;
}

bool MadeLine::is_by_chance(std::size_t drawing, std::size_t hoop) const {
  return (drawing + mixed(hoop)) % stride == 0;
}

void MadeLine::keep(std::size_t at, const Outcome& outcome) {
  kinds_[at] = {outcome.phase_sequence, outcome.status, outcome.spurious_first_jump, outcome.candidates,
                true};
  for (std::size_t n = 0; n < numbers_.size(); ++n) values_[at * numbers_.size() + n] = outcome.*numbers_[n];
}

void MadeLine::solve_asked(std::span<const Design> drawings, MadeHoops& hoops, const Solver& solve) {
  constexpr std::size_t at_once = 1024;
  outcomes_.resize(at_once);
  batch_.clear(), places_.clear();
  const auto run = [&] {
    throw_if_stopped();
    solve(batch_, std::span(outcomes_).first(batch_.size()));
    for (std::size_t i = 0; i < batch_.size(); ++i) keep(places_[i], outcomes_[i]);
    batch_.clear(), places_.clear();
  };
  for (std::size_t j = 0; j < count_; ++j) {
    const auto row = std::span(asked_).subspan(place(j, 0), samples_);
    if (std::none_of(row.begin(), row.end(), [](char asked) { return asked; })) continue;
    hoops.draw(drawings[j]);
    for (std::size_t k = 0; k < samples_; ++k) {
      if (!std::exchange(row[k], false)) continue;
      hoops.fill(k, {&batch_.emplace_back(), 1});
      places_.push_back(place(j, k));
      if (batch_.size() == at_once) run();
    }
  }
  if (!batch_.empty()) run();
}

template <class F>
void MadeLine::for_gaps(std::size_t hoop, const F& take) {
  nodes_.clear();
  for (std::size_t j = 0; j < count_; ++j)
    if (kind(j, hoop).is_solved) nodes_.push_back(j);
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i)
    if (nodes_[i + 1] - nodes_[i] > 1) take(gap_after(i, nodes_, hoop));
}

auto MadeLine::gap_after(std::size_t i, std::span<const std::size_t> solved, std::size_t hoop) const -> Gap {
  Gap gap{.from = solved[i], .to = solved[i + 1]};
  const Kind& here = kind(solved[i], hoop);
  const auto agrees = [&](std::size_t k) { return agree(here, kind(solved[k], hoop)); };
  const auto is_like = [&](std::size_t k) { return here.is_like(kind(solved[k], hoop)); };
  // Those about the gap for which that is so: two below it and two above at most.
  const auto run_of = [&](const auto& is_so) {
    std::size_t low = i, high = i + 1;
    while (low > 0 && i - low < 2 && is_so(low - 1)) --low;
    while (high + 1 < solved.size() && high - i < 3 && is_so(high + 1)) ++high;
    return std::pair(low, high);
  };
  if (!agrees(i + 1) || here.status == Status::failed) return gap;
  const auto [low, high] = run_of(agrees);
  if (!is_like(i + 1)) {
    // The numbers may have a kink or a step at the change of phases. Both sides have to agree on them.
    if (i - low < 2 || high - i < 3) return gap;
    gap.nodes = {solved[i], solved[i + 1], solved[i - 1], solved[i + 2]};
    gap.checks = {Nodes<3>{solved[i], solved[i - 1], solved[i - 2]},
                  Nodes<3>{solved[i + 1], solved[i + 2], solved[i + 3]}};
    gap.checked = 2;
    return gap;
  }
  // One node on either side, or the nearest two on one side. If they are too few, other phases count as well.
  auto [first, last] = run_of(is_like);
  if (last - first < 3) first = low, last = high;
  if (last - first < 3) return gap;
  const bool only_above = first == i, only_below = last == i + 1;
  const std::size_t nearer = only_above ? i + 2 : i - 1;
  const std::size_t farther = only_above ? i + 3 : only_below ? i - 2 : i + 2;
  gap.nodes = {solved[i], solved[i + 1], solved[nearer], solved[farther]};
  gap.checks[0] = {solved[i], solved[i + 1], solved[nearer]}, gap.checked = 1;
  return gap;
}

template <std::size_t N>
std::array<double, N> MadeLine::weights(const Nodes<N>& nodes, double x) const {
  std::array<double, N> weights;
  for (std::size_t i = 0; i < N; ++i) {
    double weight = 1.0;
    for (std::size_t k = 0; k < N; ++k)
      if (k != i) weight *= (x - x_[nodes[k]]) / (x_[nodes[i]] - x_[nodes[k]]);
    weights[i] = weight;
  }
  return weights;
}

template <std::size_t N>
double MadeLine::weighted(const Nodes<N>& nodes, const std::array<double, N>& weights, std::size_t hoop,
                          std::size_t n) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) sum += weights[i] * number(nodes[i], hoop, n);
  return sum;
}

/// If phases and with them the curvature change in the gap, the polynomials may cross in its middle. They are
/// compared on both sides of it then.
bool MadeLine::is_smooth(const Gap& gap, std::size_t hoop) const {
  constexpr std::array quarters{0.25, 0.75}, middle{0.5, 0.5};
  const std::size_t each = numbers_.size();
  const auto applies = [&](std::size_t n) {
    return std::any_of(gap.nodes.begin(), gap.nodes.end(),
                       [&](std::size_t node) { return !std::isnan(number(node, hoop, n)); });
  };
  for (std::size_t c = 0; c < gap.checked; ++c)
    for (const double share : gap.checked == 2 ? quarters : middle) {
      const double x = x_[gap.from] + share * (x_[gap.to] - x_[gap.from]);
      const auto cubic = weights(gap.nodes, x);
      const auto parabola = weights(gap.checks[c], x);
      for (std::size_t n = 0; n < each; ++n)  // NaN differs from everything
        if (applies(n) &&
            !is_alike(weighted(gap.nodes, cubic, hoop, n), weighted(gap.checks[c], parabola, hoop, n),
                      spreads_[gap.from * each + n]))
          return false;
    }
  return gap.checked > 0;
}

void MadeLine::interpolate(const Gap& gap, std::size_t hoop) {
  const std::size_t each = numbers_.size();
  for (std::size_t j = gap.from + 1; j < gap.to; ++j) {
    Kind& between = kinds_[place(j, hoop)] = kind(gap.from, hoop);
    between.is_solved = false;
    const auto cubic = weights(gap.nodes, x_[j]);
    for (std::size_t n = 0; n < each; ++n)
      values_[place(j, hoop) * each + n] = weighted(gap.nodes, cubic, hoop, n);
  }
}

/// As far as a polynomial may be off: a tenth of a mean's standard error, of pseudo-random hoops. The better
/// one is off by some tenth of that. What few hoops far from the others add to the spread is left out.
void MadeLine::measure_spreads() {
  const std::size_t each = numbers_.size();
  spreads_.assign(count_ * each, 0.0);
  std::vector<double> values;
  for (std::size_t j = 0; j < count_; ++j)
    for (std::size_t n = 0; n < each; ++n) {
      values.clear();
      for (std::size_t k = 0; k < samples_; ++k)
        if (kind(j, k).is_solved && number(j, k, n) == number(j, k, n)) values.push_back(number(j, k, n));
      constexpr std::size_t few = 8;
      if (values.size() < few) continue;
      std::sort(values.begin(), values.end());
      constexpr double quarters_of_normal = 1.349;
      const double middle_half = values[values.size() * 3 / 4] - values[values.size() / 4];
      spreads_[j * each + n] =
          0.1 * middle_half / quarters_of_normal / std::sqrt(static_cast<double>(samples_));
    }
}

void MadeLine::refine(std::span<const Design> drawings, MadeHoops& hoops, const Solver& solve) {
  for (bool asks = true; asks;) {
    solve_asked(drawings, hoops, solve);
    if (spreads_.empty()) measure_spreads();
    asks = false;
    for (std::size_t k = 0; k < samples_; ++k)
      for_gaps(k, [&](const Gap& gap) {
        if (!is_smooth(gap, k)) asked_[place((gap.from + gap.to) / 2, k)] = asks = true;
      });
  }
}

/// Whether interpolation in a gap twice as wide as usual would have given another outcome than that of a hoop
/// which was solved by chance.
bool MadeLine::surprises(std::size_t drawing, std::size_t hoop) const {
  std::array<std::size_t, 6> around;  // solved by chance as well, or at the line's ends
  std::size_t count = 0;
  const auto add = [&](std::size_t node) {
    if (count == 0 || node > around[count - 1]) around[count++] = node;
  };
  for (std::size_t k = 3; k > 0; --k) add(drawing > k * stride ? drawing - k * stride : 0);
  const std::size_t below = count - 1;
  for (std::size_t k = 1; k <= 3; ++k) add(std::min(drawing + k * stride, count_ - 1));
  const Gap gap = gap_after(below, std::span(around).first(count), hoop);
  if (!is_smooth(gap, hoop)) return is_in_narrow_band(drawing, hoop) || has_narrow_phases(drawing, hoop);
  return !agree(kind(gap.from, hoop), kind(drawing, hoop)) || !predicts(gap.nodes, drawing, hoop);
}

bool MadeLine::predicts(const Nodes<4>& nodes, std::size_t drawing, std::size_t hoop) const {
  // The error of a cubic grows by this factor if the distance of its nodes doubles.
  constexpr double loose = 16.0;
  const auto cubic = weights(nodes, x_[drawing]);
  for (std::size_t n = 0; n < numbers_.size(); ++n) {
    const double predicted = weighted(nodes, cubic, hoop, n), value = number(drawing, hoop, n);
    if (std::isnan(value) && std::isnan(predicted)) continue;
    if (!is_alike(predicted, value, loose * spreads_[drawing * numbers_.size() + n])) return false;
  }
  return true;
}

/// Whether two solved hoops, one on either side, agree with each other but not with the hoop between them,
/// and are so close that no drawing between them need have been solved.
bool MadeLine::is_in_narrow_band(std::size_t drawing, std::size_t hoop) const {
  for (std::size_t low = drawing; low-- > 0 && drawing - low < stride;) {
    if (!kind(low, hoop).is_solved || agree(kind(low, hoop), kind(drawing, hoop))) continue;
    for (std::size_t high = drawing + 1; high < count_ && high - low <= stride; ++high)
      if (kind(high, hoop).is_solved && agree(kind(low, hoop), kind(high, hoop))) return true;
  }
  return false;
}

/// Whether only a few neighbouring drawings have a hoop's phases, and interpolation across these drawings
/// would have given another outcome.
bool MadeLine::has_narrow_phases(std::size_t drawing, std::size_t hoop) const {
  const Kind& here = kind(drawing, hoop);
  std::size_t first = drawing, last = drawing;
  while (first > 0 && here.is_like(kind(first - 1, hoop))) --first;
  while (last + 1 < count_ && here.is_like(kind(last + 1, hoop))) ++last;
  if (first == 0 || last + 1 == count_ || last - first + 1 >= stride) return false;
  std::array<std::size_t, 6> around;  // three below, and three above
  std::size_t begin = 3, end = 3;
  for (std::size_t j = first; j-- > 0 && begin > 0;)
    if (kind(j, hoop).is_solved) around[--begin] = j;
  for (std::size_t j = last + 1; j < count_ && end < around.size(); ++j)
    if (kind(j, hoop).is_solved) around[end++] = j;
  const Gap gap = gap_after(2 - begin, std::span(around).subspan(begin, end - begin), hoop);
  return is_smooth(gap, hoop) && (!agree(kind(gap.from, hoop), here) || !predicts(gap.nodes, drawing, hoop));
}

bool MadeLine::ask_where_surprised() {
  constexpr std::size_t around = stride / 2;  // each drawing has hoops of its own that are met by chance
  std::vector<char> all(count_, false);       // of a drawing's hoops
  for (std::size_t j = 1; j + 1 < count_; ++j)
    for (std::size_t k = 0; k < samples_; ++k)
      if (is_by_chance(j, k) && surprises(j, k)) {
        const std::size_t first = j > around ? j - around : 0, end = std::min(j + around + 1, count_);
        std::fill(all.begin() + static_cast<std::ptrdiff_t>(first),
                  all.begin() + static_cast<std::ptrdiff_t>(end), true);
        break;
      }
  bool asks = false;
  for (std::size_t j = 0; j < count_; ++j)
    for (std::size_t k = 0; k < samples_ && all[j]; ++k)
      if (!kind(j, k).is_solved) asked_[place(j, k)] = asks = true;
  return asks;
}

void MadeLine::solve(std::span<const Design> drawings, DrawnLine line, MadeHoops& hoops,
                     const Solver& solve) {
  count_ = drawings.size(), samples_ = hoops.samples();
  x_ = std::move(line.along);
  kinds_.assign(count_ * samples_, {});
  values_.resize(kinds_.size() * numbers_.size());
  spreads_.clear();
  asked_.assign(kinds_.size(), false);
  for (std::size_t j = 0; j < count_; ++j)
    for (std::size_t k = 0; k < samples_; ++k)
      asked_[place(j, k)] = j == 0 || j + 1 == count_ || is_by_chance(j, k);
  refine(drawings, hoops, solve);
  while (ask_where_surprised()) refine(drawings, hoops, solve);
  for (std::size_t k = 0; k < samples_; ++k) for_gaps(k, [&](const Gap& gap) { interpolate(gap, k); });
}

void MadeLine::put(std::size_t drawing, std::size_t hoop, Outcome& outcome) const {
  const Kind& here = kind(drawing, hoop);
  outcome.phase_sequence = here.phases, outcome.status = here.status;
  outcome.spurious_first_jump = here.spurious, outcome.candidates = here.candidates;
  for (std::size_t n = 0; n < numbers_.size(); ++n) outcome.*numbers_[n] = number(drawing, hoop, n);
}

}  // namespace leapmap
