// The scalar of a compiled unit: `Pack`, one number of each lane in the arithmetic that the build names.
//
// Everything numeric in the kernel is written once for `Pack` and `Mask`, inside an anonymous namespace, so that no symbol
// of one unit can be linked into another. Without MECHKIN_ARITHMETIC a unit computes in doubles (`Real`), and what is
// inherently of doubles (bits, error-free transformations) says `Real` in every unit.
//
//   MECHKIN_DOUBLES        Real: + - * / sqrt of IEEE (arithmetic/doubles.hpp)
//   MECHKIN_DOUBLE_DOUBLE  DoubleDouble: high and low (arithmetic/double_double.hpp)
//   MECHKIN_INTERVALS      Interval: midpoint in double-double and radius (arithmetic/interval.hpp)
//   MECHKIN_TAYLOR         Taylor: coefficients by a parameter and radius (arithmetic/taylor.hpp)
//
// HALF_PLACE is half the last place of 1. A number of PARTS parts takes PARTS consecutive rows of an array: part i of number k of a row stands at
// [(PARTS * k + i) * rows + row].
#pragma once

#define MECHKIN_DOUBLES 0
#define MECHKIN_DOUBLE_DOUBLE 1
#define MECHKIN_INTERVALS 2
#define MECHKIN_TAYLOR 3
#ifndef MECHKIN_ARITHMETIC
#define MECHKIN_ARITHMETIC MECHKIN_DOUBLES
#endif
// Whether numbers are sets of numbers, which are not compared: such units evaluate alone.
#define MECHKIN_ENCLOSES (MECHKIN_ARITHMETIC >= MECHKIN_INTERVALS)

#if MECHKIN_ARITHMETIC == MECHKIN_DOUBLE_DOUBLE
#include "arithmetic/double_double_scalar.hpp"
#elif MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
#include "arithmetic/interval.hpp"
#elif MECHKIN_ARITHMETIC == MECHKIN_TAYLOR
#include "arithmetic/taylor.hpp"
#else
#include "arithmetic/doubles.hpp"
#endif

#if MECHKIN_ARITHMETIC != MECHKIN_DOUBLES  // each operation is a dozen of doubles': what is made of them is inlined where the compiler likes it
#undef MECHKIN_INLINE
#define MECHKIN_INLINE inline
#endif

namespace {

#if MECHKIN_ARITHMETIC == MECHKIN_DOUBLE_DOUBLE
using Pack = DoubleDouble;
constexpr int PARTS = 2;
constexpr double HALF_PLACE = 0x1p-105;
constexpr TwoParts FULL_TURN = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};
MECHKIN_INLINE Pack from_parts(const Real* part) { return {part[0], part[1]}; }
MECHKIN_INLINE Real part_of(Pack a, int i) { return i ? a.low : a.high; }
#elif MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
using Pack = Interval;
constexpr int PARTS = 3;
// 2 pi
constexpr ThreeParts FULL_TURN = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52, 0x1p-104};
MECHKIN_INLINE Pack from_parts(const Real* part) { return {DoubleDouble(part[0], part[1]), part[2]}; }
MECHKIN_INLINE Real part_of(const Pack& a, int i) { return i > 1 ? a.radius : i ? a.midpoint.low : a.midpoint.high; }
#elif MECHKIN_ARITHMETIC == MECHKIN_TAYLOR
using Pack = Taylor;
constexpr int PARTS = ORDER + 2;
MECHKIN_INLINE Pack from_parts(const Real* part) {
  Pack a;
  for (int k = 0; k <= ORDER; ++k) a.c[k] = part[k];
  a.radius = part[ORDER + 1];
  return a;
}
MECHKIN_INLINE Real part_of(const Pack& a, int i) { return i <= ORDER ? a.c[i] : a.radius; }
#else
using Pack = Real;
constexpr int PARTS = 1;
constexpr double HALF_PLACE = 0x1p-53;
constexpr double FULL_TURN = 2.0 * 3.14159265358979323846;
MECHKIN_INLINE Pack from_parts(const Real* part) { return part[0]; }
MECHKIN_INLINE Real part_of(Pack a, int) { return a; }
#endif

#if MECHKIN_ARITHMETIC == MECHKIN_DOUBLES || MECHKIN_ARITHMETIC == MECHKIN_TAYLOR  // the others sum products at less cost
MECHKIN_INLINE void add_product(Pack& x, const Pack& a, const Pack& b) { x += a * b; }
MECHKIN_INLINE void subtract_product(Pack& x, const Pack& a, const Pack& b) { x -= a * b; }
MECHKIN_INLINE Pack sum_of_products(const Pack& a, const Pack& b, const Pack& c, const Pack& d, const Pack& e,
                                    const Pack& f) {
  return a * b + c * d + e * f;
}
MECHKIN_INLINE Pack difference_of_products(const Pack& a, const Pack& b, const Pack& c, const Pack& d) {
  return a * b - c * d;
}
#endif

}  // namespace
