// x = quadrant * pi/2 + (r - tail) with |r| <= pi/4 (a little more at the edges) for every finite x.
//
// Up to 2e5 by three-part Cody and Waite reduction (W. J. Cody, W. Waite, Software Manual for the
// Elementary Functions, 1980), beyond by that of M. H. Payne and R. N. Hanek (SIGNUM Newsletter 18,
// 1983), lane by lane in integers. Which of the two a lane gets depends on its own value only.
#pragma once

#include "arithmetic/doubles.hpp"

namespace {

struct ReducedAngle {
  Real r, tail;
  Words quadrant;  // counted modulo 4 in the lowest two bits; the others are arbitrary
};

constexpr double REDUCTION_LIMIT = 2.0e5;

// The bits of 2/pi after the binary point, after one word of zeros.
constexpr int TWO_OVER_PI_WORDS = 26;  // doubles need 20, double-double all of them
constexpr std::uint64_t TWO_OVER_PI[TWO_OVER_PI_WORDS] = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041,
    0xfe5163abdebbc561, 0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e,
    0xe88235f52ebb4484, 0xe99c7026b45f7e41, 0x3991d639835339f4, 0x9c845f8bbdf9283b,
    0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7, 0x4f463f669e5fea2d,
    0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab,
    0xf0cfbc209af4361d, 0xa9e391615ee61b08, 0x6599855f14a06840, 0x8dffd8804d732731,
    0x06061556ca73a8c9, 0x60e27bc08c6b47c4};

__extension__ typedef unsigned __int128 Natural128;

// 2^exponent, exponent within the normal range.
inline double scalar_power_of_two(int exponent) {
  const std::uint64_t word = (std::uint64_t)(exponent + 1023) << 52;
  double value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

// For finite x >= 2^15. With x = m 2^e (m an integer of 53 bits), the bits of 2/pi of weight
// 2^(2 - e) and more only add multiples of 4 quadrants; the next 192 bits times m give the quadrant
// and 190 bits of the fraction, wrong by less than 2^53 of the last. No double comes closer to a
// multiple of pi/2 than 2^-62, so at least 66 bits of r - tail are right.
inline void reduce_huge(double x, double& r, double& tail, std::int64_t& quadrant) {
  std::uint64_t word;
  std::memcpy(&word, &x, sizeof word);
  const int e = (int)(word >> 52) - 1075;
  const std::uint64_t m = (word & 0xfffffffffffffULL) | 0x10000000000000ULL;

  const int first = 62 + e, shift = first % 64;
  std::uint64_t w[3];
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t* t = TWO_OVER_PI + first / 64 + i;
    w[i] = shift ? t[0] << shift | t[1] >> (64 - shift) : t[0];
  }
  const Natural128 low = (Natural128)m * w[2];
  const Natural128 middle = (Natural128)m * w[1] + (std::uint64_t)(low >> 64);
  const std::uint64_t high = m * w[0] + (std::uint64_t)(middle >> 64);

  std::int64_t k = (std::int64_t)(high >> 62);
  Natural128 fraction = ((Natural128)high << 64 | (std::uint64_t)middle) << 2 |
                        (std::uint64_t)low >> 62;
  const bool above_half = fraction >> 127;
  if (above_half) {
    fraction = -fraction;
    ++k;
  }
  const std::uint64_t upper = (std::uint64_t)(fraction >> 64);
  const int zeros = upper ? __builtin_clzll(upper)
                          : 64 + __builtin_clzll((std::uint64_t)fraction | 1);
  fraction <<= zeros;

  // times pi/2 2^127, the upper 128 bits of 256
  const std::uint64_t pi_high = 0xc90fdaa22168c234, pi_low = 0xc4c6628b80dc1cd1;
  const std::uint64_t f_high = (std::uint64_t)(fraction >> 64), f_low = (std::uint64_t)fraction;
  const Natural128 cross = (Natural128)f_high * pi_low;
  const Natural128 carry = (Natural128)f_low * pi_high + (std::uint64_t)cross +
                           (std::uint64_t)((Natural128)f_low * pi_low >> 64);
  const Natural128 angle = (Natural128)f_high * pi_high + (std::uint64_t)(cross >> 64) +
                           (std::uint64_t)(carry >> 64);

  const double sign = above_half ? -1.0 : 1.0;
  const std::uint64_t leading = (std::uint64_t)(angle >> 75);
  const std::uint64_t trailing = (std::uint64_t)(angle >> 11) >> 1;
  r = sign * (double)(std::int64_t)leading * scalar_power_of_two(75 - 127 - zeros);
  tail = -sign * (double)(std::int64_t)trailing * scalar_power_of_two(12 - 127 - zeros);
  quadrant = k;
}

// Puts the lanes of x above the limit right; an infinite lane becomes NaN.
__attribute__((noinline, cold)) inline void reduce_large_lanes(const Real* x, ReducedAngle* angle) {
  for (int i = 0; i < LANES; ++i) {
    const double value = lane(*x, i), magnitude = value < 0 ? -value : value;
    if (!(magnitude > REDUCTION_LIMIT)) continue;
    double r = magnitude - magnitude, tail = 0.0;
    std::int64_t quadrant = 0;
    if (r == 0.0) reduce_huge(magnitude, r, tail, quadrant);
    angle->r.v[i] = value < 0 ? -r : r;
    angle->tail.v[i] = value < 0 ? -tail : tail;
    angle->quadrant[i] = value < 0 ? -quadrant : quadrant;
  }
}

MECHKIN_INLINE ReducedAngle reduce_angle(Real x) {
  // pi/2 in three parts. The first two have 35 bits, so that with at most 2^17 quadrants their
  // products are exact, and so are the first difference and, by fast two-sum, the error of the
  // second. The third leaves less than 2^-128 rad per quadrant, while no double comes within 2^-61
  // of a multiple of pi/2, nor within 2^-53 of one from 2^12 to 2^17 quadrants.
  const Real part1 = 0x1.921fb54440000p+0, part2 = 0x1.68c234c4c0000p-39,
             part3 = 0x1.98a2e03707345p-77, two_over_pi = 0x1.45f306dc9c883p-1;
  const Real shifted = x * two_over_pi + ROUNDER;
  const Real k = shifted - ROUNDER;
  const Real first = x - k * part1;
  const Real product = k * part2;
  const Real r = first - product;
  const Real lost = (first - r) - product;
  // `tail`, not its negative: +0 for x = -0, which keeps sin(-0) = -0.
  ReducedAngle angle{r, k * part3 - lost, bits(shifted)};
  if (__builtin_expect(any(abs(x) > Real(REDUCTION_LIMIT)), 0)) {
    ReducedAngle corrected = angle;
    reduce_large_lanes(&x, &corrected);
    angle = corrected;
  }
  return angle;
}

}  // namespace
