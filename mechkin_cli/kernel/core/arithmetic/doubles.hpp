// W doubles that march together (rows of a sweep, starts of a search, variants of a study), and masks of their lanes.
//
// Only IEEE + - * / sqrt, comparisons and bit operations occur, each lane on its own: a lane's bits depend neither on its
// neighbours nor on the width.
//
// MECHKIN_LANES (2, 4, 8) is set by the build. A `Real` is a compiler vector of GCC or Clang.
#pragma once

#include "arithmetic/mask.hpp"

// Compiled once: what is called from many entries of a table, where copies in line would cost room and gain nothing.
#define MECHKIN_APART inline __attribute__((noinline))
// The same for what rare rows need: small rather than fast.
#define MECHKIN_RARE inline __attribute__((noinline, cold))

namespace {

struct Real {
  Doubles v;
  Real() = default;
  MECHKIN_INLINE Real(Doubles x) : v(x) {}
  MECHKIN_INLINE Real(double x) : v(x - Doubles{}) {}

  friend MECHKIN_INLINE Real operator+(Real a, Real b) { return a.v + b.v; }
  friend MECHKIN_INLINE Real operator-(Real a, Real b) { return a.v - b.v; }
  friend MECHKIN_INLINE Real operator*(Real a, Real b) { return a.v * b.v; }
  friend MECHKIN_INLINE Real operator/(Real a, Real b) { return a.v / b.v; }
  friend MECHKIN_INLINE Real operator-(Real a) { return -a.v; }
  MECHKIN_INLINE Real& operator+=(Real b) { v += b.v; return *this; }
  MECHKIN_INLINE Real& operator-=(Real b) { v -= b.v; return *this; }
  MECHKIN_INLINE Real& operator*=(Real b) { v *= b.v; return *this; }

  friend MECHKIN_INLINE Mask operator<(Real a, Real b) { return is_less(a.v, b.v); }
  friend MECHKIN_INLINE Mask operator<=(Real a, Real b) { return is_at_most(a.v, b.v); }
  friend MECHKIN_INLINE Mask operator>(Real a, Real b) { return is_less(b.v, a.v); }
  friend MECHKIN_INLINE Mask operator>=(Real a, Real b) { return is_at_most(b.v, a.v); }
  friend MECHKIN_INLINE Mask operator==(Real a, Real b) { return is_equal(a.v, b.v); }
};

MECHKIN_INLINE Real load(const double* p) {
  Doubles v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
MECHKIN_INLINE void store(double* p, Real x) { std::memcpy(p, &x.v, sizeof x.v); }
MECHKIN_INLINE double lane(Real x, int i) { return x.v[i]; }

// c ? a : b, lane by lane.
MECHKIN_INLINE Real select(Mask c, Real a, Real b) { return choose(c, a.v, b.v); }
MECHKIN_INLINE Real abs(Real a) { return (Doubles)((Words)a.v & (Words{} + INT64_MAX)); }
// Of a number and NaN the second argument: what compilers know as one instruction.
MECHKIN_INLINE Real max(Real a, Real b) { return a.v > b.v ? a.v : b.v; }
MECHKIN_INLINE Real min(Real a, Real b) { return a.v < b.v ? a.v : b.v; }
// The bits of each lane as an integer, and back.
MECHKIN_INLINE Words bits(Real a) { return (Words)a.v; }
MECHKIN_INLINE Real from_bits(Words w) { return (Doubles)w; }
// Sum and difference of the bits' integers, which wrap.
MECHKIN_INLINE Words plus(Words a, Words b) { return (Words)((Naturals)a + (Naturals)b); }
MECHKIN_INLINE Words minus(Words a, Words b) { return (Words)((Naturals)a - (Naturals)b); }
MECHKIN_INLINE Words shift_left(Words w, int count) { return (Words)((Naturals)w << count); }
// Logical shift: the only right shift of 64-bit lanes that every instruction set has.
MECHKIN_INLINE Words shift_right(Words w, int count) {
  return (Words)((Naturals)w >> count);
}
// 1.5 * 2^52: adding it rounds to the nearest integer and leaves that integer in the lowest bits.
constexpr double ROUNDER = 0x1.8p52;
// For |a| < 2^51, ties to even.
MECHKIN_INLINE Real nearest_integer(Real a) { return (a + Real(ROUNDER)) - Real(ROUNDER); }
// |a| with the sign of b.
MECHKIN_INLINE Real copysign(Real a, Real b) {
  const Words sign = Words{} + INT64_MIN;
  return (Doubles)(((Words)a.v & ~sign) | ((Words)b.v & sign));
}
// Correctly rounded; the loop becomes one vector instruction.
MECHKIN_INLINE Real sqrt(Real a) {
  Doubles r;
  for (int i = 0; i < LANES; ++i) r[i] = __builtin_sqrt(a.v[i]);
  return r;
}

}  // namespace
