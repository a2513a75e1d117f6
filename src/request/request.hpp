// SPDX-License-Identifier: GPL-3.0-or-later
/// What is asked of designs. Solvers are made from a request; a spec is only what a file says.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hoop/body.hpp"
#include "leapmap/scene.hpp"
#include "leapmap/spec.hpp"
#include "model/fields.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

struct Request {
  Scene scene{};        ///< what is simulated
  Numerics numerics{};  ///< the method and its settings
  /// The wanted quantities, derivatives and statistics of manufactured hoops, in order. The rest need not be
  /// computed, and may be NaN.
  std::vector<const Field*> columns{};
  Scatter scatter{};             ///< the tolerances of manufactured hoops
  std::vector<Goal> goals{};     ///< what counts as their yield
  std::optional<Body> hoop{};    ///< the nominal body, if the spec has [hoop]
  std::vector<SameInSi> held{};  ///< parameters in the units of the nominal hoop
};

/// The columns of the spec's map, in the order of the file: those that it names; by default all that its
/// scene has, but for those that must be named; then derivatives; then statistics of manufactured hoops.
std::vector<const Field*> columns_of(const Spec& spec);

/// What the spec's map asks.
Request request_of(const Spec& spec);
/// What these columns ask of the spec's designs.
Request request_of(const Spec& spec, std::vector<const Field*> columns);
/// What solve tells of designs if nobody names fields.
Request request_of_outcomes(const Spec& spec);
/// The same and the measures of the way to the jump.
Request request_with_ways(const Spec& spec);
/// Every field that the scene has, even those that must be named.
Request request_of_everything(const Spec& spec);

/// What is asked of each hoop of a manufactured sample: what its goals and statistics need.
Request request_of_sample(const Request& request);

/// Adds a column that is not there yet.
void add_column(std::vector<const Field*>& columns, const Field* column);

bool wants(const Request& request, std::string_view field);
/// Whether hoops are to be manufactured: for statistics.
bool wants_samples(const Request& request);
/// Whether something is to be proved of the cells of a map.
bool wants_proofs(const Request& request);
/// Whether there are derivatives by numbers of [hoop] among the columns.
bool derives_by_body(const Request& request);
/// Whether the gaits that jumps converge to are to be found.
bool wants_gaits(const Request& request);

/// The scene with no more jumps than the columns of nominal designs need.
Scene scene_asked(const Request& request);
/// The same with as many jumps as are followed in all: of gaits, until transients have settled.
Scene scene_followed(const Request& request);

/// The derivatives among the columns: every quantity that is derived, by every parameter.
GradientWanted derivatives_of(const Request& request);

/// The columns of derivatives of these quantities by the parameters named; none named: all of the scene's
/// model.
std::vector<const Field*> derivative_columns(const Scene& scene, const std::vector<OutcomeNumber>& of,
                                             const std::vector<std::string>& by = {});

/// The columns that are statistics of manufactured hoops.
std::vector<const Field*> statistics_of(const Request& request);

}  // namespace leapmap
