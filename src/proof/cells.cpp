// SPDX-License-Identifier: GPL-3.0-or-later
#include "proof/cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "leapmap/errors.hpp"
#include "leapmap/solve.hpp"
#include "model/parameters.hpp"
#include "proof/acting.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

void widen(Enclosure& all, const Enclosure& one) {
  all.low = std::fmin(all.low, one.low), all.high = std::fmax(all.high, one.high);
}

double middle_of(double from, double to) { return from + 0.5 * (to - from); }

/// The corners of a box in few parameters, and the design in its middle.
std::vector<Design> designs_of(const DesignBox& box, const std::vector<double Design::*>& varying) {
  Design middle = box.from;
  for (const auto member : varying) middle.*member = middle_of(box.from.*member, box.to.*member);
  std::vector<Design> all{middle};
  constexpr std::size_t most = 4;
  const std::size_t cut = std::min(varying.size(), most);
  for (std::size_t corner = 0; corner < std::size_t{1} << cut; ++corner) {
    Design design = box.from;
    for (std::size_t k = 0; k < varying.size(); ++k)
      if (corner >> (k % most) & 1u) design.*varying[k] = box.to.*varying[k];
    all.push_back(design);
  }
  return all;
}

const Range& range_of(double Design::*member) {
  const auto row = std::ranges::find_if(parameters(), [&](const Parameter& parameter) {
    const auto* same = std::get_if<double Design::*>(&parameter.member);
    return same && *same == member;
  });
  return row->range;
}

/// A box that is still to be proved.
struct UnprovedBox {
  DesignBox box;
  std::size_t cuts = 0;
};

/// The halves of a box along one axis after the other.
std::array<UnprovedBox, 2> halves(const UnprovedBox& whole, const std::vector<double Design::*>& varying) {
  const auto member = varying[whole.cuts % varying.size()];
  std::array<UnprovedBox, 2> two{whole, whole};
  two[0].box.to.*member = two[1].box.from.*member = middle_of(whole.box.from.*member, whole.box.to.*member);
  for (UnprovedBox& half : two) ++half.cuts;
  return two;
}

}  // namespace

void require_proofs() {
  if (!can_prove()) static_cast<void>(prove(Design{}));  // which says why
}

OutcomeKind outcome_kind(const Proof& proof) {
  return {proof.status, proof.spurious_first_jump, proof.status == Status::jumped ? proof.lift_offs : 0};
}

DesignBox within_rounding(const Design& design) {
  constexpr int units = 16;
  DesignBox box{design, design};
  std::size_t varying = 0;
  constexpr std::size_t most = 7;  // of a box
  for (const auto member : acting) {
    const bool is_whole = design.*member == 0.0 || (member == &Design::offset_ratio && design.*member == 1.0);
    if (is_whole || varying == most) continue;  // as written, and no rounding of what is beside it
    ++varying;
    double &from = box.from.*member, &to = box.to.*member;
    const Range& range = range_of(member);
    for (int k = 0; k < units; ++k) {
      if (const double less = std::nextafter(from, -HUGE_VAL); range.holds(less)) from = less;
      if (const double more = std::nextafter(to, HUGE_VAL); range.holds(more)) to = more;
    }
  }
  return box;
}

