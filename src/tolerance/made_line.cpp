// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
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
void MadeLine::for_gaps(std::size_t hoop, const F& gap) {
  nodes_.clear();
  for (std::size_t j = 0; j < count_; ++j)
    if (kinds_[place(j, hoop)].is_solved) nodes_.push_back(j);
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
    if (nodes_[i + 1] - nodes_[i] == 1) continue;
    // Both ends of the gap, then the nearest ones of its kind on both sides; beside another kind or the
    // line's end both on one side.
    Stencil nodes{nodes_[i], nodes_[i + 1], nodes_[i], nodes_[i]};  // of fewer than four: not smooth
    const Kind& kind = kinds_[place(nodes_[i], hoop)];
    const auto is_like = [&](std::size_t k) { return kind.is_like(kinds_[place(nodes_[k], hoop)]); };
    std::size_t low = i, high = i + 1;
    while (low > 0 && i - low < 2 && is_like(low - 1)) --low;
    while (high + 1 < nodes_.size() && high - i < 3 && is_like(high + 1)) ++high;
    if (is_like(i + 1) && high - low >= 3) {
      const std::size_t first = std::clamp(i > 0 ? i - 1 : 0, low, high - 3);
      for (std::size_t k = first, filled = 2; filled < nodes.size(); ++k)
        if (k != i && k != i + 1) nodes[filled++] = nodes_[k];
    }
    gap(nodes_[i], nodes_[i + 1], nodes);
  }
}

template <std::size_t N>
std::array<double, N> MadeLine::weights(const Stencil& nodes, double x) const {
  std::array<double, N> weights;
  for (std::size_t i = 0; i < N; ++i) {
    double weight = 1.0;
    for (std::size_t k = 0; k < N; ++k)
      if (k != i) weight *= (x - x_[nodes[k]]) / (x_[nodes[i]] - x_[nodes[k]]);
    weights[i] = weight;
  }
  return weights;
}

bool MadeLine::is_smooth(std::size_t from, std::size_t to, const Stencil& nodes, std::size_t hoop) const {
  const Kind& kind = kinds_[place(from, hoop)];
  if (kind.status == Status::failed || nodes[2] == nodes[3]) return false;
  const std::size_t each = numbers_.size();
  const auto cubic = weights<4>(nodes, 0.5 * (x_[from] + x_[to]));
  const auto square = weights<3>(nodes, 0.5 * (x_[from] + x_[to]));
  for (std::size_t n = 0; n < each; ++n) {
    double better = 0.0, worse = 0.0;
    bool applies = false;
    for (std::size_t i = 0; i < cubic.size(); ++i) {
      const double value = number(nodes[i], hoop, n);
      applies = applies || value == value;
      better += cubic[i] * value;
      if (i < square.size()) worse += square[i] * value;
    }
    // NaN differs from everything.
    if (applies && !is_alike(better, worse, spreads_[from * each + n])) return false;
  }
  return true;
}

void MadeLine::interpolate(std::size_t from, std::size_t to, const Stencil& nodes, std::size_t hoop) {
  const std::size_t each = numbers_.size();
  for (std::size_t j = from + 1; j < to; ++j) {
    Kind& kind = kinds_[place(j, hoop)] = kinds_[place(from, hoop)];
    kind.is_solved = false;
    const auto cubic = weights<4>(nodes, x_[j]);
    for (std::size_t n = 0; n < each; ++n) {
      double& value = values_[place(j, hoop) * each + n] = 0.0;
      for (std::size_t i = 0; i < cubic.size(); ++i) value += cubic[i] * number(nodes[i], hoop, n);
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
      for_gaps(k, [&](std::size_t from, std::size_t to, const Stencil& nodes) {
        if (is_smooth(from, to, nodes, k)) return;
        asked_[place((from + to) / 2, k)] = asks = true;
      });
  }
}

/// Whether a hoop that was solved by chance differs from what its neighbours of that kind, twice as far from
/// each other as those that anything is interpolated between, would have made of it.
bool MadeLine::surprises(std::size_t drawing, std::size_t hoop) const {
  const std::size_t last = count_ - 1, from = drawing > stride ? drawing - stride : 0,
                    to = std::min(drawing + stride, last);
  const Kind &here = kinds_[place(drawing, hoop)], &around = kinds_[place(from, hoop)];
  Stencil nodes{from, to, from, from};
  std::size_t filled = 2;
  const auto add = [&](std::size_t node) {
    if (filled < nodes.size() && around.is_like(kinds_[place(node, hoop)])) nodes[filled++] = node;
  };
  if (from > 0) add(from > stride ? from - stride : 0);
  if (to < last) add(std::min(to + stride, last));
  if (filled < nodes.size() && to + stride < last) add(std::min(to + 2 * stride, last));
  if (filled < nodes.size() && from > stride) add(from > 2 * stride ? from - 2 * stride : 0);
  if (!around.is_like(kinds_[place(to, hoop)]) || filled < nodes.size()) return is_narrow(drawing, hoop);
  if (!is_smooth(from, to, nodes, hoop)) return false;
  if (!around.is_like(here)) return true;
  constexpr double loose = 16.0;  // between nodes twice as far from each other
  const auto cubic = weights<4>(nodes, x_[drawing]);
  for (std::size_t n = 0; n < numbers_.size(); ++n) {
    double told = 0.0;
    for (std::size_t i = 0; i < cubic.size(); ++i) told += cubic[i] * number(nodes[i], hoop, n);
    const double value = number(drawing, hoop, n);
    if (value == value && !is_alike(told, value, loose * spreads_[drawing * numbers_.size() + n]))
      return true;
  }
  return false;
}

/// Whether a solved hoop lies in a band of its kind that fits between two hoops that are solved, amid
/// another.
bool MadeLine::is_narrow(std::size_t drawing, std::size_t hoop) const {
  const Kind& here = kinds_[place(drawing, hoop)];
  std::size_t first = drawing, last = drawing;
  while (first > 0 && here.is_like(kinds_[place(first - 1, hoop)])) --first;
  while (last + 1 < count_ && here.is_like(kinds_[place(last + 1, hoop)])) ++last;
  if (first == 0 || last + 1 == count_ || last - first + 1 >= stride) return false;
  const Kind &before = kinds_[place(first - 1, hoop)], &after = kinds_[place(last + 1, hoop)];
  return before.is_solved && after.is_solved && before.is_like(after);
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
  for (std::size_t k = 0; k < samples_; ++k)
    for_gaps(
        k, [&](std::size_t from, std::size_t to, const Stencil& nodes) { interpolate(from, to, nodes, k); });
}

void MadeLine::put(std::size_t drawing, std::size_t hoop, Outcome& outcome) const {
  const Kind& kind = kinds_[place(drawing, hoop)];
  outcome.phase_sequence = kind.phases, outcome.status = kind.status;
  outcome.spurious_first_jump = kind.spurious, outcome.candidates = kind.candidates;
  for (std::size_t n = 0; n < numbers_.size(); ++n) outcome.*numbers_[n] = number(drawing, hoop, n);
}

}  // namespace leapmap
