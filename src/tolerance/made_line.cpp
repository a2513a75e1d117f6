// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <tuple>
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

/// A design is nothing but its numbers.
using Numbers = std::array<double, sizeof(Design) / sizeof(double)>;
static_assert(sizeof(Numbers) == sizeof(Design));
Numbers numbers_of(const Design& design) {
  Numbers numbers;
  std::memcpy(&numbers, &design, sizeof numbers);
  return numbers;
}

/// The place of the only number in which two drawings differ; unset: none, or several.
std::optional<std::size_t> difference(const Numbers& a, const Numbers& b) {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i]))) continue;
    if (only) return {};
    only = i;
  }
  return only;
}

}  // namespace

DrawnLine line_of(std::span<const Design> drawings) {
  DrawnLine line;
  double way = 0.0;
  Numbers last = numbers_of(drawings[0]);
  for (; line.count < drawings.size(); ++line.count) {
    const Numbers next = numbers_of(drawings[line.count]);
    const auto differs = difference(last, next);
    if (!differs || (!line.along.empty() && *differs != line.place)) break;
    const double step = next[*differs] - last[*differs];
    if (!(step * way >= 0.0) || !std::isfinite(step)) break;
    if (line.along.empty()) line.along.push_back(last[*differs]);
    line.along.push_back(next[*differs]);
    line.place = *differs, way = step, last = next;
  }
  return line;
}

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
    if (kinds_[place(j, hoop)].is_solved) nodes_.push_back(j);
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i)
    if (nodes_[i + 1] - nodes_[i] > 1) take(gap_after(i, hoop));
}

auto MadeLine::gap_after(std::size_t i, std::size_t hoop) const -> Gap {
  Gap gap{.from = nodes_[i], .to = nodes_[i + 1]};
  const auto kind_of = [&](std::size_t k) -> const Kind& { return kinds_[place(nodes_[k], hoop)]; };
  // Of the nodes about the gap, those that are alike: so many below and above at most.
  const auto alike = [&](const auto& is_alike) {
    std::size_t low = i, high = i + 1;
    while (low > 0 && i - low < 2 && is_alike(low - 1)) --low;
    while (high + 1 < nodes_.size() && high - i < 3 && is_alike(high + 1)) ++high;
    return std::pair(low, high);
  };
  const auto ends_like = [&](std::size_t k) { return this->ends_like(kind_of(i), kind_of(k)); };
  const auto is_like = [&](std::size_t k) { return kind_of(i).is_like(kind_of(k)); };
  if (!ends_like(i + 1) || kind_of(i).status == Status::failed) return gap;
  if (is_like(i + 1)) {
    auto [low, high] = alike(is_like);
    if (high - low < 3) std::tie(low, high) = alike(ends_like);
    if (high - low < 3) return gap;
    const std::size_t first = std::clamp(i > 0 ? i - 1 : 0, low, high - 3);
    gap.nodes = {nodes_[i], nodes_[i + 1]};
    for (std::size_t k = first, filled = 2; filled < gap.nodes.size(); ++k)
      if (k != i && k != i + 1) gap.nodes[filled++] = nodes_[k];
    gap.checks[0] = {gap.nodes[0], gap.nodes[1], gap.nodes[2]}, gap.checked = 1;
    return gap;
  }
  // Phases change in the gap, and with them perhaps what the numbers follow: each side has to tell them.
  const auto [low, high] = alike(ends_like);
  if (i - low < 2 || high - i < 3) return gap;
  gap.nodes = {nodes_[i], nodes_[i + 1], nodes_[i - 1], nodes_[i + 2]};
  gap.checks = {Nodes<3>{nodes_[i], nodes_[i - 1], nodes_[i - 2]},
                Nodes<3>{nodes_[i + 1], nodes_[i + 2], nodes_[i + 3]}};
  gap.checked = 2;
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

bool MadeLine::is_smooth(const Gap& gap, std::size_t hoop) const {
  if (gap.checked == 0) return false;
  const std::size_t each = numbers_.size();
  const double middle = 0.5 * (x_[gap.from] + x_[gap.to]);
  const auto cubic = weights(gap.nodes, middle);
  std::array<std::array<double, 3>, 2> squares;
  for (std::size_t c = 0; c < gap.checked; ++c) squares[c] = weights(gap.checks[c], middle);
  const auto told = [&](const auto& nodes, const auto& weights, std::size_t n) {
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) sum += weights[i] * number(nodes[i], hoop, n);
    return sum;
  };
  const auto applies = [&](std::size_t n) {
    return std::any_of(gap.nodes.begin(), gap.nodes.end(),
                       [&](std::size_t node) { return !std::isnan(number(node, hoop, n)); });
  };
  for (std::size_t n = 0; n < each; ++n) {
    if (!applies(n)) continue;
    const double better = told(gap.nodes, cubic, n);
    for (std::size_t c = 0; c < gap.checked; ++c)  // NaN differs from everything
      if (!is_alike(better, told(gap.checks[c], squares[c], n), spreads_[gap.from * each + n])) return false;
  }
  return true;
}

