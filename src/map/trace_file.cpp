// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/trace_file.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <array>
#include <filesystem>

#include "map/hdf5_driver.hpp"
#include "map/schema.hpp"
#include "support/errors.hpp"

namespace leapmap {
namespace {

using hdf5::check;
using hdf5::Handle;

void write_phases(hid_t file, const Story& story, const Handle& time) {
  std::vector<std::uint8_t> codes;
  for (const TracePoint& point : story.points) codes.push_back(static_cast<std::uint8_t>(point.phase));
  const hsize_t count = codes.size();
  const Handle dataset = hdf5::create_dataset(file, {"phase", H5T_STD_U8LE, {&count, 1}});
  check(H5Dwrite(dataset, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, codes.data()), "writing phase");
  hdf5::write_attribute(dataset, "long_name", "phase of the motion");
  hdf5::write_attribute(dataset, "units", "1");
  hdf5::write_attribute(dataset, "flag_values", std::array<std::uint8_t, 3>{1, 2, 3});
  hdf5::write_attribute(dataset, "flag_meanings", "rolling sliding flight");
  check(H5DSattach_scale(dataset, time, 0), "scaling phase");
}

}  // namespace

void write_trace(const std::string& path, const Story& story, const Scene& scene,
                 std::span<const hdf5::Attribute> attributes) {
  hdf5::refuse_other_file(path, trace_filetype);
  const double second = time_unit(scene), metre = scene.radius;
  const std::string part = path + ".part";
  hdf5::File file = hdf5::File::create(part);
  try {
    hdf5::annotate(file, attributes);
    const auto points = [&](double TracePoint::*member, double unit) {
      std::vector<double> values;
      for (const TracePoint& point : story.points) values.push_back(point.*member * unit);
      return values;
    };
    const Handle t =
        hdf5::write_series(file, "t", "s", "time since release", points(&TracePoint::t, second), nullptr);
    hdf5::write_series(file, "phi", "rad", "angle; 0: mass on the plane", points(&TracePoint::phi, 1.0), &t);
    hdf5::write_series(file, "spin", "rad s-1", "spin, positive downhill",
                       points(&TracePoint::spin, 1.0 / second), &t);
    hdf5::write_series(file, "x", "m", "travel of the hoop's centre along the plane",
                       points(&TracePoint::x, metre), &t);
    hdf5::write_series(file, "y", "m", "height of the hoop's lowest point above the plane",
                       points(&TracePoint::y, metre), &t);
    hdf5::write_series(file, "normal_force", "1", "normal force over the weight (11)",
                       points(&TracePoint::normal_force, 1.0), &t);
    hdf5::write_series(file, "friction", "1", "friction force over the weight, positive downhill (12)",
                       points(&TracePoint::friction, 1.0), &t);
    write_phases(file, story, t);

    std::vector<double> numbers, times, angles, spins, heights;
    for (const Candidate& candidate : story.candidates) {
      numbers.push_back(static_cast<double>(numbers.size() + 1));
      times.push_back(candidate.lift_off.time * second);
      angles.push_back(candidate.lift_off.angle);
      spins.push_back(candidate.lift_off.spin / second);
      heights.push_back(candidate.flight.height);
    }
    const Handle candidate =
        hdf5::write_series(file, "candidate", "1", "lift-offs in order, from 1", numbers, nullptr);
    hdf5::write_series(file, "candidate_time", "s", "time since release of the lift-off", times, &candidate);
    hdf5::write_series(file, "candidate_angle", "rad", "angle at the lift-off", angles, &candidate);
    hdf5::write_series(file, "candidate_spin", "rad s-1", "spin at the lift-off", spins, &candidate);
    hdf5::write_series(file, "candidate_height", "1", "apex of its flight, in hoop diameters", heights,
                       &candidate);
    file.finish(path);
  } catch (...) {
    file.discard();
    throw;
  }
}

}  // namespace leapmap
