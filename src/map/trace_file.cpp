// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/trace_file.hpp"

#include <array>

#include "map/schema.hpp"
#include "map/table_file.hpp"

namespace leapmap {
namespace {

/// The motion, along its time.
Table motion_table(const Story& story, const Scene& scene) {
  const double second = time_unit(scene), metre = scene.radius;
  const auto points = [&](double TracePoint::*member, double unit) {
    std::vector<double> values;
    for (const TracePoint& point : story.points) values.push_back(point.*member * unit);
    return values;
  };
  hdf5::Codes phases{{}, {1, 2, 3}, "rolling sliding flight"};
  for (const TracePoint& point : story.points)
    phases.values.push_back(static_cast<std::uint8_t>(point.phase));
  return {{"t", "s", "time since release", points(&TracePoint::t, second)},
          {"phi", "rad", "angle; 0: mass on the plane", points(&TracePoint::phi, 1.0)},
          {"spin", "rad s-1", "spin, positive downhill", points(&TracePoint::spin, 1.0 / second)},
          {"x", "m", "travel of the hoop's centre along the plane", points(&TracePoint::x, metre)},
          {"y", "m", "height of the hoop's lowest point above the plane", points(&TracePoint::y, metre)},
          {"normal_force", "1", "normal force over the weight (11)", points(&TracePoint::normal_force, 1.0)},
          {"friction", "1", "friction force over the weight, positive downhill (12)",
           points(&TracePoint::friction, 1.0)},
          {"phase", "1", "phase of the motion", phases}};
}

/// Its lift-offs, by their number.
Table candidate_table(const Story& story, const Scene& scene) {
  const double second = time_unit(scene);
  std::vector<double> numbers, times, angles, spins, heights;
  for (const Candidate& candidate : story.candidates) {
    numbers.push_back(static_cast<double>(numbers.size() + 1));
    times.push_back(candidate.lift_off.time * second);
    angles.push_back(candidate.lift_off.angle);
    spins.push_back(candidate.lift_off.spin / second);
    heights.push_back(candidate.flight.height);
  }
  return {{"candidate", "1", "lift-offs in order, from 1", numbers},
          {"candidate_time", "s", "time since release of the lift-off", times},
          {"candidate_angle", "rad", "angle at the lift-off", angles},
          {"candidate_spin", "rad s-1", "spin at the lift-off", spins},
          {"candidate_height", "1", "apex of its flight, in hoop diameters", heights}};
}

}  // namespace

bool write_trace(const std::string& path, const Story& story, const Scene& scene,
                 std::span<const hdf5::Attribute> attributes, Locking locking) {
  const std::array tables{motion_table(story, scene), candidate_table(story, scene)};
  return write_tables(path, std::string(trace_filetype), tables, attributes, locking);
}

}  // namespace leapmap
