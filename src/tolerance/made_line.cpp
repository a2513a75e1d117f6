// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace leapmap {
namespace {

/// Numbers by chance that go with a whole number: SplitMix64.
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
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
  std::optional<std::size_t> along;
  double way = 0.0;
  Numbers last = numbers_of(drawings[0]);
  for (; line.count < drawings.size(); ++line.count) {
    const Numbers next = numbers_of(drawings[line.count]);
    const auto differs = difference(last, next);
    if (!differs || (along && along != differs)) break;
    const double step = next[*differs] - last[*differs];
    if (!(step * way >= 0.0) || !std::isfinite(step)) break;
    if (!along) line.along.push_back(last[*differs]);
    line.along.push_back(next[*differs]);
    along = differs, way = step, last = next;
  }
  return line;
}

bool MadeLine::begins(std::size_t drawing, std::size_t hoop) const {
  return drawing == 0 || drawing + 1 == count_ || (drawing + scrambled(hoop)) % stride == 0;
}

void MadeLine::keep(std::size_t at, const Outcome& outcome) {
  kinds_[at] = {outcome.phase_sequence, outcome.status, outcome.spurious_first_jump, outcome.candidates,
                true};
  for (std::size_t n = 0; n < numbers_.size(); ++n) values_[at * numbers_.size() + n] = outcome.*numbers_[n];
  ++solved_;
}

void MadeLine::solve_asked(std::span<const Design> drawings, MadeHoops& hoops, const Solver& solve) {
  constexpr std::size_t at_once = 1024;
  made_.resize(samples_), outcomes_.resize(at_once);
  batch_.clear(), places_.clear();
  const auto run = [&] {
    solve(batch_, std::span(outcomes_).first(batch_.size()));
    for (std::size_t i = 0; i < batch_.size(); ++i) keep(places_[i], outcomes_[i]);
    batch_.clear(), places_.clear();
  };
  for (std::size_t j = 0; j < count_; ++j) {
    const auto row = asked_.begin() + static_cast<std::ptrdiff_t>(place(j, 0));
    if (std::none_of(row, row + static_cast<std::ptrdiff_t>(samples_), [](char asked) { return asked; }))
      continue;
    hoops.draw(drawings[j]);
    hoops.fill(0, made_);
    for (std::size_t k = 0; k < samples_; ++k) {
      if (!std::exchange(asked_[place(j, k)], false)) continue;
      batch_.push_back(made_[k]), places_.push_back(place(j, k));
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
  if (kind.status != Status::jumped) return true;
  // Both agree that well that the better one is off by less than a hundredth of what a thousand hoops tell.
  constexpr double alike = 3e-4;
  const double x = 0.5 * (x_[from] + x_[to]);
  const auto cubic = weights<4>(nodes, x);
  const auto square = weights<3>(nodes, x);
  for (std::size_t n = 0; n < numbers_.size(); ++n) {
    double better = 0.0, worse = 0.0;
    for (std::size_t i = 0; i < cubic.size(); ++i) better += cubic[i] * number(nodes[i], hoop, n);
    for (std::size_t i = 0; i < square.size(); ++i) worse += square[i] * number(nodes[i], hoop, n);
    if (!(std::abs(better - worse) <= alike * std::abs(better))) return false;
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

void MadeLine::solve(std::span<const Design> drawings, DrawnLine line, MadeHoops& hoops,
                     const Solver& solve) {
  count_ = drawings.size(), samples_ = hoops.samples(), solved_ = 0;
  x_ = std::move(line.along);
  kinds_.assign(count_ * samples_, {});
  values_.resize(kinds_.size() * numbers_.size());
  asked_.assign(kinds_.size(), false);
  for (std::size_t j = 0; j < count_; ++j)
    for (std::size_t k = 0; k < samples_; ++k) asked_[place(j, k)] = begins(j, k);
  bool asks = true;
  while (asks) {
    solve_asked(drawings, hoops, solve);
    asks = false;
    for (std::size_t k = 0; k < samples_; ++k)
      for_gaps(k, [&](std::size_t from, std::size_t to, const Stencil& nodes) {
        if (is_smooth(from, to, nodes, k)) return;
        asked_[place((from + to) / 2, k)] = asks = true;
      });
  }
  for (std::size_t k = 0; k < samples_; ++k)
    for_gaps(
        k, [&](std::size_t from, std::size_t to, const Stencil& nodes) { interpolate(from, to, nodes, k); });
}

Outcome MadeLine::outcome(std::size_t drawing, std::size_t hoop) const {
  const Kind& kind = kinds_[place(drawing, hoop)];
  Outcome outcome;
  outcome.phase_sequence = kind.phases, outcome.status = kind.status;
  outcome.spurious_first_jump = kind.spurious, outcome.candidates = kind.candidates;
  for (std::size_t n = 0; n < numbers_.size(); ++n) outcome.*numbers_[n] = number(drawing, hoop, n);
  return outcome;
}

auto MadeLine::met_by_chance(std::size_t drawing, std::size_t hoop) const -> std::optional<Met> {
  if (drawing < stride || drawing + stride >= count_ || (drawing + scrambled(hoop)) % stride != 0) return {};
  const Kind& here = kinds_[place(drawing, hoop)];
  const std::size_t from = drawing - stride, to = drawing + stride;
  const Kind& around = kinds_[place(from, hoop)];
  if (!around.is_like(kinds_[place(to, hoop)]) || around.is_like(here)) return {};
  Stencil nodes{from, to, from, from};
  std::size_t filled = 2;
  for (const std::size_t node : {from - stride, to + stride, to + 2 * stride, from - 2 * stride})
    if (node < count_ && filled < nodes.size() && around.is_like(kinds_[place(node, hoop)]))
      nodes[filled++] = node;
  if (!is_smooth(from, to, nodes, hoop)) return {};
  std::size_t first = drawing, last = drawing;  // of its band
  while (kinds_[place(first - 1, hoop)].is_like(here)) --first;
  while (kinds_[place(last + 1, hoop)].is_like(here)) ++last;
  // A band as wide as that holds a hoop that is solved in so many of `stride` cases, and this one in one.
  const std::size_t width = last - first + 1;
  if (width >= stride) return {};
  return Met{outcome(from, hoop), static_cast<double>(stride - width)};
}

}  // namespace leapmap
