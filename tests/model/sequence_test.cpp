// SPDX-License-Identifier: GPL-3.0-or-later
/// Jump after jump: sequences in both models against tables, long double, integration and differences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include "hoop/contact_state.hpp"
#include "leapmap/gradient.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/trace.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "support/reference_table.hpp"

namespace leapmap {
namespace {

constexpr Scene unit{.radius = 1.0, .gravity = 1.0};

Scene sequence_scene(Friction friction, long jumps) {
  Scene scene = unit;
  scene.friction = friction, scene.jumps = jumps, scene.runway = 20.0;
  return scene;
}

/// A table's jumps against a method's.
void check_table(const std::string& name, Scene scene, const SolveOptions& options, double tolerance) {
  scene.motor_in_flight = false;
  const auto rows = testing::read_reference(name);
  ASSERT_GE(rows.size(), 60u);
  double worst = 0.0;
  std::size_t sinking = 0;
  for (const auto& row : rows) {
    Design design = row.design();
    if (scene.friction == Friction::coulomb) {
      design.mu_static = row.number("mu_static"), design.mu_kinetic = row.number("mu_kinetic");
      design.restitution = row.number("restitution");
    }
    const Outcome outcome = solve(design, scene, options);
    const auto jumps = static_cast<std::size_t>(row.number("jumps"));
    // The table follows flights that begin by sinking, where a motor that lifted the hoop off idles.
    if (outcome.sequence_end == Status::indeterminate && design.drive_torque != 0.0) {
      EXPECT_LE(++sinking, 2u);
      continue;
    }
    ASSERT_EQ(outcome.jumps(), jumps) << name << " slope " << design.slope;
    for (std::size_t jump = 1; jump <= jumps; ++jump) {
      const std::string number = std::to_string(jump);
      const double height = jump == 1 ? outcome.jump_height : outcome.later_jumps[jump - 2].height,
                   time = jump == 1 ? outcome.jump_time : outcome.later_jumps[jump - 2].time;
      worst = std::max({worst, std::abs(height / row.number("jump_height_" + number) - 1.0),
                        std::abs(time / row.number("jump_time_" + number) - 1.0)});
    }
  }
  EXPECT_LE(worst, tolerance) << name;
}

/// Released at rest or with a little spin, as random designs are that jump often.
std::vector<Design> lively_designs(std::size_t count, unsigned seed, Friction friction) {
  std::mt19937_64 random(seed);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<Design> designs(count);
  for (Design& design : designs) {
    design.slope = between(0.05, 0.7);
    design.mass_ratio = std::exp(between(std::log(0.5), std::log(10.0)));
    design.offset_ratio = between(0.4, 1.0);
    design.inertia_factor = between(0.5, 1.0);
    design.release_spin = between(0.0, 0.5);
    if (friction == Friction::coulomb) {
      design.mu_static = between(0.2, 1.0), design.mu_kinetic = design.mu_static * between(0.7, 1.0);
      design.restitution = between(0.0, 1.0) < 0.5 ? 0.0 : between(0.0, 0.5);
    }
  }
  return designs;
}

TEST(Sequences, AreThoseOfTheTableWithoutSlip) {
  check_table("noslip_sequences.csv", sequence_scene(Friction::sticking, 4), {.tolerance = 1e-12}, 1e-11);
}

TEST(Sequences, AreThoseOfTheTableWithFriction) {
  // The table has about eight digits.
  check_table("coulomb_sequences.csv", sequence_scene(Friction::coulomb, 3), {.tolerance = 1e-12}, 1e-8);
}

TEST(Sequences, AreThoseOfTheTableByIntegrationToo) {
  // An integration's own error at that tolerance, grown from jump to jump.
  const SolveOptions options{.method = "gsl-rk8pd", .tolerance = 1e-13};
  check_table("noslip_sequences.csv", sequence_scene(Friction::sticking, 4), options, 1e-9);
  check_table("coulomb_sequences.csv", sequence_scene(Friction::coulomb, 3), options, 1e-7);
}

TEST(Sequences, LeaveTheFirstJumpAsItIs) {
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const std::vector<Design> designs = lively_designs(200, 3, friction);
    Scene one = sequence_scene(friction, 1);
    const auto first = solve(designs, one), sequence = solve(designs, sequence_scene(friction, 3));
    std::size_t go_on = 0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      for (const Field& field : map_fields()) {
        if (field.of_sequence) continue;
        const double a = stored_number(field, first[i]), b = stored_number(field, sequence[i]);
        EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << field.name << " of design " << i;
      }
      EXPECT_EQ(first[i].phase_sequence, sequence[i].phase_sequence);
      EXPECT_EQ(first[i].jumps(), first[i].status == Status::jumped ? 1u : 0u);
      go_on += sequence[i].jumps() > 1;
    }
    EXPECT_GE(go_on, 60u);
  }
}

