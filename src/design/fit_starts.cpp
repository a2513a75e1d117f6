// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/fit_starts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "design/fit_errors.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "numerics/sobol_points.hpp"

namespace leapmap {
namespace {

/// A place of the free parameters, and what it leaves unexplained.
struct CoarsePlace {
  std::vector<double> at;
  double sum;
};

/// Adds a map of a part of the box about a place, as large as `share` of it.
void map_coarsely(const Explained& explained, const FitOptions& options, const SobolPoints& points,
                  std::span<const double> centre, double share, std::vector<CoarsePlace>& places) {
  constexpr std::size_t a_block = 256;
  const std::size_t samples = points.samples(), dimensions = explained.searched();
  std::vector<std::vector<double>> found(samples, std::vector<double>(dimensions));
  std::vector<double> sums(samples);
  parallel_for_each((samples + a_block - 1) / a_block, options.threads, options.stop_requested, [&] {
    return [&](std::size_t block) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
      const std::size_t first = block * a_block, count = std::min(a_block, samples - first);
      for (std::size_t i = first; i < first + count; ++i)
        for (std::size_t k = 0; k < dimensions; ++k) {
          const Side& side = explained.problem().bounds[k];
          found[i][k] = side.value(side.coordinate(centre[k]) + share * (points.column(k)[i] - 0.5));
        }
      explained.coarse_sums(std::span(found).subspan(first, count), std::span(sums).subspan(first, count));
      return true;
    };
  });
  for (std::size_t i = 0; i < samples; ++i)
    if (std::isfinite(sums[i])) places.push_back({found[i], sums[i]});
  std::ranges::stable_sort(places, {}, &CoarsePlace::sum);
}

/// Fits from several starts, side by side, best first; those that found nothing are left out.
std::vector<LeastSquaresFit> fits_from(const LeastSquares& problem,
                                       const std::vector<std::vector<double>>& starts,
                                       const FitOptions& options, int most_iterations,
                                       std::size_t& evaluations) {
  std::vector<LeastSquaresFit> fits(starts.size());
  parallel_for_each(starts.size(), options.threads, options.stop_requested, [&] {
    return [&](std::size_t i) {
      if (options.stop_requested && options.stop_requested()) throw Stopped("the fit was stopped");
      fits[i] = minimize(problem, starts[i], most_iterations);
      return true;
    };
  });
  for (const LeastSquaresFit& fit : fits) evaluations += fit.evaluations;
  std::erase_if(fits, [](const LeastSquaresFit& fit) { return fit.residuals.empty(); });
  std::ranges::stable_sort(fits, {}, &LeastSquaresFit::sum);
  return fits;
}

}  // namespace

std::vector<std::vector<double>> coarse_starts(const Explained& explained, const FitOptions& options) {
  const bool film = explained.is_film();  // events are solved in lanes, and tell less
  const auto usual = [&](std::size_t asked, std::size_t of_film, std::size_t of_events) {
    return asked > 0 ? asked : film ? of_film : of_events;
  };
  const std::size_t samples = SobolPoints::whole(
                        usual(options.coarse, 2048, model_of(explained.scene()).exact ? 1 << 16 : 1 << 12)),
                    most = usual(options.starts, 8, 24);
  const std::size_t dimensions = explained.searched();
  if (dimensions == 0) return {{}};
  std::vector<double> middle;
  for (std::size_t k = 0; k < dimensions; ++k) middle.push_back(explained.problem().bounds[k].value(0.5));
  std::vector<CoarsePlace> places;
  map_coarsely(explained, options, SobolPoints(dimensions, samples, options.seed), middle, 1.0, places);
  // A film's sum of squares has narrow valleys, with steps where a phase appears: closer maps see into them.
  const SobolPoints fewer(dimensions, SobolPoints::whole(samples / 4), options.seed + 1);
  double finest = 1.0;
  for (const double share : {0.2, 0.05, 0.0125}) {
    if (places.empty()) return {};
    const std::vector<double> best = places[0].at;
    map_coarsely(explained, options, fewer, best, finest = share, places);
  }
  std::vector<std::vector<double>> starts;
  const auto add = [&](double beside, std::size_t up_to) {
    for (const CoarsePlace& place : places) {
      if (starts.size() == up_to) break;
      const bool is_new = std::ranges::none_of(starts, [&](const std::vector<double>& start) {
        for (std::size_t k = 0; k < dimensions; ++k) {
          const Side& side = explained.problem().bounds[k];
          if (std::abs(start[k] - place.at[k]) > beside * (side.high - side.low)) return false;
        }
        return true;
      });
      if (is_new) starts.push_back(place.at);
    }
  };
  add(0.1 * finest, (most + 1) / 2);  // beside the best
  add(0.1, most);                     // and elsewhere
  return starts;
}

LeastSquaresFit best_fit(const Explained& explained, const LeastSquares& problem,
                         std::vector<std::vector<double>> starts, const FitOptions& options,
                         std::size_t& evaluations) {
  constexpr std::size_t finalists = 2;
  constexpr int most_of_each = 30, most_of_finalists = 200;  // iterations
  if (explained.is_film()) {
    const std::vector<LeastSquaresFit> fits =
        fits_from(explained.small_problem(), starts, options, most_of_each, evaluations);
    starts.clear();
    for (const LeastSquaresFit& fit : fits)
      if (starts.size() < finalists && (starts.empty() || fit.at != starts.front())) starts.push_back(fit.at);
  }
  std::vector<LeastSquaresFit> fits = fits_from(problem, starts, options, most_of_finalists, evaluations);
  return fits.empty() ? LeastSquaresFit{} : std::move(fits.front());
}

LeastSquaresFit robust_fit(const LeastSquares& problem, LeastSquaresFit best, std::size_t& evaluations) {
  constexpr int most_rounds = 30;
  for (int round = 0; round < most_rounds; ++round) {
    const LeastSquaresFit next = minimize(weighed(problem, huber_weights(best.residuals)), best.at);
    evaluations += next.evaluations;
    if (next.residuals.empty()) break;
    double moved = 0.0;
    for (std::size_t k = 0; k < next.at.size(); ++k)
      moved = std::max(moved,
                       std::abs(next.at[k] - best.at[k]) / (problem.bounds[k].high - problem.bounds[k].low));
    LeastSquaresFit here = best;
    here.at = next.at;
    if (!problem.evaluate(here.at, here.residuals, here.jacobian)) break;
    best = std::move(here);
    constexpr double still = 1e-9;
    if (moved < still) break;
  }
  best.sum = sum_of_squares(best.residuals);
  return best;
}

}  // namespace leapmap