CellProof prove_cell(const DesignBox& box, const Scene& scene, bool times) {
  constexpr long most_boxes = 160;
  constexpr std::size_t cuts_an_axis = 7;
  std::vector<double Design::*> varying;
  for (const auto member : acting)
    if (box.from.*member != box.to.*member) varying.push_back(member);
  CellProof cell;
  std::optional<Design> known;  // of the kind
  /// Whether a design is proved to be of another kind than one before.
  const auto differs = [&](const OutcomeKind& kind, const Design& design) {
    if (!cell.kind) cell.kind = kind, known = design;
    if (kind == *cell.kind) return false;
    cell.differ = {*known, design};
    cell.finding = CellFinding::crossed;
    return true;
  };
  /// The same of a design that the solver finds to be one.
  const auto is_another = [&](const Design& design) {
    const Outcome outcome = solve(design, scene);
    const bool jumps = outcome.status == Status::jumped;
    const OutcomeKind kind{outcome.status, outcome.spurious_first_jump, jumps ? outcome.candidates : 0};
    if (outcome.status == Status::failed || (cell.kind && kind == *cell.kind)) return false;
    const Proof proof = prove(design, scene);
    return proof.proved && differs(outcome_kind(proof), design);
  };
  std::vector<UnprovedBox> todo{{box}};
  bool is_open = false, is_timed = true;
  while (!todo.empty()) {
    throw_if_stopped();
    const UnprovedBox next = todo.back();
    todo.pop_back();
    ++cell.boxes;
    const Proof proof = prove(next.box, scene, times);
    if (proof.proved) {
      if (differs(outcome_kind(proof), designs_of(next.box, varying).front())) return cell;
      widen(cell.height, proof.height), widen(cell.time, proof.time);
      is_timed = is_timed && !std::isnan(proof.time.low);
      continue;
    }
    for (const Design& design : designs_of(next.box, varying))
      if (is_another(design)) return cell;
    if (varying.empty() || next.cuts == cuts_an_axis * varying.size() || cell.boxes >= most_boxes) {
      is_open = true;
      continue;
    }
    for (const UnprovedBox& half : halves(next, varying)) todo.push_back(half);
  }
  cell.finding = is_open ? CellFinding::open : CellFinding::proved;
  if (is_open) cell.height = {};
  if (is_open || !is_timed) cell.time = {};
  return cell;
}

Cells::Cells(const Spec& spec) : spec_(spec), space_(spec) {
  refuse_unprovable(spec.scene, origin_of(spec));
  for (const Axis& axis : spec.axes)
    if (axis.values.size() > 1 && find_body_number(axis.key))
      throw InputError(
          fmt::format("{}: {}: what is proved is of boxes in the parameters of a design; allowed: "
                      "axes of mass_ratio, offset_ratio, inertia_factor and others",
                      origin_of(spec), axis.key));
  require_proofs();
}

DesignBox Cells::box(std::size_t design) const {
  if (spec_.axes.empty()) return {space_.at(design), space_.at(design)};
  std::vector<double> from = space_.values(design), to = from;
  std::vector<std::size_t> place;
  unravel(design, shape_of(spec_), place);
  for (std::size_t k = 0; k < from.size(); ++k) {
    const std::vector<double>& values = spec_.axes[k].values;
    const std::size_t i = place[k];
    if (i > 0) from[k] = middle_of(values[i - 1], values[i]);
    if (i + 1 < values.size()) to[k] = middle_of(values[i], values[i + 1]);
  }
  DesignBox box{space_.varied().at(from), space_.varied().at(to)};
  for (const auto member : acting)
    if (box.from.*member > box.to.*member) std::swap(box.from.*member, box.to.*member);
  return box;
}

ProofColumns::ProofColumns(const Spec& spec)
    : spec_(spec), cells_(spec), times_(std::ranges::any_of(spec.output.fields, [](const std::string& name) {
        return name == "jump_time_low" || name == "jump_time_high";
      })) {}

void ProofColumns::prove(const Tiling& tiling, const Tile& tile, std::size_t first, std::size_t count) {
  for (std::vector<double>& column : columns_) column.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const CellProof cell = prove_cell(cells_.box(tiling.number(tile, first + i)), spec_.scene, times_);
    const auto put = [&](ProofColumn column, double value) {
      columns_[static_cast<std::size_t>(column)][i] = value;
    };
    put(ProofColumn::finding, static_cast<double>(cell.finding));
    put(ProofColumn::height_low, cell.height.low), put(ProofColumn::height_high, cell.height.high);
    put(ProofColumn::time_low, cell.time.low), put(ProofColumn::time_high, cell.time.high);
  }
}

std::span<const double> ProofColumns::column(const Field& field) const {
  return columns_[static_cast<std::size_t>(*field.of_proof)];
}

}  // namespace leapmap
