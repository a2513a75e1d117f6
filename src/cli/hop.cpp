// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop: one design in full.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "audit/audit.hpp"
#include "cli/audit_lines.hpp"
#include "cli/commands.hpp"
#include "cli/hop_gradient.hpp"
#include "cli/hop_jump.hpp"
#include "cli/hop_scatter.hpp"
#include "cli/json.hpp"
#include "cli/motor.hpp"
#include "cli/output.hpp"
#include "cli/proof_lines.hpp"
#include "cli/shown_units.hpp"
#include "cli/sweep.hpp"
#include "engine/provenance.hpp"
#include "friction/contact_phases.hpp"
#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "map/table_file.hpp"
#include "map/trace_file.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

struct HopArguments {
  std::string spec, trace, units;
  double trace_interval = 1e-3;
  std::vector<std::string> overrides, flags;  // KEY=VALUE; flags hold whatever their place on the line
  bool json = false, gradient = false, scatter = false, prove = false;
  Locking locking = Locking::required;
};

constexpr double check_tolerance = 1e-12;  // of the method that checks

constexpr double in_degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

std::string verdict(const Motion& motion, const Spec& spec) {
  const Scene& scene = spec.scene;
  const bool resists = spec.design.resisting_torque > 0.0;
  constexpr double rounding = 1e-12;
  const double eccentricity =
      spec.design.mass_ratio / (1.0 + spec.design.mass_ratio) * spec.design.offset_ratio;
  switch (motion.outcome.status) {
    case Status::jumped:
      return motion.outcome.spurious_first_jump == 1
                 ? fmt::format("It jumps, after a first lift-off below the threshold of {} diameters.",
                               scene.hop_height)
                 : "It jumps at its first lift-off.";
    case Status::no_jump:
      return fmt::format("No jump within {} revolutions{}.", scene.runway,
                         eccentricity < rounding ? ": its centre of mass is on the axis"
                                                 : "; --runway says how far it may roll");
    case Status::stalled:
      if (scene.model == Mechanism::pendulum)
        return fmt::format(
            "It rests or rocks indefinitely, or neither jumps nor comes to the runway's end within "
            "patience = {} sqrt(R/g).",
            scene.patience);
      return resists ? "It is at rest: slope and motor push less than its resisting torque."
                     : "It is trapped: it rocks between two turning points indefinitely, or rests in an "
                       "equilibrium.";
    case Status::airborne_at_release:
      return "The normal force at the release is not positive: it is airborne from the start.";
    case Status::indeterminate:
      if (scene.model == Mechanism::pendulum &&
          spec.design.mass_ratio * spec.design.offset_ratio * spec.design.inertia_factor == 0.0)
        return "A pendulum without mass or length, or a hoop without inertia, has no equation of motion.";
      return "The rigid-body equations have no solution or two: Painleve's paradox while sliding, or a motor "
             "that alone would lift the hoop and idles in flight.";
    default:
      if (const std::string_view why = motion.outcome.failure ? motion.outcome.failure : "";
          why == endless_rebounds || why == reverses_against_resistance)
        return fmt::format("The method failed: {}.", why);
      return fmt::format(
          "The method failed: {}. Try another tolerance, more max_steps, a shorter fixed_step or another "
          "method.",
          motion.outcome.failure ? motion.outcome.failure : "for an unknown reason");
  }
}

