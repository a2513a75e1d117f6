// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/marks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "leapmap/body.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

bool names_centre(std::string_view name) {
  const std::string small = lower_case(name);
  for (const std::string_view word : {"centre", "center", "axis", "axle", "hub", "middle", "mitte"})
    if (small.find(word) != small.npos) return true;
  return small == "o" || small == "c";
}

/// The length of a track's way, coarsely enough that noise hardly counts.
double way_of(const Track& track) {
  const std::size_t step = std::max<std::size_t>(1, track.t.size() / 50);
  double way = 0.0;
  for (std::size_t i = step; i < track.t.size(); i += step)
    way += std::hypot(track.x[i] - track.x[i - step], track.y[i] - track.y[i - step]);
  return way;
}

/// A direction on the hoop, counted from that of the mass: of [hoop] that is the weights' common centre.
double from_mass(const Spec& spec, double angle) {
  return spec.hoop ? angle - reduce_body(*spec.hoop).direction : angle;
}

/// Where tracks are on the hoop: by --marker, by the names of weights, by names of the centre; of two tracks
/// the one with the shorter way is the centre.
class Places {
 public:
  Places(Film& film, const Spec& spec, const std::vector<Marker>& markers) : film_(film), spec_(spec) {
    known_.resize(film.tracks.size(), false);
    for (std::size_t k = 0; k < film.tracks.size(); ++k)
      if (names_centre(film.tracks[k].name) || names_centre(film.tracks[k].file)) put(k, 0.0, 0.0);
    for (std::size_t k = 0; k < film.tracks.size() && spec.hoop; ++k)
      for (const Weight& weight : spec.hoop->weights)
        if (lower_case(weight.name) == lower_case(film.tracks[k].name))
          put(k, weight.at, from_mass(spec, weight.angle));
    for (const Marker& marker : markers)
      if (!marker.track.empty()) put(find(marker), marker.at, from_mass(spec, marker.angle));
    find_centre();
    for (const Marker& marker : markers)
      if (marker.track.empty()) put(the_unknown(), marker.at, from_mass(spec, marker.angle));
    take_the_rest_as_the_mass();
  }

 private:
  void put(std::size_t track, double at, double angle) {
    if (!(at >= 0.0 && at <= spec_.scene.radius))
      throw InputError(fmt::format("--marker at={} m is out of range; allowed: from 0 to the radius, {} m",
                                   at, spec_.scene.radius));
    film_.tracks[track].at = at, film_.tracks[track].angle = angle, known_[track] = true;
  }
  std::size_t find(const Marker& marker) const {
    const auto track = std::ranges::find(film_.tracks, marker.track, &Track::name);
    if (track != film_.tracks.end()) return static_cast<std::size_t>(track - film_.tracks.begin());
    std::vector<std::string> names;
    for (const Track& one : film_.tracks) names.push_back(one.name);
    throw InputError(fmt::format("--marker {}: no track has that name; allowed: {}", marker.track,
                                 fmt::join(names, ", ")));
  }
  std::size_t the_unknown() const {
    if (std::ranges::count(known_, false) != 1)
      throw InputError(
          "--marker without a track's name: several tracks have no known place; allowed: \"NAME: at=..., "
          "angle=...\"");
    return static_cast<std::size_t>(std::ranges::find(known_, false) - known_.begin());
  }
  void find_centre() {
    if (film_.tracks.size() != 2 || known_[0] || known_[1]) return;
    put(way_of(film_.tracks[0]) < way_of(film_.tracks[1]) ? 0 : 1, 0.0, 0.0);
  }
  void take_the_rest_as_the_mass() {
    if (std::ranges::count(known_, false) > 1) {
      std::vector<std::string> names;
      for (std::size_t k = 0; k < known_.size(); ++k)
        if (!known_[k]) names.push_back(film_.tracks[k].name);
      throw InputError(
          fmt::format("tracks {} have no known place on the hoop; allowed: --marker \"NAME: at=47 mm, "
                      "angle=0 deg\" for each",
                      fmt::join(names, ", ")));
    }
    if (spec_.hoop && spec_.hoop->weights.size() > 1 && std::ranges::count(known_, false) == 1)
      throw InputError(
          fmt::format("the track '{}' has the name of no weight, and [hoop] has {}; allowed: --marker "
                      "\"at=47 mm, angle=0 deg\"",
                      film_.tracks[the_unknown()].name, spec_.hoop->weights.size()));
    if (spec_.hoop && spec_.hoop->weights.size() == 1 && std::ranges::count(known_, false) == 1)
      put(the_unknown(), spec_.hoop->weights[0].at, 0.0);
  }

  Film& film_;
  const Spec& spec_;
  std::vector<bool> known_;
};

}  // namespace

void place_marks(Film& film, const Spec& spec, const std::vector<Marker>& markers) {
  Places(film, spec, markers);
}

}  // namespace leapmap
