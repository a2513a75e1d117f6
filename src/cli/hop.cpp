// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop: one design, told in full.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/provenance.hpp"
#include "cli/sweep.hpp"
#include "map/schema.hpp"
#include "map/trace_file.hpp"
#include "support/errors.hpp"
#include "sweep/audit.hpp"
#include "sweep/options.hpp"

namespace leapmap::cli {
namespace {

struct HopArguments {
  std::string spec, trace;
  double trace_interval = 1e-3;
  std::vector<std::string> overrides;
  std::vector<std::pair<const Option*, std::string>> parameters;
  bool json = false;
  Locking locking = Locking::required;
};

constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

std::string verdict(const Story& story, const Scene& scene) {
  switch (story.outcome.status) {
    case Status::jumped:
      return story.outcome.spurious_first_jump == 1
                 ? fmt::format("It jumps, after a spurious first lift-off below {} diameters.",
                               scene.hop_height)
                 : "It jumps at its first lift-off.";
    case Status::no_jump:
      return fmt::format("No jump within {} revolutions.", scene.runway);
    case Status::stalled:
      return scene.friction == Friction::coulomb
                 ? "It stalls: it rolls with its spin fallen to zero or below, or is released turning uphill."
                 : "It stalls: the spin falls to zero, or the hoop does not start downhill.";
    case Status::airborne_at_release:
      return "The plane would have to pull at release: it is airborne from the start.";
    case Status::indeterminate:
      return "Sliding comes to where the rigid-body equations have no answer or two (Painleve).";
    default:
      return fmt::format(
          "The method gave up: {}. Try another tolerance, more max_steps, a shorter fixed_step or another "
          "method.",
          story.outcome.failure ? story.outcome.failure : "for no reason it knows of");
  }
}

/// How well the method that audits this one agrees.
std::string check_line(const Spec& spec, const Story& story, const Outcome& b) {
  const Outcome& a = story.outcome;
  const std::string by = audit_method(spec.numerics) + " at 1e-12";
  if (b.status == Status::failed) return fmt::format("Check: {} gave up on this design.", by);
  if (!same_flags(a, b))
    return fmt::format("Check: {} DISAGREES: {}, {} lift-offs.", by, name_of(b.status), b.candidates);
  if (a.status != Status::jumped) return fmt::format("Check: {} agrees.", by);
  AuditReport report;
  Auditor(spec, 1).look_at({0, a}, report);
  const bool disagrees = report.first_mismatch || report.first_inaccurate;
  return fmt::format("Check: {} {} {:.1e} diameters, time {} {:.1e}.{}", by,
                     disagrees ? "DISAGREES: height off by" : "agrees, height within",
                     std::abs(a.jump_height - b.jump_height), disagrees ? "by" : "within",
                     std::abs(a.jump_time / b.jump_time - 1.0),
                     report.first_overruled     ? " The paper's (7) to (9) DISAGREE."
                     : report.referee_undecided ? ""
                                                : fmt::format(" The paper's (7) to (9): all within {:.1e}.",
                                                              report.referee_max_error));
}

void print_jump(const Spec& spec, const Story& story, const Outcome& checked) {
  const Outcome& jump = story.outcome;
  const double second = time_unit(spec.scene);
  if (jump.status == Status::jumped) {
    say("Height {:.6f} diameters ({:.4g} m), apex {:.6f} s and landing {:.6f} s after lift-off",
        jump.jump_height, 2.0 * spec.scene.radius * jump.jump_height, jump.apex_time * second,
        jump.flight_time * second);
    if (spec.scene.friction == Friction::sticking) {
      say("; the flight first dips {:.4g} diameters.\n", jump.dip);
    } else {
      say(".\nSlid {:.6g} R, lost {:.6g} (m + m_p) g R until lift-off, spin after the landing {:.6g} "
          "rad/s.\n",
          jump.slip_distance, jump.energy_lost, jump.landing_spin / second);
    }
  }
  say("{}\n", check_line(spec, story, checked));
}

/// Every phase with Coulomb friction, flights with how they go.
void print_phases(const Story& story, double second) {
  std::size_t flights = 0;
  for (const auto& [phase, at, direction] : story.phases) {
    const std::string begins =
        fmt::format("{:>12.6f} {:>12.4f} {:>14.6f}", at.time * second, degrees(at.angle), at.spin / second);
    if (phase == Phase::rolling) {
      say("{:<22} {}\n", "R  rolls", begins);
    } else if (phase == Phase::sliding) {
      say("{:<22} {}\n", direction > 0 ? "S  slides forwards" : "S  slides backwards", begins);
    } else {
      const Flight<double>& flown = story.candidates[flights++].flight;
      const bool jumps = story.outcome.status == Status::jumped && flights == story.candidates.size();
      say("{:<22} {} {:>12.6f} {:>12.6f}\n", jumps ? "F  jumps" : "F  hops, too low", begins, flown.height,
          (at.time + flown.flight_time) * second);
    }
  }
}

void print_table(const Spec& spec, const Story& story, const Outcome& checked) {
  const double second = time_unit(spec.scene);
  for (const Option* parameter : design_parameters(spec)) {
    const double value = value_of(*parameter, spec.design);
    say("{:<15} {:<12.8g} {}\n", parameter->key, value,
        parameter->unit == "rad" ? fmt::format("rad = {:.6g} deg", degrees(value))
        : parameter->unit == "1" ? ""
                                 : parameter->unit);
  }
  say("{:<15} {:<12.8g} m, gravity {:g} m/s^2, sqrt(R/g) = {:.6g} s\n", "radius", spec.scene.radius,
      spec.scene.gravity, second);
  say("{:<15} {}, tolerance {:g}\n\n", "method", resolved_method(spec.numerics), spec.numerics.tolerance);

  say("{:<22} {:>12} {:>12} {:>14} {:>12} {:>12}\n", "phase", "time [s]", "angle [deg]", "spin [rad/s]",
      "height [2R]", "landing [s]");
  if (spec.scene.friction == Friction::coulomb) {
    print_phases(story, second);
    say("\n{}  {}\n", phase_letters(story.outcome.phase_sequence), verdict(story, spec.scene));
    print_jump(spec, story, checked);
    return;
  }
  say("{:<22} {:>12.6f} {:>12.4f} {:>14.6f}\n", "R  rolls from release", 0.0,
      degrees(spec.design.release_angle), spec.design.release_spin / second);
  const auto& candidates = story.candidates;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool jump = story.outcome.status == Status::jumped && i + 1 == candidates.size();
    const auto& [lift_off, flight] = candidates[i];
    say("{:<22} {:>12.6f} {:>12.4f} {:>14.6f} {:>12.6f} {:>12.6f}\n",
        jump ? "F  jumps" : fmt::format("   lift-off {}, too low", i + 1), lift_off.time * second,
        degrees(lift_off.angle), lift_off.spin / second, flight.height,
        (lift_off.time + flight.flight_time) * second);
    if (flight.height == 0.0)
      say("{:<22} it sinks at once: no-slip rolling asks the plane to pull here\n", "");
  }
  say("\n{}\n", verdict(story, spec.scene));
  print_jump(spec, story, checked);
  for (const Graze& graze : story.grazes)
    say("Graze: at {:.6f} s the normal force has a {} of {:.3g} weights, counted as {}lift-off.\n",
        graze.time * second, graze.minimum ? "minimum" : "maximum", graze.normal_force,
        graze.makes_lift_off() ? "making a " : "making no ");
}

std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

/// The outcome under the map's names and units, so that a script finds the same words in both.
std::string json_text(const Spec& spec, const Story& story, const Outcome& checked) {
  const double second = time_unit(spec.scene);
  const bool slips = spec.scene.friction == Friction::coulomb;
  std::vector<std::string> design, outcome, candidates, grazes, phases;
  for (const Option* parameter : design_parameters(spec))
    design.push_back(
        fmt::format("\"{}\": {}", parameter->key, json_number(value_of(*parameter, spec.design))));
  for (const Field& field : map_fields()) {
    if (field.of_coulomb && !slips) continue;
    std::string value;
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) {
      value = json_number(story.outcome.*quantity->member * (quantity->unit(second)));
    } else if (std::holds_alternative<Word>(field.source)) {
      value = fmt::format("\"{}\"", phase_letters(story.outcome.phase_sequence));
    } else if (field.name == "status") {
      value = fmt::format("\"{}\"", name_of(story.outcome.status));
    } else {
      const auto& code = std::get<Code>(field.source);
      value = code.value(story.outcome) == code.fill ? "null" : fmt::format("{}", code.value(story.outcome));
    }
    outcome.push_back(fmt::format("\"{}\": {}", field.name, value));
  }
  for (const auto& [lift_off, flight] : story.candidates)
    candidates.push_back(fmt::format(
        R"({{"time": {}, "angle": {}, "spin": {}, "height": {}, "apex_time": {}, "flight_time": {}, "dip": {}}})",
        json_number(lift_off.time * second), json_number(lift_off.angle), json_number(lift_off.spin),
        json_number(flight.height), json_number(flight.apex_time * second),
        json_number(flight.flight_time * second), json_number(flight.dip)));
  for (const Graze& graze : story.grazes)
    grazes.push_back(fmt::format(
        R"({{"time": {}, "angle": {}, "normal_force": {}, "extremum": "{}", "makes_lift_off": {}}})",
        json_number(graze.time * second), json_number(graze.angle), json_number(graze.normal_force),
        graze.minimum ? "minimum" : "maximum", graze.makes_lift_off()));
  for (const auto& [phase, at, direction] : story.phases)
    phases.push_back(fmt::format(
        R"({{"phase": "{}", "direction": {}, "time": {}, "angle": {}, "spin": {}, "x": {}}})",
        phase_letters(static_cast<std::uint64_t>(phase)), direction, json_number(at.time * second),
        json_number(at.angle), json_number(at.spin), json_number(at.travel)));
  const std::string slipping =
      slips ? fmt::format(",\n  \"phases\": [{}]", fmt::join(phases, ", ")) : std::string();
  const std::string check = fmt::format(
      R"({{"method": "{}", "tolerance": 1e-12, "status": "{}", "candidates": {}, "jump_height": {}, "jump_time": {}}})",
      audit_method(spec.numerics), name_of(checked.status), checked.candidates,
      json_number(checked.jump_height), json_number(checked.jump_time * second));
  return fmt::format(
      "{{\n  \"design\": {{{}}},\n  \"scene\": {{\"friction\": \"{}\", \"runway\": {}, \"hop_height\": {}, "
      "\"radius\": {}, "
      "\"gravity\": {}, \"rest_speed\": {}}},\n  \"method\": \"{}\",\n  \"tolerance\": {},\n  {},\n  "
      "\"lift_offs\": [{}],\n  "
      "\"grazes\": [{}],\n  \"check\": {}{}\n}}\n",
      fmt::join(design, ", "), spec.friction, spec.scene.runway, spec.scene.hop_height, spec.scene.radius,
      spec.scene.gravity, spec.scene.rest_speed, resolved_method(spec.numerics), spec.numerics.tolerance,
      fmt::join(outcome, ",\n  "), fmt::join(candidates, ", "), fmt::join(grazes, ", "), check, slipping);
}

