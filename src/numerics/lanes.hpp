// SPDX-License-Identifier: GPL-3.0-or-later
/// One vocabulary for a number and for a SIMD batch of numbers, so that an algorithm is written once.
///
/// Code on a scalar T says select(mask, a, b), any(mask) and all(mask) where it would say if; the mask of a
/// plain number is a bool, its count of lanes one. For xsimd's batches the functions of the same names are
/// xsimd's own.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <xsimd/xsimd.hpp>

#include "numerics/sincos.hpp"

namespace leapmap {

/// As many doubles as one instruction of the machine this was compiled for works on.
using Batch = xsimd::batch<double>;

template <class T>
struct Lanes {
  using Scalar = T;
  using Mask = bool;
  static constexpr std::size_t count = 1;
  static T load(const T* from) { return *from; }
  static void store(const T& value, T* to) { *to = value; }
  /// One bit a lane, lane 0 lowest.
  static unsigned bits(bool mask) { return mask; }
  /// The last lane of `before`, then all lanes but the last.
  static T moved_up(const T& before, const T&) { return before; }
  /// 64 bits a lane.
  using Word = std::uint64_t;
  /// Sets the marks in the lanes of the mask.
  static Word marked(Word word, bool mask, std::uint64_t marks) { return word | (mask ? marks : 0); }
  static void store(Word word, std::uint64_t* to) { *to = word; }
};

template <class S, class A>
struct Lanes<xsimd::batch<S, A>> {
  using Scalar = S;
  using Mask = xsimd::batch_bool<S, A>;
  static constexpr std::size_t count = xsimd::batch<S, A>::size;
  static xsimd::batch<S, A> load(const S* from) { return xsimd::batch<S, A>::load_unaligned(from); }
  static void store(const xsimd::batch<S, A>& value, S* to) { value.store_unaligned(to); }
  using Word = xsimd::batch<std::uint64_t, A>;
  static Word marked(const Word& word, const Mask& mask, std::uint64_t marks) {
#ifdef __AVX512F__
    if constexpr (count == 8)
      return Word(_mm512_mask_or_epi64(word.data, mask.data, word.data, Word(marks).data));
#endif
    using B = xsimd::batch<S, A>;
    return word | xsimd::bitwise_cast<Word>(xsimd::select(mask, xsimd::bitwise_cast<B>(Word(marks)), B(0)));
  }
  static void store(const Word& word, std::uint64_t* to) { word.store_unaligned(to); }
  static xsimd::batch<S, A> moved_up(const xsimd::batch<S, A>& before, const xsimd::batch<S, A>& value) {
    // Through memory the load would wait for both stores.
#ifdef __AVX512F__
    if constexpr (count == 8 && sizeof(S) == 8)
      return {_mm512_castsi512_pd(
          _mm512_alignr_epi64(_mm512_castpd_si512(value.data), _mm512_castpd_si512(before.data), 7))};
#endif
#ifdef __AVX2__
    if constexpr (count == 4 && sizeof(S) == 8)
      return {_mm256_permute4x64_pd(_mm256_blend_pd(value.data, before.data, 0b1000), 0b10'01'00'11)};
#endif
    std::array<S, 2 * count> lanes;
    store(before, lanes.data());
    store(value, lanes.data() + count);
    return load(lanes.data() + count - 1);
  }
  static unsigned bits(const Mask& mask) {
#ifdef __AVX512F__
    if constexpr (std::is_same_v<A, xsimd::avx512f> || std::is_base_of_v<xsimd::avx512f, A>)
      return static_cast<unsigned>(mask.data);
#endif
#ifdef __AVX__
    if constexpr (count == 4 && sizeof(S) == 8) return static_cast<unsigned>(_mm256_movemask_pd(mask.data));
#endif
#ifdef __SSE2__
    if constexpr (count == 2 && sizeof(S) == 8) return static_cast<unsigned>(_mm_movemask_pd(mask.data));
#endif
    std::array<bool, count> lanes;
    mask.store_unaligned(lanes.data());
    unsigned bits = 0;
    for (std::size_t i = 0; i < count; ++i) bits |= static_cast<unsigned>(lanes[i]) << i;
    return bits;
  }
};

constexpr std::size_t batch_width = Lanes<Batch>::count;

template <class T>
using MaskOf = typename Lanes<T>::Mask;
template <class T>
using ScalarOf = typename Lanes<T>::Scalar;

template <class T>
inline constexpr ScalarOf<T> pi_of = std::numbers::pi_v<ScalarOf<T>>;

/// The lanes of a value as an array.
template <class T>
using LaneArray = std::array<ScalarOf<T>, Lanes<T>::count>;
template <class T>
LaneArray<T> lanes_of(const T& value) {
  LaneArray<T> lanes;
  Lanes<T>::store(value, lanes.data());
  return lanes;
}

/// The last lane of `before`, then all lanes but the last.
template <class T>
T moved_up(const T& before, const T& value) {
  return Lanes<T>::moved_up(before, value);
}

/// number_of(i) in lane i.
template <class T, class F>
T gathered(const F& number_of) {
  LaneArray<T> lanes;
  for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i] = static_cast<ScalarOf<T>>(number_of(i));
  return Lanes<T>::load(lanes.data());
}

template <class T>
T select(bool mask, const T& a, const T& b) {
  return mask ? a : b;
}
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }
using xsimd::all;
using xsimd::any;
using xsimd::select;

template <class T>
T larger(const T& a, const T& b) {
  return select(a > b, a, b);
}
template <class T>
T smaller(const T& a, const T& b) {
  return select(a < b, a, b);
}
template <class S, class A>
xsimd::batch<S, A> larger(const xsimd::batch<S, A>& a, const xsimd::batch<S, A>& b) {
  return xsimd::max(a, b);
}
template <class S, class A>
xsimd::batch<S, A> smaller(const xsimd::batch<S, A>& a, const xsimd::batch<S, A>& b) {
  return xsimd::min(a, b);
}

/// As many of a number side by side as the machine has lanes of it. What depends on it takes the type as an
/// argument of its template: names of different instruction sets must differ.
template <class S>
struct Abreast {
  using Type = S;
};
template <>
struct Abreast<double> {
  using Type = Batch;
};
template <class S>
using AbreastOf = typename Abreast<S>::Type;

/// The same number in every lane.
template <class T>
T abreast(const ScalarOf<T>& number) {
  return T(number);
}

template <class T>
ScalarOf<T> sum_of_lanes(const T& numbers) {
  const LaneArray<T> lanes = lanes_of(numbers);
  ScalarOf<T> sum = lanes[0];
  for (std::size_t k = 1; k < lanes.size(); ++k) sum += lanes[k];
  return sum;
}
template <class T>
ScalarOf<T> largest_lane(const T& numbers) {
  const LaneArray<T> lanes = lanes_of(numbers);
  ScalarOf<T> most = lanes[0];
  for (const ScalarOf<T>& lane : lanes) most = lane > most ? lane : most;
  return most;
}

/// 1 / x, to a few roundings.
template <class T>
T reciprocal(const T& x) {
  return T(ScalarOf<T>(1)) / x;
}
#ifdef __AVX512F__
/// From the instruction's 14 bits by two of Newton's steps: a third of the time of a division.
template <class A>
xsimd::batch<double, A> reciprocal(const xsimd::batch<double, A>& x) requires(xsimd::batch<double, A>::size ==
                                                                              8) {
  using T = xsimd::batch<double, A>;
  T y = _mm512_rcp14_pd(x);
  y = xsimd::fma(y, xsimd::fnma(x, y, T(1.0)), y);
  return xsimd::fma(y, xsimd::fnma(x, y, T(1.0)), y);
}
#endif

/// 1 / sqrt(x) for x > 0, to a few roundings.
template <class T>
T reciprocal_sqrt(const T& x) {
  using std::sqrt;
  return T(1) / sqrt(x);
}
#ifdef __AVX512F__
/// From the instruction's 14 bits by one step of fourth order: half the time of a square root and a division.
template <class A>
xsimd::batch<double, A> reciprocal_sqrt(const xsimd::batch<double, A>& x) requires(
    xsimd::batch<double, A>::size == 8) {
  using T = xsimd::batch<double, A>;
  const T y = _mm512_rsqrt14_pd(x);
  const T error = T(1.0) - x * y * y;
  return y + y * error * (T(0.5) + error * (T(0.375) + error * T(0.3125)));
}
#endif

}  // namespace leapmap