/// How well the method that audits this one agrees.
std::string check_line(const Spec& spec, const Motion& motion, const Outcome& b) {
  const Outcome& a = motion.outcome;
  const std::string by = audit_method(spec.numerics, spec.scene) + " at 1e-12";
  if (b.status == Status::failed) return fmt::format("Check: {} failed on this design.", by);
  if (!same_flags(a, b))
    return fmt::format("Check: {} DISAGREES: {}, {} lift-offs.", by, name_of(b.status), b.candidates);
  if (a.status != Status::jumped) return fmt::format("Check: {} agrees.", by);
  Spec all = spec;  // hop also shows fields that maps hold only if named
  for (const Field* field : fields_of(spec.scene)) all.output.fields.emplace_back(field->name);
  AuditReport report;
  Auditor(all, 1).look_at({0, a}, report);
  const bool disagrees = report.first_mismatch || report.first_inaccurate;
  const std::string later = later_jumps_line(report, a);
  return fmt::format("Check: {} {} {:.1e} diameters, time {} {:.1e}.{}{}", by,
                     disagrees ? "DISAGREES: height off by" : "agrees, height within",
                     std::abs(a.jump_height - b.jump_height), disagrees ? "by" : "within",
                     b.jump_time == 0.0 ? std::abs(a.jump_time) : std::abs(a.jump_time / b.jump_time - 1.0),
                     report.first_overruled ? " The reference solver DISAGREES."
                     : report.referee_undecided
                         ? ""
                         : fmt::format(" Reference solver: within {:.1e}.", report.referee_max_error),
                     later.empty() ? "" : "\n" + later);
}

/// Every phase, flights with how they go; and lift-offs after which the hoop is taken to roll on.
void print_phases(const Motion& motion) {
  const auto begins = [](double t, double phi, double spin) {
    return fmt::format("{:>12.6f} {:>12.4f} {:>14.6f}", t, in_degrees(phi), spin);
  };
  std::size_t told = 0, jumps = 0;
  const auto print_flight = [&](std::string_view what) {
    const Candidate& flown = motion.candidates[told++];
    say("{:<22} {} {:>12.6f} {:>12.6f}\n", what, begins(flown.t, flown.phi, flown.spin), flown.height,
        flown.t + flown.flight_time);
    if (flown.height == 0.0) say("{:<22} it sinks at once: the normal force is negative here\n", "");
  };
  // Without slip lift-offs that stay low are no phases: they come before the flight, if there is one.
  const auto print_low_ones = [&](double before) {
    while (told < motion.candidates.size() && motion.candidates[told].t < before)
      print_flight(fmt::format("   lift-off {}, too low", told + 1));
  };
  for (const PhaseStart& phase : motion.phases) {
    if (phase.phase == Phase::flight) {
      print_low_ones(phase.t);
      if (!motion.candidates[told].is_jump)
        print_flight("F  hops, too low");
      else
        print_flight(++jumps == 1 ? "F  jumps" : fmt::format("F  jumps, {}", jumps));
    } else {
      const std::string_view how = phase.phase == Phase::rolling ? "R  rolls"
                                   : phase.direction > 0         ? "S  slides forwards"
                                                                 : "S  slides backwards";
      say("{:<22} {}\n", how, begins(phase.t, phase.phi, phase.spin));
    }
  }
  print_low_ones(HUGE_VAL);
}

void print_motor(const Motor& motor) {
  const std::string_view brakes = motor.only_brakes ? "; it only brakes" : "";
  if (motor.mass > 0.0)
    say("Motor until the lift-off, for a total mass of {:g} kg: {:.4g} N m, at most {:.4g} W and {:.4g} rpm, "
        "{:.4g} J{}.\n",
        motor.mass, motor.torque, motor.power + 0.0, motor.spin, motor.work, brakes);
  else
    say("Motor until the lift-off: at most {:.4g} rpm{}. With --mass: torque, power and energy in N m, W and "
        "J.\n",
        motor.spin, brakes);
}

