// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/least_squares.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <numeric>

namespace leapmap {
namespace {

/// A residual where the model has no answer: no step that leads there is taken.
constexpr double no_answer = 1e150;

/// What GSL's callbacks see.
struct Followed {
  const LeastSquares& problem;
  std::size_t evaluations = 0;
  std::exception_ptr failure{};  // none may pass through GSL

  std::vector<double> place(const gsl_vector* arcs) const {
    std::vector<double> at;
    for (std::size_t k = 0; k < problem.bounds.size(); ++k) {
      const Side& side = problem.bounds[k];
      at.push_back(side.low + (side.high - side.low) * 0.5 * (1.0 + std::sin(gsl_vector_get(arcs, k))));
    }
    return at;
  }
  double per_arc(std::size_t k, const gsl_vector* arcs) const {
    const Side& side = problem.bounds[k];
    return 0.5 * (side.high - side.low) * std::cos(gsl_vector_get(arcs, k));
  }
};

template <class Work>
int guarded(void* data, const Work& work) {
  auto& followed = *static_cast<Followed*>(data);
  try {
    work(followed);
    return GSL_SUCCESS;
  } catch (...) {
    followed.failure = std::current_exception();
    return GSL_EFAILED;
  }
}

int residuals_at(const gsl_vector* arcs, void* data, gsl_vector* f) {
  return guarded(data, [&](Followed& followed) {
    std::vector<double> residuals(followed.problem.residuals);
    ++followed.evaluations;
    const bool known = followed.problem.evaluate(followed.place(arcs), residuals, {});
    for (std::size_t i = 0; i < residuals.size(); ++i) gsl_vector_set(f, i, known ? residuals[i] : no_answer);
  });
}

int jacobian_at(const gsl_vector* arcs, void* data, gsl_matrix* J) {
  return guarded(data, [&](Followed& followed) {
    const std::size_t rows = followed.problem.residuals, columns = followed.problem.bounds.size();
    std::vector<double> jacobian(rows * columns);
    ++followed.evaluations;
    const bool known = followed.problem.evaluate(followed.place(arcs), {}, jacobian);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t k = 0; k < columns; ++k)
        gsl_matrix_set(J, i, k, known ? jacobian[i * columns + k] * followed.per_arc(k, arcs) : 0.0);
  });
}

}  // namespace

double sum_of_squares(std::span<const double> residuals) {
  return std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
}

LeastSquaresFit minimize(const LeastSquares& problem, std::span<const double> start, int most_iterations) {
  static const bool silenced = (gsl_set_error_handler_off(), true);
  static_cast<void>(silenced);
  const std::size_t rows = problem.residuals, columns = problem.bounds.size();
  Followed followed{problem};
  gsl_multifit_nlinear_fdf system{};
  system.f = residuals_at, system.df = jacobian_at;
  system.n = rows, system.p = columns, system.params = &followed;
  gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
  how.trs = gsl_multifit_nlinear_trs_lm;
  how.scale = gsl_multifit_nlinear_scale_more;
  const std::unique_ptr<gsl_multifit_nlinear_workspace, void (*)(gsl_multifit_nlinear_workspace*)> workspace(
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, rows, columns), gsl_multifit_nlinear_free);
  const std::unique_ptr<gsl_vector, void (*)(gsl_vector*)> arcs(gsl_vector_alloc(columns), gsl_vector_free);
  if (!workspace || !arcs) throw std::bad_alloc();
  for (std::size_t k = 0; k < columns; ++k) {
    constexpr double inside = 1e-3;  // on a bound nothing would move it
    const Side& side = problem.bounds[k];
    const double share = std::clamp((start[k] - side.low) / (side.high - side.low), inside, 1.0 - inside);
    gsl_vector_set(arcs.get(), k, std::asin(2.0 * share - 1.0));
  }
  constexpr double step = 1e-12, slope = 1e-14;
  int info = 0;
  if (gsl_multifit_nlinear_init(arcs.get(), &system, workspace.get()) == GSL_SUCCESS)
    gsl_multifit_nlinear_driver(most_iterations, step, slope, 0.0, nullptr, nullptr, &info, workspace.get());
  if (followed.failure) std::rethrow_exception(followed.failure);
  LeastSquaresFit fit{.at = followed.place(gsl_multifit_nlinear_position(workspace.get())),
                      .residuals = std::vector<double>(rows),
                      .jacobian = std::vector<double>(rows * columns),
                      .evaluations = followed.evaluations + 1};
  if (problem.evaluate(fit.at, fit.residuals, fit.jacobian))
    fit.sum = sum_of_squares(fit.residuals);
  else
    fit.residuals.clear(), fit.jacobian.clear();
  return fit;
}

}  // namespace leapmap
