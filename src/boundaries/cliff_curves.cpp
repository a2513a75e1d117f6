// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundaries/cliff_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "map/tile.hpp"

namespace leapmap {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// Two cliffs, or one and a place in the plane, in a cell.
struct Segment {
  std::size_t from, to;  ///< cliffs; to: none if it ends where others meet
  std::vector<double> meeting;
  CliffKind kind;
};

/// What is on the two sides of a cliff, whichever way it is passed.
bool between_the_same(const Cliff& a, const Cliff& b) {
  return (a.below == b.below && a.above == b.above) || (a.below == b.above && a.above == b.below);
}

/// The planes of two axes of a grid.
class Plane {
 public:
  explicit Plane(const Boundaries& boundaries) : boundaries_(boundaries), cliffs_(boundaries.cliffs) {
    for (const Axis& axis : boundaries.axes) shape_.push_back(axis.values.size());
    for (std::size_t k = 0; k < shape_.size(); ++k)
      if (k != row_axis() && k != column_axis()) others_.push_back(shape_[k]);
    for (std::size_t i = 0; i < cliffs_.size(); ++i)
      if (cliffs_[i].axis == row_axis() || cliffs_[i].axis == column_axis())
        on_edge_[edge(cliffs_[i].design, cliffs_[i].axis == column_axis())].push_back(i);
  }

  std::size_t planes() const {
    std::size_t count = 1;
    for (const std::size_t other : others_) count *= other;
    return count;
  }

  /// The segments in every cell of a plane.
  std::vector<Segment> segments(std::size_t plane) const {
    std::vector<std::size_t> elsewhere;
    unravel(plane, others_, elsewhere);
    std::size_t first = 0;  // the plane's first design
    for (std::size_t k = 0, other = 0; k < shape_.size(); ++k)
      if (k != row_axis() && k != column_axis()) first += elsewhere[other++] * stride(k);
    std::vector<Segment> all;
    for (std::size_t row = 0; row + 1 < shape_[row_axis()]; ++row)
      for (std::size_t column = 0; column + 1 < shape_[column_axis()]; ++column)
        in_cell(first + row * stride(row_axis()) + column * stride(column_axis()), all);
    return all;
  }

 private:
  std::size_t row_axis() const { return boundaries_.plane[0]; }
  std::size_t column_axis() const { return boundaries_.plane[1]; }
  /// How far apart designs are that are neighbours along an axis.
  std::size_t stride(std::size_t axis) const {
    std::size_t step = 1;
    for (std::size_t k = axis + 1; k < shape_.size(); ++k) step *= shape_[k];
    return step;
  }
  static std::size_t edge(std::size_t design, bool along_columns) { return 2 * design + along_columns; }

  /// The cliffs around a cell whose first corner is `design`, in order around it.
  std::vector<std::size_t> around(std::size_t design) const {
    std::vector<std::size_t> found;
    const auto add = [&](std::size_t number, bool forwards) {
      const auto there = on_edge_.find(number);
      if (there == on_edge_.end()) return;
      std::vector<std::size_t> some = there->second;
      // By place on the edge, from its first design on.
      if (forwards != rises_along(cliffs_[some[0]])) std::ranges::reverse(some);
      found.insert(found.end(), some.begin(), some.end());
    };
    add(edge(design, true), true);
    add(edge(design + stride(column_axis()), false), true);
    add(edge(design + stride(row_axis()), true), false);
    add(edge(design, false), false);
    return found;
  }

  /// Whether values rise on the edge that a cliff lies on.
  bool rises_along(const Cliff& cliff) const {
    const std::vector<double>& values = boundaries_.axes[cliff.axis].values;
    const std::size_t k = place_along(shape_, cliff.design, cliff.axis);
    return values[k + 1] > values[k];
  }