TEST(Sequences, AreThoseOfLongDouble) {
  // Rounding grows by the return map's slope, some tens a jump at worst; beyond five jumps of these it may
  // not.
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene scene = sequence_scene(friction, 4);
    std::size_t jumps = 0, different = 0;
    const auto designs = lively_designs(friction == Friction::sticking ? 300 : 60, 11, friction);
    for (const Design& design : designs) {
      const Outcome ours = solve(design, scene, {.tolerance = 1e-12}),
                    truth = model_of(friction).refined(design, scene);
      if (ours.jumps() != truth.jumps()) {
        ++different;
        continue;
      }
      EXPECT_EQ(ours.sequence_end, truth.sequence_end);
      for (std::size_t k = 0; k < ours.later_jumps.size(); ++k, ++jumps) {
        EXPECT_NEAR(ours.later_jumps[k].height, truth.later_jumps[k].height, 1e-8);
        EXPECT_NEAR(ours.later_jumps[k].time / truth.later_jumps[k].time, 1.0, 1e-9);
      }
    }
    EXPECT_GE(jumps, designs.size());
    EXPECT_LE(different, 1u);
  }
}

TEST(Sequences, LoseWhatTheirLandingsTake) {
  // Energy from landing to landing: what the motor adds less what friction and impulses take. Without slip
  // rolling loses none, and a landing that holds takes P . v / 2 of impulse P and velocity v before it.
  const Design hoop{.slope = 0.35, .mass_ratio = 3.0, .offset_ratio = 0.8, .drive_torque = 0.05};
  const Scene scene = sequence_scene(Friction::sticking, 6);
  const Outcome outcome = solve(hoop, scene);
  ASSERT_GE(outcome.jumps(), 3u);
  const Hoop<double> h = reduce<double>(hoop, scene);
  Jump before = outcome.later_jumps[0];
  for (std::size_t k = 0; k < outcome.later_jumps.size(); ++k) {
    const Jump& jump = outcome.later_jumps[k];
    const ContactState<double> lift_off{
        .time = jump.time, .travel = jump.distance, .angle = jump.angle, .spin = jump.spin};
    const ContactState<double> touch = after_flight(h, lift_off, jump.flight_time);
    ContactState<double> after = touch;
    after.spin = jump.landing_spin, after.slip = after.normal = 0.0;
    const double lost = contact_energy(h, touch) - contact_energy(h, after);
    EXPECT_NEAR(contact_energy(h, lift_off) + h.drive * (touch.angle - lift_off.angle),
                contact_energy(h, touch), 1e-12);
    // Impulse: what the centre of mass's velocity gains.
    const Trig<double> phi = trig(touch.angle);
    const auto velocity = [&](const ContactState<double>& at) {
      return std::pair(at.slip + (h.clearance + h.rho * phi.versine) * at.spin,
                       at.normal + h.rho * phi.sin * at.spin);
    };
    const auto [x0, y0] = velocity(touch);
    const auto [x1, y1] = velocity(after);
    EXPECT_NEAR(lost, -0.5 * ((x1 - x0) * touch.slip + (y1 - y0) * touch.normal), 1e-12);
    EXPECT_GT(lost, 0.0);
    if (k > 0) {
      ContactState<double> landed = after_flight(
          h,
          ContactState<double>{
              .time = before.time, .travel = before.distance, .angle = before.angle, .spin = before.spin},
          before.flight_time);
      const double contact_turn = jump.angle - landed.angle;
      landed.spin = before.landing_spin, landed.slip = landed.normal = 0.0;
      EXPECT_NEAR(contact_energy(h, lift_off), contact_energy(h, landed) + hoop.drive_torque * contact_turn,
                  1e-11);
    }
    before = jump;
  }
}