void print_table(const Spec& spec, const Motion& motion, const Outcome& checked,
                 const std::optional<Motor>& motor) {
  ShownUnits units("", scales_of(spec.scene));
  const double second = time_unit(spec.scene);
  const int width = spec.scene.model == Mechanism::hoop ? 15 : 16;  // of the longest name
  for (const Option* parameter : design_parameters(spec)) {
    double value = effective_value(*parameter, spec.design);
    if (parameter->key == "resisting_torque" && value == 0.0) continue;  // few hoops have one
    const bool is_set = parameter->key == "mu_static" && spec.design.mu_kinetic > value;
    if (is_set) value = spec.design.mu_kinetic;
    const bool is_torque = parameter->key.ends_with("_torque") && value != 0.0;
    const std::string torque = is_torque ? units.beside(value, parameter->key) : "";
    say("{:<{}} {:<12.8g} {}\n", parameter->key, width, value,
        is_set                     ? std::string("set to mu_kinetic, which is larger")
        : parameter->unit == "rad" ? fmt::format("rad = {:.6g} deg", in_degrees(value))
        : parameter->unit == "1"   ? std::string()
                                   : std::string(parameter->unit) + torque);
  }
  if (spec.scene.model == Mechanism::pendulum)
    say("{:<{}} {}\n", "motor_law", width, name_of(spec.scene.motor_law));
  say("{:<{}} {:<12.8g} m, gravity {:g} m/s^2, sqrt(R/g) = {:.6g} s\n", "radius", width, spec.scene.radius,
      spec.scene.gravity, second);
  if (spec.hoop) {
    const ReducedBody body = reduce_body(*spec.hoop);
    say("{:<{}} {:<12.8g} kg in all, centre of mass at {:.6g} R, moment of inertia {:.6g} M R^2\n", "hoop",
        width, body.total_mass, body.eccentricity, body.inertia);
  }
  say("{:<{}} {}, tolerance {:g}\n\n", "method", width, resolved_method(spec), spec.numerics.tolerance);

  say("{:<22} {:>12} {:>12} {:>14} {:>12} {:>12}\n", "phase", "time [s]", "angle [deg]", "spin [rad/s]",
      "height [2R]", "landing [s]");
  print_phases(motion);
  if (motion.outcome.phase_sequence != 0) say("\n{}", phase_letters(motion.outcome.phase_sequence));
  say("\n{}\n", verdict(motion, spec));
  print_jump(spec, motion.outcome);
  if (spec.scene.settle > 0) say("{}\n", settled_line(motion.outcome, spec.scene.settle, units));
  say("{}\n", check_line(spec, motion, checked));
  if (motor) print_motor(*motor);
  for (const Graze& graze : motion.grazes)
    say("Grazing contact: at {:.6f} s the normal force has a {} of {:.3g} weights, counted as {}lift-off.\n",
        graze.t, graze.minimum ? "minimum" : "maximum", graze.normal_force,
        graze.makes_lift_off() ? "a " : "no ");
}

/// A field of the outcome; statuses and phases by their names.
Json json_of(const Field& field, const Outcome& outcome) {
  if (std::holds_alternative<Word>(field.source)) return phase_letters(outcome.phase_sequence);
  if (field.name == "status") return name_of(outcome.status);
  if (field.name == "sequence_end") return name_of(outcome.sequence_end);
  return number_json(field, outcome);
}

/// The outcome under the map's names and units, so that a script finds the same words in both.
Json json_of(const Spec& spec, const Motion& motion, const Outcome& checked) {
  const Scene& scene = spec.scene;
  const double second = time_unit(scene);
  Json json{{"design", design_json(spec, spec.design)},
            {"scene",
             {{"friction", model_of(scene).name},
              {"runway", scene.runway},
              {"hop_height", scene.hop_height},
              {"clear_height", 0.5 * wall_in_radii(scene, 1.0)},
              {"radius", scene.radius},
              {"gravity", scene.gravity},
              {"mass", scene.mass > 0.0 ? Json(scene.mass) : Json()},
              {"rest_speed", scene.rest_speed}}},
            {"method", resolved_method(spec)},
            {"tolerance", spec.numerics.tolerance}};
  for (const Field* field : fields_of(scene))
    json[std::string(field->name)] = json_of(*field, motion.outcome);
  if (scene.model != Mechanism::hoop)
    json["scene"].update({{"model", name_of(scene.model)},
                          {"motor_law", name_of(scene.motor_law)},
                          {"motor_in_flight", scene.motor_in_flight},
                          {"patience", scene.patience}});
  Json lift_offs = Json::array(), grazes = Json::array(), phases = Json::array();
  for (const Candidate& flown : motion.candidates)
    lift_offs.push_back({{"time", flown.t},
                         {"angle", flown.phi},
                         {"spin", flown.spin * second},
                         {"height", flown.height},
                         {"apex_time", flown.apex_time},
                         {"flight_time", flown.flight_time},
                         {"dip", flown.dip},
                         {"is_jump", flown.is_jump}});
  for (const Graze& graze : motion.grazes)
    grazes.push_back({{"time", graze.t},
                      {"angle", graze.phi},
                      {"normal_force", graze.normal_force},
                      {"extremum", graze.minimum ? "minimum" : "maximum"},
                      {"makes_lift_off", graze.makes_lift_off()}});
  for (const PhaseStart& at : motion.phases)
    phases.push_back({{"phase", phase_letters(static_cast<std::uint64_t>(at.phase))},
                      {"direction", at.direction},
                      {"time", at.t},
                      {"angle", at.phi},
                      {"spin", at.spin * second},
                      {"x", at.x / scene.radius}});
  json["lift_offs"] = std::move(lift_offs);
  json["grazes"] = std::move(grazes);
  json["check"] = {{"method", audit_method(spec.numerics, spec.scene)},
                   {"tolerance", check_tolerance},
                   {"status", name_of(checked.status)},
                   {"candidates", checked.candidates},
                   {"jump_height", checked.jump_height},
                   {"jump_time", checked.jump_time}};
  json["phases"] = std::move(phases);
  return json;
}