  /// Neighbours around the cell between the same outcomes are joined, so that no two joints cross; what is
  /// left leads to where outcomes meet.
  void in_cell(std::size_t design, std::vector<Segment>& all) const {
    std::vector<std::size_t> open = around(design);
    if (open.empty()) return;
    for (bool joined = true; joined && open.size() > 1;) {
      joined = false;
      // The nearest two first, of those that may be joined.
      std::size_t best = none;
      double nearest = HUGE_VAL;
      for (std::size_t i = 0; i < open.size(); ++i) {
        const std::size_t j = (i + 1) % open.size();
        if (open.size() == 2 && i == 1) continue;
        if (!between_the_same(cliffs_[open[i]], cliffs_[open[j]])) continue;
        if (const double far = apart(open[i], open[j]); far < nearest) nearest = far, best = i;
      }
      if (best == none) break;
      const std::size_t a = open[best], b = open[(best + 1) % open.size()];
      all.push_back({a, b, {}, cliffs_[a].kind == cliffs_[b].kind ? cliffs_[a].kind : later_kind(a, b)});
      std::erase_if(open, [&](std::size_t i) { return i == a || i == b; });
      joined = true;
    }
    if (open.size() < 3) return;  // a curve that ends in the cell
    std::vector<double> middle(2, 0.0);
    for (const std::size_t i : open) {
      const std::vector<double> at = place(i);
      middle[0] += at[0] / static_cast<double>(open.size()),
          middle[1] += at[1] / static_cast<double>(open.size());
    }
    for (const std::size_t i : open) all.push_back({i, none, middle, cliffs_[i].kind});
  }

  CliffKind later_kind(std::size_t a, std::size_t b) const {
    return std::max(cliffs_[a].kind, cliffs_[b].kind);
  }

  std::vector<double> place(std::size_t i) const {
    const std::vector<double> at = place_of(boundaries_, cliffs_[i]);
    return {at[row_axis()], at[column_axis()]};
  }

  /// In cells of the grid.
  double apart(std::size_t a, std::size_t b) const {
    const std::vector<double> p = in_cells(a), q = in_cells(b);
    return std::hypot(p[0] - q[0], p[1] - q[1]);
  }
  std::vector<double> in_cells(std::size_t i) const {
    const Cliff& cliff = cliffs_[i];
    std::vector<std::size_t> position;
    unravel(cliff.design, shape_, position);
    std::vector<double> at{static_cast<double>(position[row_axis()]),
                           static_cast<double>(position[column_axis()])};
    const std::vector<double>& values = boundaries_.axes[cliff.axis].values;
    const std::size_t k = position[cliff.axis];
    at[cliff.axis == column_axis()] += (cliff.value - values[k]) / (values[k + 1] - values[k]);
    return at;
  }

  const Boundaries& boundaries_;
  const std::vector<Cliff>& cliffs_;
  std::vector<std::size_t> shape_, others_;
  std::unordered_map<std::size_t, std::vector<std::size_t>> on_edge_;
};

/// Segments of one kind that share a cliff, one after the other.
void chain(const std::vector<Segment>& segments, std::vector<CliffCurve>& curves) {
  std::map<std::pair<std::size_t, CliffKind>, std::vector<std::size_t>> at;  // segments by end and kind
  for (std::size_t s = 0; s < segments.size(); ++s)
    for (const std::size_t end : {segments[s].from, segments[s].to})
      if (end != none) at[{end, segments[s].kind}].push_back(s);
  std::vector<bool> used(segments.size(), false);
  for (std::size_t start = 0; start < segments.size(); ++start) {
    if (used[start]) continue;
    used[start] = true;
    const Segment& first = segments[start];
    CliffCurve curve{first.kind, {first.from}, {}, first.meeting};
    if (first.to != none) curve.cliffs.push_back(first.to);
    const auto grow = [&] {  // from the curve's last cliff on
      while (curve.meeting_to.empty()) {
        const std::size_t end = curve.cliffs.back();
        const auto& there = at[{end, first.kind}];
        const auto next = std::ranges::find_if(there, [&](std::size_t s) { return !used[s]; });
        if (next == there.end()) return;
        used[*next] = true;
        const Segment& segment = segments[*next];
        const std::size_t other = segment.from == end ? segment.to : segment.from;
        if (other == none)
          curve.meeting_to = segment.meeting;
        else
          curve.cliffs.push_back(other);
      }
    };
    grow();
    std::ranges::reverse(curve.cliffs);
    std::swap(curve.meeting_from, curve.meeting_to);
    grow();
    curves.push_back(std::move(curve));
  }
}

}  // namespace

std::vector<CliffCurve> curves_of(const Boundaries& boundaries) {
  std::vector<CliffCurve> curves;
  if (boundaries.plane.empty()) return curves;
  const Plane plane(boundaries);
  for (std::size_t k = 0; k < plane.planes(); ++k) chain(plane.segments(k), curves);
  return curves;
}

}  // namespace leapmap