TEST(Sequences, HaveDerivativesThroughLandings) {
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene scene = sequence_scene(friction, 3);
    std::size_t compared = 0;
    for (const Design& design : lively_designs(40, 5, friction)) {
      const Outcome outcome = solve(design, scene);
      if (outcome.jumps() < 3) continue;
      for (double Jump::*member : {&Jump::height, &Jump::time}) {
        const Design slopes = gradient(design, OutcomeNumber(member, 3), scene);
        for (double Design::*parameter :
             {&Design::slope, &Design::mass_ratio, &Design::release_spin, &Design::drive_torque}) {
          const double step = 1e-6;
          const auto beside = [&](double by) {
            Design moved = design;
            moved.*parameter += by;
            const Outcome there = model_of(friction).refined(moved, scene);
            return there.jumps() < 3 ? NAN : there.later_jumps[1].*member;
          };
          const double near = (beside(step) - beside(-step)) / (2.0 * step),
                       far = (beside(2.0 * step) - beside(-2.0 * step)) / (4.0 * step);
          const double size = 1.0 + std::abs(near);
          // A cliff on the way, or digits of doubles in the differences.
          if (!(std::abs(near - far) < 1e-4 * size)) continue;
          EXPECT_NEAR(slopes.*parameter, (4.0 * near - far) / 3.0, 2e-6 * size)
              << "slope " << design.slope << " mass_ratio " << design.mass_ratio;
          ++compared;
        }
      }
    }
    EXPECT_GE(compared, friction == Friction::sticking ? 100u : 60u);
  }
}

TEST(Sequences, AreThoseOfIntegrationAsFarAsTheirConditionAllows) {
  // The condition: what the last jump changes by where inputs change by as much as the integration is off. A
  // hundred here; LEAPMAP_SEQUENCES=1000 for more.
  const char* wanted = std::getenv("LEAPMAP_SEQUENCES");
  const std::size_t count = wanted ? std::strtoul(wanted, nullptr, 10) : 100;
  constexpr double off = 1e-11;
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene scene = sequence_scene(friction, 5);
    const auto designs = lively_designs(count, 21, friction);
    const auto exact = solve(designs, scene, {.tolerance = 1e-12});
    const auto stepped = solve(designs, scene, {.method = "gsl-rk8pd", .tolerance = 1e-13});
    std::size_t compared = 0, undecided = 0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const std::size_t jumps = std::min(exact[i].jumps(), stepped[i].jumps());
      bool same = exact[i].jumps() == stepped[i].jumps();
      for (std::size_t jump = 2; jump <= jumps; ++jump) {
        const Design by = gradient(designs[i], OutcomeNumber(&Jump::height, jump), scene);
        double condition = 1.0;
        for (double Design::*parameter :
             {&Design::slope, &Design::mass_ratio, &Design::offset_ratio, &Design::release_angle})
          condition += std::abs(by.*parameter * designs[i].*parameter);
        if (!(condition < 1e5)) {  // on a fold, or beyond what doubles know
          same = false;
          break;
        }
        EXPECT_NEAR(exact[i].later_jumps[jump - 2].height, stepped[i].later_jumps[jump - 2].height,
                    off * condition)
            << "jump " << jump << " of design " << i;
        ++compared;
      }
      undecided += !same;
    }
    EXPECT_GE(compared, count);
    EXPECT_LE(undecided, count / 20);
  }
}

TEST(Sequences, OutcomesOfAnEarlierCallLeaveNothingBehind) {
  Outcome stale;
  stale.status = Status::jumped, stale.candidates = 7, stale.gait_period = 7;
  for (const Field& field : map_fields())
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) stale.*quantity->member = 7.0;
  stale.later_jumps.resize(5);
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    const Scene scene = sequence_scene(friction, 4);
    const std::vector<Design> designs = lively_designs(60, 3, friction);
    std::vector<Outcome> fresh(designs.size()), used(designs.size(), stale);
    solve_into(fresh, designs, scene);
    solve_into(used, designs, scene);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      EXPECT_TRUE(same_flags(used[i], fresh[i])) << i;
      EXPECT_EQ(used[i].sequence_end, fresh[i].sequence_end) << i;
      EXPECT_EQ(used[i].gait_period, fresh[i].gait_period) << i;
      for (const Field& field : map_fields())
        if (const auto* quantity = std::get_if<Quantity>(&field.source)) {
          const double a = used[i].*quantity->member, b = fresh[i].*quantity->member;
          EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << i << " " << field.name;
        }
      EXPECT_EQ(used[i].later_jumps.size(), fresh[i].later_jumps.size()) << i;
    }
  }
}

