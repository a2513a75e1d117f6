// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves designs by Boost.odeint's dopri5 with dense output, as a user of Boost would write it: a program
/// that shares no line with leapmap, to compare with. analysis/rivals.py compiles and runs it:
///   boost_rival TOLERANCE REPEATS < designs.txt    a line each: slope, mass ratio, offset ratio
/// A design is a thin hoop released from rest with its mass on top, which rolls up to four turns; a jump is a
/// lift-off that reaches 0.05 diameters. Prints a line a design (status, spurious, candidates, height, time),
/// then the seconds of one run.
#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;
constexpr double pi = 3.14159265358979323846;

struct Hoop {
  double sin_slope, cos_slope, rho, J0;
};

double acceleration(const Hoop& h, const State& y) {
  const double s = std::sin(y[0]), c = std::cos(y[0]);
  return (h.sin_slope - h.rho * (h.sin_slope * c + h.cos_slope * s) - h.rho * s * y[1] * y[1]) /
         (h.J0 + 1 - 2 * h.rho * c);
}

double normal_force(const Hoop& h, const State& y) {
  return h.cos_slope + h.rho * (std::sin(y[0]) * acceleration(h, y) + std::cos(y[0]) * y[1] * y[1]);
}

/// Apex of the first interval with y > 0 [diameters]: sampled, then Newton's iteration on y'.
double jump_height(const Hoop& h, const State& at) {
  const double phi = at[0], w = at[1], speed = h.rho * std::sin(phi) * w;
  const auto y = [&](double t) {
    return -h.rho * std::cos(phi) + speed * t - 0.5 * h.cos_slope * t * t + h.rho * std::cos(phi + w * t);
  };
  const double step = 0.1 / (1 + std::abs(w)),
               last = (speed + std::sqrt(speed * speed + 4 * h.cos_slope * h.rho)) / h.cos_slope;
  double best = 0, when = 0;
  bool above = false;
  for (double t = step; t < last + step; t += step) {
    const double now = y(t);
    if (above && now <= 0) break;
    above = above || now > 1e-12;
    if (above && now > best) best = now, when = t;
  }
  if (!above) return 0;
  for (int i = 0; i < 8; ++i) {
    const double climb = speed - h.cos_slope * when - h.rho * w * std::sin(phi + w * when);
    const double move = climb / (h.cos_slope + h.rho * w * w * std::cos(phi + w * when));
    if (!(std::abs(move) < step)) break;
    when += move;
    if (std::abs(move) < 1e-14 * when) break;
  }
  return 0.5 * std::max(best, y(when));
}

struct Answer {
  int status = 2, spurious = 255, candidates = 0;  // 1 jumped, 2 no jump, 3 stalled, 6 failed
  double height = NAN, time = NAN;
};

Answer solve(const Hoop& h, double tolerance) {
  const auto rhs = [&](const State& y, State& f, double) { f = {y[1], acceleration(h, y)}; };
  auto stepper = odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<State>());
  Answer answer;
  State y{pi, 0.0};
  stepper.initialize(y, 0.0, 0.01);
  double force = normal_force(h, y);
  for (int steps = 0; steps < 200000; ++steps) {
    const auto [t0, t1] = stepper.do_step(rhs);
    y = stepper.current_state();
    const double next = normal_force(h, y);
    const auto root = [&](const auto& guard) {  // bisection on the dense output
      double a = t0, b = t1;
      State at;
      while (b - a > 1e-15 * b && 0.5 * (a + b) > a && 0.5 * (a + b) < b) {
        const double middle = 0.5 * (a + b);
        stepper.calc_state(middle, at);
        guard(at) > 0 ? a = middle : b = middle;
      }
      stepper.calc_state(b, at);
      return std::pair{b, at};
    };
    if (force > 0 && next <= 0) {
      const auto [t, at] = root([&](const State& s) { return normal_force(h, s); });
      if (at[0] <= 9 * pi) {
        const double height = jump_height(h, at);
        ++answer.candidates;
        if (answer.candidates == 1) answer.spurious = height < 0.05;
        if (height >= 0.05) {
          answer.status = 1, answer.height = height, answer.time = t;
          return answer;
        }
      }
    }
    if (y[1] < 0) {
      answer.status = 3;
      return answer;
    }
    if (y[0] > 9 * pi) return answer;
    force = next;
  }
  answer.status = 6;
  return answer;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const double tolerance = std::atof(argv[1]);
  const int repeats = std::atoi(argv[2]);
  std::vector<Hoop> hoops;
  double slope, beta, lambda;
  while (std::scanf("%lf %lf %lf", &slope, &beta, &lambda) == 3) {
    const double alpha = beta / (1 + beta);
    hoops.push_back(
        {std::sin(slope), std::cos(slope), alpha * lambda, 1 / (1 + beta) + alpha * lambda * lambda});
  }
  std::vector<Answer> answers(hoops.size());
  double least = HUGE_VAL;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < hoops.size(); ++i) answers[i] = solve(hoops[i], tolerance);
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  for (const Answer& a : answers)
    std::printf("%d %d %d %.17g %.17g\n", a.status, a.spurious, a.candidates, a.height, a.time);
  std::printf("%.9g\n", least);
}
