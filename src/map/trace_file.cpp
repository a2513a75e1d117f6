// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/trace_file.hpp"

#include <array>
#include <cmath>
#include <numeric>

#include "map/schema.hpp"
#include "map/table_file.hpp"

namespace leapmap {
namespace {

/// One member of each row.
template <class Row>
std::vector<double> column(const std::vector<Row>& rows, double Row::*member) {
  std::vector<double> values;
  for (const Row& row : rows) values.push_back(row.*member);
  return values;
}

/// The motion, along its time.
Table motion_table(const Motion& motion) {
  const auto points = [&](double MotionPoint::*member) { return column(motion.points, member); };
  hdf5::Codes phases{{}, {1, 2, 3}, "rolling sliding flight"};
  for (const MotionPoint& point : motion.points)
    phases.values.push_back(static_cast<std::uint8_t>(point.phase));
  Table table{
      {"t", "s", "time since release", points(&MotionPoint::t)},
      {"phi", "rad", "angle; 0: mass on the plane", points(&MotionPoint::phi)},
      {"spin", "rad s-1", "spin, positive downhill", points(&MotionPoint::spin)},
      {"x", "m", "travel of the hoop's centre along the plane", points(&MotionPoint::x)},
      {"y", "m", "height of the hoop's lowest point above the plane", points(&MotionPoint::y)},
      {"normal_force", "1", "normal force over the weight", points(&MotionPoint::normal_force)},
      {"friction", "1", "friction force over the weight, positive downhill", points(&MotionPoint::friction)},
      {"phase", "1", "phase of the motion", phases}};
  if (motion.points.empty() || std::isnan(motion.points.front().pendulum_angle)) return table;
  table.push_back({"pendulum_angle", "rad", "angle of the pendulum; 0: it points at the plane",
                   points(&MotionPoint::pendulum_angle)});
  table.push_back({"pendulum_spin", "rad s-1", "spin of the pendulum", points(&MotionPoint::pendulum_spin)});
  table.push_back({"motor_torque", "1", "torque of the motor on the pendulum, in (m + m_p) g R",
                   points(&MotionPoint::motor_torque)});
  return table;
}

/// Its lift-offs, by their number.
Table candidate_table(const Motion& motion) {
  const auto candidates = [&](double Candidate::*member) { return column(motion.candidates, member); };
  std::vector<double> numbers(motion.candidates.size());
  std::iota(numbers.begin(), numbers.end(), 1.0);
  std::vector<double> jumps;
  for (const Candidate& candidate : motion.candidates) jumps.push_back(candidate.is_jump ? 1.0 : 0.0);
  return {{"candidate", "1", "lift-offs in order, from 1", numbers},
          {"candidate_time", "s", "time since release of the lift-off", candidates(&Candidate::t)},
          {"candidate_angle", "rad", "angle at the lift-off", candidates(&Candidate::phi)},
          {"candidate_spin", "rad s-1", "spin at the lift-off", candidates(&Candidate::spin)},
          {"candidate_height", "1", "apex of its flight, in hoop diameters", candidates(&Candidate::height)},
          {"candidate_is_jump", "1", "1: one of the jumps; 0: it stays below hop_height", jumps}};
}

}  // namespace

bool write_trace(const std::string& path, const Motion& motion, std::span<const hdf5::Attribute> attributes,
                 Locking locking) {
  const std::array tables{motion_table(motion), candidate_table(motion)};
  return write_tables(path, std::string(trace_filetype), tables, attributes, locking);
}

}  // namespace leapmap
