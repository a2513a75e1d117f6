// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film_angles.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "numerics/median.hpp"

namespace leapmap {

std::pair<const Track*, const Track*> centre_and_mark(const Film& film) {
  const Track *centre = nullptr, *mark = nullptr;
  const auto distance = [](const Track& track) { return std::isnan(track.at) ? HUGE_VAL : track.at; };
  for (const Track& track : film.tracks) {
    if (track.at == 0.0)
      centre = &track;
    else if (!mark || distance(track) > distance(*mark))
      mark = &track;
  }
  return {centre, mark};
}

FilmAngles angles_of(const Film& film, double slope) {
  FilmAngles angles;
  constexpr double turn = 2.0 * std::numbers::pi;
  if (film.tracks.empty()) {
    for (std::size_t i = 0; i < film.phi.size(); ++i)
      if (!std::isnan(film.phi[i])) angles.t.push_back(film.t[i]), angles.phi.push_back(film.phi[i]);
    return angles;
  }
  const auto [centre, mark] = centre_and_mark(film);
  if (!centre || !mark) return angles;
  const double turned = film.camera.tilt + (film.is_level ? slope : 0.0) + mark->angle;
  for_common_times(*mark, *centre, [&, mark = mark, centre = centre](std::size_t i, std::size_t k) {
    const double angle = std::atan2(centre->x[k] - mark->x[i], centre->y[k] - mark->y[i]) - turned;
    angles.t.push_back(mark->t[i]);
    angles.phi.push_back(angles.phi.empty() ? angle - turn * std::floor(angle / turn)
                                            : angle + turn * std::round((angles.phi.back() - angle) / turn));
  });
  return angles;
}

std::pair<double, double> release_of(const FilmAngles& angles, double release, double second) {
  constexpr double long_enough = 1.5;  // in sqrt(R/g)
  std::size_t some = 0;
  while (some < angles.t.size() && angles.t[some] <= angles.t[0] + long_enough * second) ++some;
  some = std::clamp<std::size_t>(some, 3, angles.t.size());
  const auto rows = static_cast<Eigen::Index>(some);
  const Eigen::Index columns = std::min<Eigen::Index>(4, rows);
  Eigen::MatrixXd powers(rows, columns);
  Eigen::VectorXd measured(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = (angles.t[static_cast<std::size_t>(i)] - release) / second;
    for (Eigen::Index k = 0; k < columns; ++k) powers(i, k) = std::pow(t, static_cast<double>(k));
    measured[i] = angles.phi[static_cast<std::size_t>(i)];
  }
  // By Huber's weights, so that a bad mark in the first frames hardly counts.
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(rows), cubic(columns);
  for (int round = 0; round < 5; ++round) {
    cubic = (weights.asDiagonal() * powers).colPivHouseholderQr().solve(weights.cwiseProduct(measured));
    const Eigen::VectorXd off = (powers * cubic - measured).cwiseAbs();
    const double limit = std::max(2.0 * median({off.begin(), off.end()}), 1e-12);
    for (Eigen::Index i = 0; i < rows; ++i)
      weights[i] = std::sqrt(std::min(1.0, limit / std::max(off[i], 1e-300)));
  }
  return {cubic[0], cubic[1] / second};
}

}  // namespace leapmap
