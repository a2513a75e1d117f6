// SPDX-License-Identifier: GPL-3.0-or-later
/// What is proved of boxes of designs: cut in halves until one outcome is proved of each, or two designs are
/// found whose outcomes differ.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "leapmap/prove.hpp"
#include "map/tile.hpp"
#include "model/fields.hpp"
#include "spec/designs.hpp"

namespace leapmap {

/// Throws InputError if this program cannot prove anything: before work that would end so.
void require_proofs();

/// Which outcome a design has, as discontinuities tell them apart.
struct OutcomeKind {
  Status status;
  std::uint8_t spurious_first_jump;
  long jumps_on;  ///< number of the lift-off that is the jump; 0: none

  bool operator==(const OutcomeKind&) const = default;
};
OutcomeKind outcome_kind(const Proof& proof);

struct CellProof {
  CellFinding finding = CellFinding::none;
  std::optional<OutcomeKind> kind{};              ///< of all designs, or of one of them
  Enclosure height{}, time{};                     ///< of the jumps of all
  std::optional<std::array<Design, 2>> differ{};  ///< two designs of a cell that is crossed
  long boxes = 0;                                 ///< looked at
};

/// A design with each parameter some units in the last place more or less: what doubles cannot tell apart.
DesignBox within_rounding(const Design& design);

/// Proves a box as a whole or in parts. Throws as prove does.
CellProof prove_cell(const DesignBox& box, const Scene& scene, bool times = false);

/// The cells of a spec's map: all designs nearer to one of its designs than to its neighbours along each
/// axis; of a list each design itself.
class Cells {
 public:
  /// Keeps a reference to spec. Throws InputError for what nothing can be proved of.
  explicit Cells(const Spec& spec);

  DesignBox box(std::size_t design) const;

 private:
  const Spec& spec_;
  DesignSpace space_;
};

/// The columns of a piece of a map that tell what is proved of its cells.
class ProofColumns {
 public:
  explicit ProofColumns(const Spec& spec);

  /// Proves the cells of a tile's designs `first`, first + 1, ...
  void prove(const Tiling& tiling, const Tile& tile, std::size_t first, std::size_t count);
  std::span<const double> column(const Field& field) const;

 private:
  const Spec& spec_;
  Cells cells_;
  bool times_;
  std::array<std::vector<double>, proof_columns> columns_;
};

}  // namespace leapmap
