// SPDX-License-Identifier: GPL-3.0-or-later
/// A ball of real numbers by Arb: a midpoint with a radius, which every operation makes large enough to hold
/// all that it may come to. It is the scalar of the equations in hoop/ where something is to be proved.
///
/// A comparison is true where it holds of all numbers of both balls; where it is false it may hold of some.
#pragma once

#include <arb.h>

#include <concepts>
#include <utility>

#include "hoop/rolling.hpp"

namespace leapmap {

class Ball {
 public:
  static constexpr slong precision = 64;  ///< bits of the midpoint

  Ball() { arb_init(x_); }
  Ball(double number) : Ball() { arb_set_d(x_, number); }
  Ball(std::integral auto number) : Ball() { arb_set_si(x_, static_cast<slong>(number)); }
  Ball(const Ball& other) : Ball() { arb_set(x_, other.x_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(x_, other.x_); }
  Ball& operator=(const Ball& other) {
    arb_set(x_, other.x_);
    return *this;
  }
  Ball& operator=(Ball&& other) noexcept {
    arb_swap(x_, other.x_);
    return *this;
  }
  ~Ball() { arb_clear(x_); }

  /// All numbers from one to another; not finite if they are not in order.
  static Ball between(double from, double to);
  static Ball pi() {
    Ball all;
    arb_const_pi(all.x_, precision);
    return all;
  }

  /// No number of the ball is below, or above.
  double lower() const;
  double upper() const;
  double middle() const { return arf_get_d(arb_midref(x_), ARF_RND_NEAR); }
  bool is_finite() const { return arb_is_finite(x_) != 0; }
  /// 1: all above zero, -1: all below, 0: neither.
  int sign() const { return arb_is_positive(x_) ? 1 : arb_is_negative(x_) ? -1 : 0; }
  bool holds(double number) const;

  arb_ptr arb() { return x_; }
  arb_srcptr arb() const { return x_; }

  friend Ball operator+(const Ball& a, const Ball& b) { return made(arb_add, a, b); }
  friend Ball operator-(const Ball& a, const Ball& b) { return made(arb_sub, a, b); }
  friend Ball operator*(const Ball& a, const Ball& b) { return made(arb_mul, a, b); }
  friend Ball operator/(const Ball& a, const Ball& b) { return made(arb_div, a, b); }
  friend Ball operator-(const Ball& a) {
    Ball c;
    arb_neg(c.x_, a.x_);
    return c;
  }
  friend bool operator<(const Ball& a, const Ball& b) { return arb_lt(a.x_, b.x_) != 0; }
  friend bool operator>(const Ball& a, const Ball& b) { return arb_gt(a.x_, b.x_) != 0; }
  friend bool operator<=(const Ball& a, const Ball& b) { return arb_le(a.x_, b.x_) != 0; }
  friend bool operator>=(const Ball& a, const Ball& b) { return arb_ge(a.x_, b.x_) != 0; }
  friend bool operator==(const Ball& a, const Ball& b) { return arb_eq(a.x_, b.x_) != 0; }
  /// Whether they may differ.
  friend bool operator!=(const Ball& a, const Ball& b) { return !(a == b); }

  friend Ball abs(const Ball& a) {
    Ball c;
    arb_abs(c.x_, a.x_);
    return c;
  }
  friend Ball sqrt(const Ball& a) {
    Ball c;
    arb_sqrt(c.x_, a.x_, precision);
    return c;
  }
  friend SinCos<Ball> sincos_of(const Ball& a) {
    SinCos<Ball> c;
    arb_sin_cos(c.sin.x_, c.cos.x_, a.x_, precision);
    return c;
  }
  /// sin(a) / a.
  friend Ball sinc(const Ball& a) {
    Ball c;
    arb_sinc(c.x_, a.x_, precision);
    return c;
  }
  /// All numbers of both, and those between.
  friend Ball hull(const Ball& a, const Ball& b) { return made(arb_union, a, b); }
  /// The numbers of both, of which there has to be one: throws std::logic_error if there is none. What is not
  /// finite says nothing.
  friend Ball meet(const Ball& a, const Ball& b);

 private:
  template <class F>
  static Ball made(F operation, const Ball& a, const Ball& b) {
    Ball c;
    operation(c.x_, a.x_, b.x_, precision);
    return c;
  }

  arb_t x_;
};

/// Of an angle, 1 - cos without cancellation.
Trig<Ball> trig(const Ball& angle);
/// x - sin x, which grows with x. turned: trig(x).
Ball x_minus_sin(const Ball& x, const Trig<Ball>& turned);

}  // namespace leapmap