TEST(Sequences, DoNotDependOnWhatIsStored) {
  Spec spec;
  spec.scene = sequence_scene(Friction::sticking, 4);
  Outcome all, heights, times;
  make_solver(request_of(spec))({&spec.design, 1}, {&all, 1});
  spec.output.fields = {"jump_height_4"};
  make_solver(request_of(spec))({&spec.design, 1}, {&heights, 1});
  spec.output.fields = {"jump_time_4"};
  make_solver(request_of(spec))({&spec.design, 1}, {&times, 1});
  ASSERT_EQ(all.jumps(), 4u);
  ASSERT_EQ(heights.jumps(), 4u);
  EXPECT_EQ(heights.later_jumps[2].height, all.later_jumps[2].height);
  EXPECT_EQ(times.later_jumps[2].time, all.later_jumps[2].time);
}

TEST(Sequences, EndWhereAJumpHasNoFlight) {
  // With hop_height = 0 a lift-off that sinks at once is a jump; the hoop is then where it was, and would
  // make it again and again.
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    Scene scene = sequence_scene(friction, 5);
    scene.hop_height = 0.0, scene.runway = 1000.0;
    std::size_t ended = 0;
    for (const Design& design : lively_designs(60, 9, friction)) {
      for (const char* method : {"exact", "gsl-rk8pd"}) {
        const Outcome outcome = solve(design, scene, {.method = method, .tolerance = 1e-12});
        double last = outcome.jump_time;
        for (const Jump& jump : outcome.later_jumps) {
          EXPECT_GT(jump.flight_time, 0.0);
          EXPECT_TRUE(jump.time > last || jump.height > 0.0);
          last = jump.time;
        }
        ended += outcome.sequence_end == Status::indeterminate;
      }
    }
    EXPECT_GE(ended, friction == Friction::sticking ? 2u : 0u);
  }
}

TEST(Sequences, AreToldByTraces) {
  for (const Friction friction : {Friction::sticking, Friction::coulomb}) {
    Scene scene;
    scene.friction = friction, scene.jumps = 3, scene.runway = 20.0;
    const Motion motion = trace(Design{}, scene, {.interval = 1e-3});
    const Outcome& outcome = motion.outcome;
    ASSERT_EQ(outcome.jumps(), 3u);
    EXPECT_EQ(outcome.sequence_end, Status::jumped);
    std::vector<Candidate> jumps;
    std::ranges::copy_if(motion.candidates, std::back_inserter(jumps), &Candidate::is_jump);
    ASSERT_EQ(jumps.size(), 3u);
    EXPECT_EQ(jumps[0].t, outcome.jump_time);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(jumps[k + 1].t, outcome.later_jumps[k].time, 1e-9);
    EXPECT_NEAR(motion.end, jumps[2].t + jumps[2].flight_time, 1e-9);
    // The highest sample of the third flight is the jump's height.
    double highest = 0.0, latest = 0.0;
    for (const MotionPoint& point : motion.points) {
      EXPECT_GE(point.t, latest);
      latest = point.t;
      if (point.t >= jumps[2].t) highest = std::max(highest, point.y / (2.0 * scene.radius));
    }
    EXPECT_NEAR(highest, jumps[2].height, 2e-5);  // a sample each millisecond
    EXPECT_LE(highest, jumps[2].height + 1e-12);
  }
}

TEST(Sequences, AreRefusedBeyondWhatIsStored) {
  Scene scene;
  scene.jumps = most_jumps + 1;
  EXPECT_THROW(solve(Design{}, scene), InputError);
  scene.jumps = 0;
  EXPECT_THROW(solve(Design{}, scene), InputError);
  scene.jumps = 2;
  EXPECT_THROW(gradient(Design{}, OutcomeNumber(&Jump::height, 3), scene), InputError);
}

}  // namespace
}  // namespace leapmap