Json json_of(const Motor& motor) {
  return {{"mass", motor.mass > 0.0 ? Json(motor.mass) : Json()},
          {"torque", motor.torque},
          {"power", motor.power},
          {"rpm", motor.spin},
          {"work", motor.work}};
}

/// Every number of the jump in the units asked for.
std::string lines_in_units(const Spec& spec, const Outcome& outcome, const std::string& text) {
  ShownUnits units(text, scales_of(spec.scene));
  const std::string lines = units.lines_of(outcome, spec.scene);
  units.refuse_unused();
  return fmt::format("\n{}:\n{}", text, lines);
}

/// What the report leaves open.
void print_hints(const Spec& spec, bool made) {
  if (!model_of(spec.scene).slips)
    say("The contact never slips in this model; for a hoop that you build, add --friction coulomb.\n");
  if (made) return;
  if (!spec.scatter.spreads.empty())
    say("[scatter] is not used here; --scatter reports what it makes of the hoop.\n");
  else if (!spec.goals.empty())
    say("[goal] is not used here; allowed: with [scatter] and --scatter, or in leapmap design.\n");
}

void print_json(const Spec& spec, const Motion& motion, const Outcome& checked,
                const std::optional<Motor>& motor, bool gradient, const std::optional<ScatterReport>& made,
                const std::optional<Proof>& proof) {
  Json json = json_of(spec, motion, checked);
  if (motor) json["motor"] = json_of(*motor);
  if (gradient) json["gradient"] = gradient_json(spec);
  if (made) json["scatter"] = scatter_json(spec, *made);
  if (proof) json["proof"] = proof_json(*proof);
  say_json(json);
}

void refuse_several(const Spec& spec) {
  if (!spec.axes.empty())
    throw InputError(fmt::format("{}: {}{} is an axis; allowed: one number, for example --set {}={}",
                                 origin_of(spec), find_body_number(spec.axes[0].key) ? "" : "design.",
                                 spec.axes[0].key, spec.axes[0].key, spec.axes[0].values[0]));
  if (!spec.points.empty())
    throw InputError(fmt::format("{}: design.points is a list; allowed: one design", origin_of(spec)));
}

