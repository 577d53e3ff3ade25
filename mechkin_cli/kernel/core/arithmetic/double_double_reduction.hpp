// x = quadrant * pi/2 + r with |r| <= pi/4 (a little more at the edges) for every finite double-double x.
//
// As angle_reduction.hpp, to 2^-104 of r even where x is the double-double next to a multiple of pi/2: up to 2e5 by
// seven-part Cody and Waite reduction, whose terms are summed as in fivefold precision (T. Ogita, S. M. Rump, S. Oishi,
// Accurate sum and dot product, SIAM J. Scientific Computing 26, 2005, algorithm SumK), beyond by that of Payne and Hanek
// with 320 bits of the fraction.
#pragma once

#include "arithmetic/angle_reduction.hpp"
#include "arithmetic/double_double_scalar.hpp"

namespace {

struct ReducedDoubleDouble {
  DoubleDouble r;
  Words quadrant;  // counted modulo 4 in the lowest two bits
};

constexpr TwoParts HALF_PI = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

// A number modulo 2^64 in fixed point, its first word whole, the others its fraction.
constexpr int FIXED_WORDS = 6;
struct FixedPoint {
  std::uint64_t word[FIXED_WORDS] = {};
};

// `sum` += x 2/pi modulo 2^64, for finite x. With x = m 2^e, the bits of 2/pi of weight 2^(64 - e) and more only add
// multiples of 2^64; of those after them 384 times m leave an error below 2^53 of the last of `sum`.
inline void add_quadrants(double x, FixedPoint& sum) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const int biased = (int)(bits >> 52 & 0x7ff), e = (biased ? biased : 1) - 1075;
  const std::uint64_t m = (bits & 0xfffffffffffffULL) | (biased ? 0x10000000000000ULL : 0);
  const auto word = [](int i) { return i < 0 || i >= TWO_OVER_PI_WORDS ? 0 : TWO_OVER_PI[i]; };
  FixedPoint product;
  std::uint64_t carry = 0;
  for (int j = FIXED_WORDS - 1; j >= 0; --j) {
    const int at = e + 64 * j + 64 * 32, first = at / 64 - 32, shift = at % 64;  // not below zero before it is divided
    const std::uint64_t t = shift ? word(first) << shift | word(first + 1) >> (64 - shift) : word(first);
    const Natural128 part = (Natural128)m * t + carry;
    product.word[j] = (std::uint64_t)part, carry = (std::uint64_t)(part >> 64);
  }
  const bool negative = bits >> 63;
  std::uint64_t over = negative;
  for (int j = FIXED_WORDS - 1; j >= 0; --j) {
    const Natural128 part = (Natural128)sum.word[j] + (negative ? ~product.word[j] : product.word[j]) + over;
    sum.word[j] = (std::uint64_t)part, over = (std::uint64_t)(part >> 64);
  }
}

// The fraction in [-1/2, 1/2] as three doubles of 53 bits each, and the quadrant.
inline void read_fraction(FixedPoint x, double* part, std::int64_t& quadrant) {
  quadrant = (std::int64_t)x.word[0];
  const bool negative = x.word[1] >> 63;
  if (negative) {
    ++quadrant;
    std::uint64_t over = 1;
    for (int j = FIXED_WORDS - 1; j > 0; --j) {
      const Natural128 negated = (Natural128)~x.word[j] + over;
      x.word[j] = (std::uint64_t)negated, over = (std::uint64_t)(negated >> 64);
    }
  }
  int zeros = 0;
  while (zeros < 64 * (FIXED_WORDS - 1) && !(x.word[1 + zeros / 64] >> (63 - zeros % 64) & 1)) ++zeros;
  const auto chunk = [&x](int begin) {  // 53 bits of the fraction
    std::uint64_t r = 0;
    for (int b = begin; b < begin + 53; ++b)
      r = r << 1 | (b < 64 * (FIXED_WORDS - 1) ? x.word[1 + b / 64] >> (63 - b % 64) & 1 : 0);
    return (double)(std::int64_t)r;
  };
  for (int k = 0; k < 3; ++k)
    part[k] = (negative ? -1.0 : 1.0) * chunk(zeros + 53 * k) * scalar_power_of_two(-(zeros + 53 * (k + 1)));
}

// Puts the lanes of x above the limit right; an infinite lane becomes NaN.
__attribute__((noinline, cold)) inline void reduce_large_lanes(const DoubleDouble* x, ReducedDoubleDouble* angle) {
  for (int i = 0; i < LANES; ++i) {
    const double high = x->high.v[i], low = x->low.v[i];
    if (!((high < 0 ? -high : high) > REDUCTION_LIMIT)) continue;
    double part[3] = {high - high, 0.0, 0.0};
    std::int64_t quadrant = 0;
    if (part[0] == 0.0) {
      FixedPoint sum;
      add_quadrants(high, sum), add_quadrants(low, sum);
      read_fraction(sum, part, quadrant);
    }
    const DoubleDouble first = fast_two_sum(Real(part[0]), Real(part[1]));
    const DoubleDouble fraction = fast_two_sum(first.high, first.low + Real(part[2]));
    const DoubleDouble r = product(fraction, HALF_PI);
    angle->r.high.v[i] = r.high.v[0], angle->r.low.v[i] = r.low.v[0];
    angle->quadrant[i] = quadrant;
  }
}

MECHKIN_INLINE ReducedDoubleDouble reduce_angle(const DoubleDouble& x) {
  // pi/2 in seven parts: six of 35 bits, whose products with at most 2^17 quadrants are exact, and the rest, which leaves
  // less than 2^-257
  const double part[7] = {0x1.921fb54440000p+0,   0x1.68c234c4c0000p-39,  0x1.98a2e03700000p-77, 0x1.cd129024c0000p-115,
                          0x1.044533e600000p-150, 0x1.d0082efa80000p-185, 0x1.8ec4e6c894528p-221};
  const Real shifted = x.high * Real(0x1.45f306dc9c883p-1) + Real(ROUNDER);
  const Real k = shifted - Real(ROUNDER);
  constexpr int TERMS = 8;
  Real t[TERMS] = {x.high - k * Real(part[0]), -(k * Real(part[1])), x.low};
  for (int i = 2; i < 7; ++i) t[i + 1] = -(k * Real(part[i]));
  for (int pass = 0; pass < 4; ++pass)
    for (int i = TERMS - 2; i >= 0; --i) {
      const DoubleDouble sum = two_sum(t[i], t[i + 1]);
      t[i] = sum.high, t[i + 1] = sum.low;
    }
  DoubleDouble rest = t[TERMS - 1];
  for (int i = TERMS - 2; i > 0; --i) rest = agreeing_sum(t[i], rest);
  ReducedDoubleDouble angle = {agreeing_sum(t[0], rest), bits(shifted)};
  if (__builtin_expect(any(abs(x.high) > Real(REDUCTION_LIMIT)), 0)) {
    ReducedDoubleDouble corrected = angle;
    reduce_large_lanes(&x, &corrected);
    angle = corrected;
  }
  return angle;
}

}  // namespace