void MadeLine::interpolate(const Gap& gap, std::size_t hoop) {
  const std::size_t each = numbers_.size();
  for (std::size_t j = gap.from + 1; j < gap.to; ++j) {
    Kind& kind = kinds_[place(j, hoop)] = kinds_[place(gap.from, hoop)];
    kind.is_solved = false;
    const auto cubic = weights(gap.nodes, x_[j]);
    for (std::size_t n = 0; n < each; ++n) {
      double& value = values_[place(j, hoop) * each + n] = 0.0;
      for (std::size_t i = 0; i < cubic.size(); ++i) value += cubic[i] * number(gap.nodes[i], hoop, n);
    }
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
        if (kinds_[place(j, k)].is_solved && number(j, k, n) == number(j, k, n))
          values.push_back(number(j, k, n));
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

/// Whether a hoop that was solved by chance differs from what its neighbours of that kind, twice as far from
/// each other as those that anything is interpolated between, would have made of it.
bool MadeLine::surprises(std::size_t drawing, std::size_t hoop) const {
  const std::size_t last = count_ - 1, from = drawing > stride ? drawing - stride : 0,
                    to = std::min(drawing + stride, last);
  const Kind &here = kinds_[place(drawing, hoop)], &around = kinds_[place(from, hoop)];
  Gap gap{.from = from, .to = to, .nodes = {from, to}};
  std::size_t filled = 2;
  const auto add = [&](std::size_t node) {
    if (filled < gap.nodes.size() && around.is_like(kinds_[place(node, hoop)])) gap.nodes[filled++] = node;
  };
  if (from > 0) add(from > stride ? from - stride : 0);
  if (to < last) add(std::min(to + stride, last));
  if (filled < gap.nodes.size() && to + stride < last) add(std::min(to + 2 * stride, last));
  if (filled < gap.nodes.size() && from > stride) add(from > 2 * stride ? from - 2 * stride : 0);
  if (!around.is_like(kinds_[place(to, hoop)]) || filled < gap.nodes.size()) return is_narrow(drawing, hoop);
  gap.checks[0] = {from, to, gap.nodes[2]}, gap.checked = 1;
  if (!is_smooth(gap, hoop)) return false;
  return !ends_like(around, here) || !is_told(gap.nodes, drawing, hoop);
}

bool MadeLine::is_told(const Nodes<4>& nodes, std::size_t drawing, std::size_t hoop) const {
  constexpr double loose = 16.0;  // nodes may be twice as far from each other as about a gap
  const auto cubic = weights(nodes, x_[drawing]);
  for (std::size_t n = 0; n < numbers_.size(); ++n) {
    double told = 0.0;
    for (std::size_t i = 0; i < cubic.size(); ++i) told += cubic[i] * number(nodes[i], hoop, n);
    const double value = number(drawing, hoop, n);
    if (value == value && !is_alike(told, value, loose * spreads_[drawing * numbers_.size() + n]))
      return false;
  }
  return true;
}

/// Whether a solved hoop lies in a band of its kind that fits between two hoops that are solved, amid
/// another, and its numbers are not what those around it say.
bool MadeLine::is_narrow(std::size_t drawing, std::size_t hoop) const {
  const auto kind_of = [&](std::size_t j) -> const Kind& { return kinds_[place(j, hoop)]; };
  const Kind& here = kind_of(drawing);
  std::size_t first = drawing, last = drawing;
  while (first > 0 && here.is_like(kind_of(first - 1))) --first;
  while (last + 1 < count_ && here.is_like(kind_of(last + 1))) ++last;
  if (first == 0 || last + 1 == count_ || last - first + 1 >= stride) return false;
  const Kind &before = kind_of(first - 1), &after = kind_of(last + 1);
  if (!before.is_solved || !after.is_solved || !before.is_like(after)) return false;
  if (!ends_like(before, here)) return true;
  std::size_t low = first - 1, high = last + 1;
  while (low > 0 && !kind_of(--low).is_solved)
    ;
  while (high + 1 < count_ && !kind_of(++high).is_solved)
    ;
  const bool has_nodes =
      low < first - 1 && ends_like(kind_of(low), here) && high > last + 1 && ends_like(kind_of(high), here);
  return !has_nodes || !is_told({first - 1, last + 1, low, high}, drawing, hoop);
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
      if (!kinds_[place(j, k)].is_solved) asked_[place(j, k)] = asks = true;
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
  const Kind& kind = kinds_[place(drawing, hoop)];
  outcome.phase_sequence = kind.phases, outcome.status = kind.status;
  outcome.spurious_first_jump = kind.spurious, outcome.candidates = kind.candidates;
  for (std::size_t n = 0; n < numbers_.size(); ++n) outcome.*numbers_[n] = number(drawing, hoop, n);
}

}  // namespace leapmap
