// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/observations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "numerics/median.hpp"

namespace leapmap {

std::vector<Observation> observations_of(const Film& film) {
  std::vector<Observation> all;
  const auto add = [&](Measured kind, std::size_t track, double t, double value) {
    if (!std::isnan(value)) all.push_back({kind, track, t, value});
  };
  for (std::size_t i = 0; i < film.t.size(); ++i) {
    if (!film.phi.empty()) add(Measured::angle, 0, film.t[i], film.phi[i]);
    if (!film.spin.empty()) add(Measured::spin, 0, film.t[i], film.spin[i]);
  }
  for (std::size_t k = 0; k < film.tracks.size(); ++k)
    for (std::size_t i = 0; i < film.tracks[k].t.size(); ++i) {
      add(Measured::x, k, film.tracks[k].t[i], film.tracks[k].x[i]);
      add(Measured::y, k, film.tracks[k].t[i], film.tracks[k].y[i]);
    }
  std::stable_sort(all.begin(), all.end(),
                   [](const Observation& a, const Observation& b) { return a.t < b.t; });
  return all;
}

std::string name_of(const Observation& observation, const Film& film) {
  switch (observation.kind) {
    case Measured::angle:
      return "phi";
    case Measured::spin:
      return "spin";
    case Measured::x:
      return "x_" + film.tracks[observation.track].name;
    case Measured::y:
      return "y_" + film.tracks[observation.track].name;
  }
  return {};
}

double scatter_of(std::span<const Observation> observations, Measured kind) {
  std::map<std::pair<std::size_t, Measured>, std::vector<double>> series;
  for (const Observation& one : observations)
    if (are_alike(one.kind, kind)) series[{one.track, one.kind}].push_back(one.value);
  std::vector<double> differences;
  for (const auto& [of, values] : series)
    for (std::size_t i = 3; i < values.size(); ++i)
      differences.push_back(std::abs(values[i] - 3.0 * values[i - 1] + 3.0 * values[i - 2] - values[i - 3]));
  if (differences.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double of_normal = 0.6745 * std::sqrt(20.0);  // 1 + 9 + 9 + 1
  return median(std::move(differences)) / of_normal;
}

}  // namespace leapmap
