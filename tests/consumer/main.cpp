// SPDX-License-Identifier: GPL-3.0-or-later
/// Another program on leapmap's public interface: one design, many, a motion, a sweep with resume, a map.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <leapmap/leapmap.hpp>
#include <string>
#include <vector>

namespace lm = leapmap;

namespace {

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("not so: %s\n", what);
  std::exit(1);
}

/// The text of the InputError that a call ends in.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const lm::InputError& error) {
    return error.what();
  }
  return "";
}
bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

void solves_one() {
  const lm::Design hoop{.slope = lm::degrees(30), .mass_ratio = 3, .mu_static = 0.4};
  const lm::Outcome outcome = lm::solve(hoop, {.friction = lm::Friction::coulomb});
  expect(outcome.status == lm::Status::jumped, "the hoop jumps");
  const lm::Outcome paper = lm::solve(lm::Design{});
  expect(std::abs(paper.jump_height - 0.98280096607011718) < 1e-12, "the paper's hoop jumps 0.98 diameters");
  expect(std::abs(paper.jump_time - 0.540713) < 1e-6, "times are in seconds");
}

void solves_a_million() {
  std::vector<lm::Design> designs(1'000'000);
  for (std::size_t i = 0; i < designs.size(); ++i) designs[i].slope = 0.1 + 6e-7 * static_cast<double>(i);
  const lm::Scene scene;
  const std::vector<lm::Outcome> all = lm::solve(designs, scene, {.threads = 0});
  expect(all.size() == designs.size(), "an outcome for each design");
  const std::vector<lm::Outcome> one = lm::solve(std::span(designs).first(5'000), scene, {.threads = 1});
  for (std::size_t i = 0; i < one.size(); ++i)
    expect(one[i].status == all[i].status &&
               (one[i].jump_height == all[i].jump_height || std::isnan(one[i].jump_height)),
           "the same bits on one thread");
}

void traces() {
  const lm::Motion motion = lm::trace({}, {}, {.interval = 1e-3});
  expect(motion.points.size() > 700, "a point every millisecond");
  expect(std::abs(motion.points.back().t - 0.740859) < 1e-6, "to the landing");
  expect(motion.phases.size() == 2 && motion.candidates.size() == 2, "it rolls, hops too low, and jumps");
}

void sweeps() {
  lm::Spec spec = lm::read_spec("");
  for (int i = 0; i < 3'000; ++i) spec.axes.resize(1), spec.axes[0].values.push_back(0.1 + 0.0002 * i);
  spec.axes[0].key = "slope";
  spec.axes.push_back({"mass_ratio", {1, 2, 3, 4, 5, 6, 7, 8}});
  spec.numerics.audit = 0.01;
  std::atomic<bool> stop = false;
  const auto on_progress = [&](std::size_t done, std::size_t total) { stop = stop || done > total / 4; };
  lm::Report report =
      lm::sweep(spec, "map.h5", {.progress = on_progress, .stop_requested = [&] { return stop.load(); }});
  expect(!report.whole && report.done > 0 && report.done < 24'000, "it stops where it is asked to");
  report = lm::sweep(spec, "map.h5", {.resume = true});
  expect(report.whole && report.done == 24'000 && report.solved < 24'000, "and goes on from there");
  expect(report.audit && !lm::disagree(*report.audit) && report.audit->designs == 240, "audited");

  const lm::Map map("map.h5");
  expect(map.shape() == std::vector<std::size_t>({3'000, 8}) && map.axes()[1].key == "mass_ratio",
         "its axes");
  lm::Design design;
  design.slope = spec.axes[0].values[123], design.mass_ratio = 5;
  expect(map.read("jump_height")[123 * 8 + 4] == lm::solve(design).jump_height,
         "the map holds what solve says");
  expect(lm::resolved_text(map.spec()) == map.attribute("spec"), "and its spec");
  const lm::Spec again = map.spec();
  expect(lm::solve(again.design, again.scene).status == lm::Status::jumped, "whose design can be solved");
  expect(lm::sweep(again, "map.h5", {.resume = true}).was_whole, "and which is that map's");
}

/// A stop that is asked for once is one, also if the question is answered otherwise afterwards.
void stops_for_good() {
  lm::Spec spec;  // not read from anywhere
  spec.axes = {{"slope", {}}, {"mass_ratio", {1, 2, 3}}};
  for (int i = 0; i < 2000; ++i) spec.axes[0].values.push_back(0.1 + 3e-4 * i);
  std::atomic<int> asked = 0;
  lm::Report report =
      lm::sweep(spec, "stopped.h5", {.threads = 1, .stop_requested = [&] { return ++asked == 3; }});
  expect(!report.whole && !std::filesystem::exists("stopped.h5"), "a stop stays one");
  report = lm::sweep(spec, "stopped.h5", {.resume = true});
  expect(report.whole && report.done == 6000, "a spec filled in by hand goes on as well");
}

/// What a newcomer gets wrong is told, with what to do about it.
void refuses() {
  const std::string no_angle = refusal([] { lm::solve({.slope = NAN}); });
  expect(has(no_angle, "slope = nan") && has(no_angle, "(-90 deg, 90 deg)"), "NaN is no slope");
  const std::string too_long = refusal([] { lm::solve({.offset_ratio = 2}); });
  expect(has(too_long, "offset_ratio = 2") && has(too_long, "[0, 1]"), "a mass outside the hoop");
  const std::string unused = refusal([] { lm::solve({.mu_static = 0.3}); });
  expect(has(unused, "mu_static = 0.3") && has(unused, "--friction coulomb"), "friction where nothing slips");
  expect(has(refusal([] { lm::solve(lm::Design{}, {.runway = -1}); }), "runway = -1"),
         "a runway that is none");
  expect(has(refusal([] { lm::solve(lm::Design{}, {}, {.method = "rk45"}); }), "gsl-rkf45"),
         "an unknown method");
  const std::vector<lm::Design> some{{}, {.mass_ratio = -1}};
  expect(has(refusal([&] { lm::solve(some); }), "design 1: mass_ratio = -1"), "which of many");
  lm::Spec spec;
  spec.axes = {{"mu_static", {0.1, 0.2}}};
  expect(has(refusal([&] { lm::sweep(spec, "none.h5"); }), "mu_static"), "an axis that has no effect");
  spec.scene.friction = lm::Friction::coulomb;
  expect(has(lm::resolved_text(spec), "friction = 'coulomb'"), "one truth for friction");
  spec = {};
  spec.design.offset_ratio = 2;
  spec.axes = {{"slope", {0.1, 0.2}}};
  expect(has(refusal([&] { lm::sweep(spec, "none.h5"); }), "offset_ratio = 2"), "what all designs share");
  spec = lm::parse_spec("[design]\npoints = 'designs.csv'\n");
  expect(has(refusal([&] { lm::sweep(spec, "none.h5"); }), "not read"), "a list that was not read");
  expect(has(refusal([] { lm::retry_failed("map.h5", {.how = lm::Numerics{.method = "rk45"}}); }), "rk45"),
         "an unknown method to retry by");
  std::vector<lm::Outcome> few(1);
  expect(has(refusal([&] { lm::solve_into(few, std::vector<lm::Design>(2)); }), "equal numbers"),
         "too few outcomes");
  expect(!std::filesystem::exists("none.h5") && !std::filesystem::exists("none.h5.part"),
         "and nothing written");
}

}  // namespace

int main() {
  solves_one();
  solves_a_million();
  traces();
  sweeps();
  stops_for_good();
  refuses();
  std::puts("all as it should be");
}
