// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "engine/engine.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"

namespace leapmap {
namespace {

Spec grid(const std::string& method, const std::string& tolerance, const std::string& share) {
  return read_spec("", {"slope={from=0.1,to=0.8,count=40}", "mass_ratio={from=0.5,to=10,count=40}",
                        "method=" + method, "tolerance=" + tolerance, "audit=" + share});
}

std::vector<AuditSample> drawn_from(const Spec& spec, int threads = 0) {
  const Tiling tiling(shape_of(spec));
  std::vector<AuditSample> samples;
  EngineOptions options;
  options.threads = threads;
  run_sweep(spec, request_of(spec), tiling, options,
            in_order([&](const Tile& tile, std::span<const Outcome> outcomes) {
              std::ranges::copy(audit_samples(spec, tiling, tile, 0, outcomes), std::back_inserter(samples));
            }));
  return samples;
}

TEST(Audit, DrawsTheShareAskedForEachDesignOnceAndKnowsItsNumber) {
  for (const auto& [share, count] : {std::pair{"0.001", 2u}, {"0.1", 160u}, {"1", 1600u}}) {
    const Spec spec = grid("exact", "1e-12", share);
    const auto samples = drawn_from(spec);
    EXPECT_EQ(samples.size(), count);
    std::set<std::size_t> numbers;
    const DesignSpace space(spec);
    for (const AuditSample& sample : samples) {
      numbers.insert(sample.number);
      if (sample.outcome.status == Status::jumped) {
        // jump_distance is rolled from the release; only the right design's spin has that height
        const double rolled = sample.outcome.jump_angle - space.at(sample.number).release_angle;
        EXPECT_EQ(sample.outcome.jump_distance, rolled);
      }
    }
    EXPECT_EQ(numbers.size(), count);
  }
}

TEST(Audit, FindsExactAndIntegrationInAgreement) {
  const Spec spec = grid("auto", "1e-12", "0.3");
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_EQ(report.designs, 480u);
  EXPECT_EQ(report.method, "gsl-rk8pd");
  EXPECT_EQ(report.flag_mismatches + report.beyond_tolerance + report.undecided, 0u);
  EXPECT_GT(report.max_abs_height_error, 0.0) << "two methods never agree to the last bit everywhere";
  EXPECT_LT(report.max_abs_height_error, 1e-11);
}

TEST(Audit, FindsWhatALooseIntegrationGetsWrong) {
  const Spec spec = grid("gsl-rk8pd", "3e-3", "1");
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_EQ(report.method, "exact");
  EXPECT_EQ(report.designs, 1600u);
  EXPECT_GT(report.flag_mismatches, 0u);
  EXPECT_TRUE(report.first_mismatch);
}

TEST(Audit, SeesAWrongNumberThatWasStored) {
  const Spec spec = grid("exact", "1e-10", "1");
  auto samples = drawn_from(spec);
  const auto jumped =
      std::ranges::find_if(samples, [](const AuditSample& s) { return s.outcome.status == Status::jumped; });
  ASSERT_NE(jumped, samples.end());
  jumped->outcome.jump_time *= 1.0 + 1e-9;
  AuditReport report = audit(spec, samples, 0);
  EXPECT_EQ(report.first_inaccurate, jumped->number);
  EXPECT_EQ(report.beyond_tolerance, 1u);
  jumped->outcome.spurious_first_jump ^= 1;
  report = audit(spec, samples, 0);
  EXPECT_EQ(report.first_mismatch, jumped->number);
}

TEST(Audit, OfAMapInF4TellsTheErrorOfF4) {
  Spec spec = grid("exact", "1e-12", "0.3");
  spec.output.precision = "f4";
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_GT(report.max_rel_time_error, 1e-9);
  EXPECT_LT(report.max_rel_time_error, 6e-8);
  EXPECT_EQ(report.beyond_tolerance, 0u);
}

TEST(Audit, AllowsForWhatTheInputsRoundingsDo) {
  // A millionth of a millionth of a radian past the unstable equilibrium: the time is good to 1e-5 at best.
  const double equilibrium = std::numbers::pi - std::asin(std::sin(0.4) / (20.0 / 28.2)) - 0.4;
  const Spec spec = read_spec("", {fmt::format("release_angle={}", equilibrium + 1e-12), "audit=1"});
  const AuditReport report = audit(spec, drawn_from(spec), 1);
  EXPECT_GT(report.max_rel_time_error, 1e-10);
  EXPECT_EQ(report.beyond_tolerance, 0u);
}

/// One design's report, after `spoil` has put an answer that was once given in place of the right one.
template <class Spoil>
AuditReport report_on(std::vector<std::string> words, const Spoil& spoil) {
  words.insert(words.end(), {"audit=1", "radius=1", "gravity=1"});
  const Spec spec = read_spec("", words);
  std::vector<AuditSample> samples = drawn_from(spec, 1);
  const AuditReport right = audit(spec, samples, 1);
  EXPECT_FALSE(disagree(right));
  EXPECT_EQ(right.undecided, 0u);
  spoil(samples[0].outcome);
  return audit(spec, samples, 1);
}

/// The solver's own neighbours would have excused these: it was wrong at one design and right beside it, or
/// wrong at all of them alike.
TEST(Audit, ConvictsAnswersThatTheSolverOnceGave) {
  const AuditReport lost =
      report_on({"slope=0.7869897210165152", "mass_ratio=55.09232137250197", "inertia_factor=0.5",
                 "release_angle=2.0925220780510614", "release_spin=1.0270156691322998"},
                [](Outcome& o) { o.jump_height = o.first_jump_height = 3.64638, o.jump_time = 2.4657; });
  EXPECT_EQ(lost.beyond_tolerance, 1u);
  EXPECT_GT(lost.max_abs_height_error, 3.0);

  const AuditReport flag = report_on({"slope=0.2735491205258086", "mass_ratio=0.391937962544061",
                                      "inertia_factor=0.5", "release_spin=0.5070788833416867"},
                                     [](Outcome& o) { o.spurious_first_jump = 0, o.candidates = 1; });
  EXPECT_EQ(flag.flag_mismatches, 1u);
  EXPECT_EQ(flag.undecided, 0u);

  const AuditReport slow =
      report_on({"friction=coulomb", "slope=0.5647115957240031", "mass_ratio=4.246058805451686",
                 "offset_ratio=0.978398993194525", "release_angle=1.9485688953985996",
                 "release_spin=0.0005557048838113033", "mu_static=0.8376440911782836"},
                [](Outcome& o) { o.jump_time = 9.85683577353; });
  EXPECT_EQ(slow.beyond_tolerance, 1u);
  for (const AuditReport& report : {lost, flag, slow}) {
    EXPECT_EQ(report.refereed, 1u);
    EXPECT_TRUE(report.first_overruled) << "the referee finds by itself what the second method finds";
  }
}

/// Within two units in the last place of N = 0 a release is airborne or jumps at once, and both are right.
/// What is neither is wrong, also where a judge cannot decide.
TEST(Audit, ConvictsAnAnswerThatIsLikeNoneOfThoseNearbyWhereNobodyCanDecide) {
  const Spec spec = read_spec(
      "", {"slope=0.44664999745829187", "mass_ratio=2.205560224989598", "offset_ratio=0.5530702718908482",
           "inertia_factor=0.5", "release_angle=1.4064306172117094", "release_spin=4.243009454347112",
           "audit=1", "radius=1", "gravity=1"});
  std::vector<AuditSample> samples = drawn_from(spec, 1);
  EXPECT_FALSE(disagree(audit(spec, samples, 1)));
  samples[0].outcome.status = Status::jumped;
  samples[0].outcome.spurious_first_jump = 0, samples[0].outcome.candidates = 1;
  samples[0].outcome.jump_height = samples[0].outcome.first_jump_height = 1.0063;
  samples[0].outcome.jump_time = samples[0].outcome.first_jump_time = 1.44;
  const AuditReport report = audit(spec, samples, 1);
  EXPECT_EQ(report.undecided, 0u);
  EXPECT_TRUE(report.first_inaccurate || report.first_mismatch);
  EXPECT_TRUE(report.first_overruled);
}

/// A grid of bouncing hoops, whose number of hops is another at every unit in the last place.
TEST(Audit, ConvictsNobodyWhereEveryAnswerNearbyIsAnother) {
  const Spec spec =
      read_spec("", {"friction=coulomb", "restitution=0.842", "mu_static=0.94", "mu_kinetic=0.6", "runway=20",
                     "hop_height=1", "slope={from=0.2,to=0.6,count=6}", "mass_ratio={from=2,to=12,count=6}",
                     "audit=1"});
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_EQ(report.designs, 36u);
  EXPECT_FALSE(disagree(report));
}

/// Its times go with the root of the distance from a fold, and the integration has the worse one.
TEST(Audit, DoesNotConvictBesideAFold) {
  const Spec spec = read_spec(
      "", {"slope=0.8846815059690065", "mass_ratio=3.4782721611411747", "offset_ratio=0.3594395109165115",
           "inertia_factor=0.5", "release_angle=2.1740918245867857", "audit=1"});
  EXPECT_FALSE(disagree(audit(spec, drawn_from(spec), 1)));
}

TEST(Audit, CallsTheRefereeToATenthOfItsDesigns) {
  const Spec spec = grid("exact", "1e-12", "0.3");
  const AuditReport report = audit(spec, drawn_from(spec), 0);
  EXPECT_GT(report.refereed, 480u / 20);
  EXPECT_LT(report.refereed, 480u / 5);
  EXPECT_EQ(report.referee_undecided, 0u);
  EXPECT_FALSE(report.first_overruled);
  EXPECT_GT(report.referee_max_error, 0.0);
  EXPECT_LT(report.referee_max_error, 1e-11);
}

TEST(Audit, LooksAtEveryQuantity) {
  for (double Outcome::*member :
       {&Outcome::jump_angle, &Outcome::jump_spin, &Outcome::jump_distance, &Outcome::slip_distance,
        &Outcome::landing_spin, &Outcome::energy_lost, &Outcome::dip, &Outcome::flight_time,
        &Outcome::apex_time, &Outcome::first_jump_time}) {
    const AuditReport report =
        report_on({"friction=coulomb"}, [&](Outcome& o) { o.*member = o.*member * (1.0 + 1e-7) + 1e-7; });
    EXPECT_EQ(report.beyond_tolerance, 1u);
  }
  for (const Field& field : map_fields()) {
    if (field.by_default != ByDefault::told) continue;
    const auto member = std::get<Quantity>(field.source).member;
    const AuditReport report =
        report_on({"friction=coulomb", fmt::format("fields=[\"status\",\"{}\"]", field.name)},
                  [&](Outcome& o) { o.*member = o.*member * (1.0 + 1e-7) + 1e-7; });
    EXPECT_EQ(report.beyond_tolerance, 1u) << field.name;
  }
}

/// The solver recognises a hoop that rocks to rest long before it rests. What the hoop has slid until then is
/// not what it slides to the end.
TEST(Audit, TellsNoSlipOfAHoopThatRocksToRest) {
  const Spec spec = read_spec(
      "", {"friction=coulomb", "runway=5", "slope=-0.12186865540293429", "mass_ratio=6.919339825756405",
           "offset_ratio=0.769311213770517", "inertia_factor=0.559395597147864",
           "release_angle=1.8161537140794959", "drive_torque=0.30999656790168906",
           "mu_static=0.1612873630855277", "mu_kinetic=0.1602475764819464", "audit=1"});
  const std::vector<AuditSample> drawn = drawn_from(spec);
  ASSERT_EQ(drawn.size(), 1u);
  EXPECT_EQ(drawn[0].outcome.status, Status::stalled);
  EXPECT_TRUE(std::isnan(drawn[0].outcome.slip_distance));
  const AuditReport report = audit(spec, drawn, 1);
  EXPECT_EQ(report.refereed, 1u);
  EXPECT_FALSE(disagree(report));
}

TEST(Audit, MissesNoSlipOfAHoopThatComesToRest) {
  Outcome spoiled;
  const AuditReport report =
      report_on({"friction=coulomb", "slope=0.05", "mass_ratio=1", "mu_static=2", "release_angle=1.5"},
                [&](Outcome& o) { o.slip_distance = std::nan(""), spoiled = o; });
  ASSERT_EQ(spoiled.status, Status::stalled);
  ASSERT_EQ(spoiled.phase_sequence >> 62, 0u) << "after few phases";
  EXPECT_EQ(report.beyond_tolerance, 1u);
}

TEST(Audit, DoesNotDependOnTheNumberOfThreads) {
  const Spec spec = grid("exact", "1e-5", "0.3");
  const AuditReport one = audit(spec, drawn_from(spec, 1), 1), four = audit(spec, drawn_from(spec, 4), 4);
  EXPECT_EQ(one.designs, four.designs);
  EXPECT_EQ(one.max_abs_height_error, four.max_abs_height_error);
  EXPECT_EQ(one.max_rel_time_error, four.max_rel_time_error);
  EXPECT_EQ(one.first_mismatch, four.first_mismatch);
  EXPECT_EQ(one.refereed, four.refereed);
  EXPECT_EQ(one.referee_max_error, four.referee_max_error);
}

TEST(Audit, DoesNotTakeADesignThatFailedForADisagreement) {
  Spec spec = grid("gsl-rk8pd", "1e-10", "0.3");
  spec.numerics.max_steps = 40;
  const auto samples = drawn_from(spec);
  const auto failed =
      std::ranges::count(samples, Status::failed, [](const AuditSample& s) { return s.outcome.status; });
  const AuditReport report = audit(spec, samples, 0);
  EXPECT_GT(report.failed, 0u);
  EXPECT_EQ(report.failed, static_cast<std::size_t>(failed));
  EXPECT_LT(report.failed, report.designs);
  EXPECT_EQ(report.flag_mismatches + report.beyond_tolerance, 0u);
}

TEST(Audit, LooksAtDerivativesByEveryParameter) {
  const Spec spec = read_spec("", {"slope={from=0.3,to=0.6,count=10}", "mass_ratio={from=1,to=4,count=10}",
                                   "offset_ratio=0.8", "gradients=[\"jump_height\"]", "audit=1"});
  const DesignSpace space(spec);
  std::vector<Design> designs;
  for (std::size_t i = 0; i < 100; ++i) designs.push_back(space.at(i));
  std::vector<Outcome> outcomes(designs.size());
  Gradients gradients(derivatives_of(request_of(spec)));
  make_gradient_solver(request_of(spec))(designs, outcomes, gradients);
  const std::size_t parameters = gradients.wanted().by.size();
  ASSERT_EQ(parameters, 7u);
  for (std::size_t spoiled = 0; spoiled <= parameters; ++spoiled) {  // the last one: none
    std::vector<AuditSample> samples;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      samples.push_back({i, outcomes[i]});
      for (std::size_t j = 0; j < parameters; ++j)
        samples.back().gradient.push_back(gradients.column(0, j)[i] + (j == spoiled ? 0.1 : 0.0));
    }
    const AuditReport report = audit(spec, samples, 0);
    EXPECT_EQ(report.gradients_wrong > 0, spoiled < parameters) << spoiled;
  }
}

/// One design whose derivative by one parameter is wrong, as a panel that does not resolve it makes it.
TEST(Audit, ConvictsOneWrongDerivativeWithFriction) {
  const Spec spec =
      read_spec("", {"friction=coulomb", "slope=0.30637631722143877", "mass_ratio=2.483827084653167",
                     "offset_ratio=0.5830303986127652", "release_angle=4.658042210229609",
                     "release_spin=-0.9399108160617516", "mu_static=0.10873542033895064",
                     "mu_kinetic=0.09786187830505558", "gradients=[\"jump_time\"]", "audit=1"});
  const std::vector<Design> designs{DesignSpace(spec).at(0)};
  std::vector<Outcome> outcomes(1);
  Gradients gradients(derivatives_of(request_of(spec)));
  make_gradient_solver(request_of(spec))(designs, outcomes, gradients);
  const std::size_t parameters = gradients.wanted().by.size();
  ASSERT_EQ(parameters, differentiable.size() - 1) << "there is no resisting torque";
  for (std::size_t spoiled = 0; spoiled <= parameters; ++spoiled) {  // the last one: none
    AuditSample sample{0, outcomes[0], {}};
    for (std::size_t j = 0; j < parameters; ++j)
      sample.gradient.push_back(gradients.column(0, j)[0] * (j == spoiled ? 1.0 + 1e-2 : 1.0));
    // Without a rebound the restitution does not act: nothing times anything is nothing.
    const bool is_wrong = spoiled < parameters && gradients.column(0, spoiled)[0] != 0.0;
    EXPECT_EQ(audit(spec, {&sample, 1}, 0).gradients_wrong, is_wrong ? 1u : 0u) << spoiled;
  }
}

TEST(Audit, NeverAuditsAMethodByItself) {
  Numerics numerics;
  EXPECT_NE(audit_method(numerics, Scene{}), resolved_method(numerics, Scene{}));
  for (const GslStepper& stepper : gsl_steppers()) {
    numerics.method = stepper.name;
    EXPECT_EQ(audit_method(numerics, Scene{}), "exact");
  }
}

}  // namespace
}  // namespace leapmap