int run(const HopArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  overrides.insert(overrides.end(), arguments.flags.begin(), arguments.flags.end());
  const Spec spec = read_given_spec(arguments.spec, overrides, refuse_several);
  const std::array inputs{NamedPath{"SPEC", arguments.spec}};
  const std::array outputs{NamedPath{"--trace", arguments.trace, true}};
  refuse_same_files(inputs, outputs);
  if (!arguments.trace.empty()) refuse_taken(arguments.trace, trace_filetype, arguments.locking);
  if (!arguments.scatter) refuse_scatter(arguments.overrides, "allowed: with --scatter");
  std::optional<ScatterReport> made;
  if (arguments.scatter) made = scatter(spec);
  std::optional<Proof> proof;
  if (arguments.prove) proof = prove(spec.design, spec.scene);
  const double interval = arguments.trace.empty() ? 0.0 : arguments.trace_interval;
  if (!arguments.trace.empty() && !(interval > 0.0))
    throw InputError("--trace-interval: is not a number of seconds; allowed: a number above 0");
  Motion motion = tell(spec.design, request_of_everything(spec), interval);
  const Request second{
      .scene = spec.scene,  // phases and lift-offs alone
      .numerics = {.method = audit_method(spec.numerics, spec.scene), .tolerance = check_tolerance}};
  const Motion check = tell(spec.design, second, 0.0);
  if (resolved_method(spec) == "exact") motion.grazes = check.grazes;
  if (!arguments.trace.empty()) {
    std::vector<hdf5::Attribute> attributes =
        provenance(spec, trace_filetype,
                   spec.scene.model == Mechanism::hoop ? "Motion of one passive hoop"
                                                       : "Motion of one hoop with a driven pendulum");
    attributes.emplace_back("status", std::string(name_of(motion.outcome.status)));
    if (!write_trace(behind_links(arguments.trace), motion, attributes, arguments.locking))
      tell_of_folder(arguments.trace);
  }
  const bool moves = !motion.phases.empty() && motion.outcome.status != Status::failed;
  std::optional<Motor> motor;
  if (spec.design.drive_torque != 0.0 && moves) motor = motor_of(spec, motion);
  const std::string in_units =
      arguments.units.empty() ? "" : lines_in_units(spec, motion.outcome, arguments.units);
  if (arguments.json) {
    print_json(spec, motion, check.outcome, motor, arguments.gradient, made, proof);
  } else {
    print_table(spec, motion, check.outcome, motor);
    if (!arguments.units.empty()) say("{}", in_units);
    if (arguments.gradient) print_gradient(spec);
    if (made) print_scatter(spec, *made, arguments.units);
    if (proof) say("\n{}", proof_lines(*proof, spec));
    if (!arguments.trace.empty()) say("Trace of {} points: {}\n", motion.points.size(), arguments.trace);
    print_hints(spec, made.has_value());
  }
  return motion.outcome.status == Status::failed ? 1 : 0;
}

}  // namespace

void add_hop(CommandLine& line, int& status) {
  Command command = line.command("hop", "solve one design and report its phases, lift-offs and jump");
  command.examples(
      {{"leapmap hop", "the paper's hoop"},
       {"leapmap hop --slope 30deg --friction coulomb --mu-static 0.4", "another slope, with friction"},
       {"leapmap hop --trace hop.h5", "its motion over time; python3 -m leapmap.charts trace hop.h5"},
       {"leapmap hop --gradient --json", "derivatives too, for a program"}});
  auto arguments = std::make_shared<HopArguments>();
  command.value("SPEC", arguments->spec, "a spec without axes (TOML); default: the paper's hoop")
      .check(named_file());
  add_flags_of_a_hoop(command, arguments->flags);
  command.group("Report");
  command.flag("--gradient", arguments->gradient, "report the derivatives of every quantity");
  command.flag(
      "--scatter", arguments->scatter,
      "report yield, quantiles and the influence of each tolerance, by the spec's [scatter] and [goal]");
  command.flag("--prove", arguments->prove, "enclose height and time of the jump by proof (leapmap prove)");
  command.flag("--json", arguments->json, "print JSON, with the names and units of a map");
  command
      .value("--units", arguments->units,
             "report every quantity of the jump in these units, for example \"mm ms rpm J\"")
      .excludes("--json");
  command.value("--trace", arguments->trace, "write the motion over time to this HDF5 file")
      .check(named_file());
  command.value("--trace-interval", arguments->trace_interval, "time between its samples [s]; default: 0.001")
      .needs("--trace")
      .check(number({1e-9, 1e9}));
  command.group("Options");
  add_set(command, arguments->overrides,
          ", for example tolerance=1e-12 or 'scatter.slope={normal=\"1 deg\"}'");
  add_no_lock(command, arguments->locking);
  command.footer("All keys of a spec: leapmap sweep --help.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