int run(const HopArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  for (const auto& [option, value] : arguments.parameters)
    overrides.push_back(fmt::format("{}.{}={}", option->section, option->key, value));
  const Spec spec = read_spec(arguments.spec, overrides);
  if (!spec.axes.empty())
    throw InputError(
        fmt::format("{}: design.{} is an axis; allowed: one number for a hop, for example --set {}={}",
                    origin_of(spec), spec.axes[0].key, spec.axes[0].key, spec.axes[0].values[0]));
  if (!spec.points.empty())
    throw InputError(
        fmt::format("{}: design.points is a list; allowed: one design for a hop", origin_of(spec)));

  const double interval = arguments.trace.empty() ? 0.0 : arguments.trace_interval / time_unit(spec.scene);
  if (!arguments.trace.empty() && !(interval > 0.0))
    throw InputError("--trace-interval: is not a number of seconds; allowed: a number above 0");
  const bool exact = resolved_method(spec.numerics) == "exact";
  Story story =
      exact ? tell_exactly(spec.design, spec.scene, spec.numerics.tolerance, interval)
            : tell_by_integration(spec.design, spec.scene, integration_options(spec.numerics), interval);
  const Story check =
      exact ? tell_by_integration(spec.design, spec.scene, adaptive("gsl-rk8pd", check_tolerance))
            : tell_exactly(spec.design, spec.scene, check_tolerance);
  if (exact) story.grazes = check.grazes;
  if (!arguments.trace.empty()) {
    std::vector<hdf5::Attribute> attributes = provenance(spec, trace_filetype, "Motion of one passive hoop");
    attributes.emplace_back("status", std::string(name_of(story.outcome.status)));
    if (!write_trace(behind_links(arguments.trace), story, spec.scene, attributes, arguments.locking))
      tell_of_folder(arguments.trace);
  }
  if (arguments.json) {
    say("{}", json_text(spec, story, check.outcome));
  } else {
    print_table(spec, story, check.outcome);
    if (!arguments.trace.empty()) say("Trace of {} points: {}\n", story.points.size(), arguments.trace);
  }
  return story.outcome.status == Status::failed ? 1 : 0;
}

}  // namespace

void add_hop(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("hop", "solve one design and tell its phases, lift-offs and jump");
  auto arguments = std::make_shared<HopArguments>();
  command->add_option("SPEC", arguments->spec, "a spec without axes; default: the paper's hoop");
  for (const Option* option : hop_options()) {
    command->add_option_function<std::string>(
        flag_of(*option),
        [arguments, option](const std::string& value) { arguments->parameters.emplace_back(option, value); },
        fmt::format("{}; {}", option->meaning, allowed_values(*option)));
  }
  command->add_option("--set", arguments->overrides, "KEY=VALUE: override a key of the spec")
      ->expected(1)
      ->take_all();
  command->add_option("--trace", arguments->trace, "write the motion over time to this HDF5 file")
      ->check(named_file());
  command
      ->add_option("--trace-interval", arguments->trace_interval,
                   "seconds between its samples; default 0.001")
      ->check(CLI::Range(1e-9, 1e9));
  command->add_flag("--json", arguments->json, "print JSON, under the map's names and units");
  command->footer(options_help());
  add_no_lock(*command, arguments->locking);
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
