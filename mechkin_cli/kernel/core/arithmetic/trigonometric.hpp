// sin, cos and tan of doubles, errors below 0.8, 0.8 and 0.9 units in the last place for all finite x.
//
// On |r| <= pi/4 with the minimax coefficients of fdlibm (Sun Microsystems, 1993; k_sin.c, k_cos.c):
// sin r = r + r^3 S(r^2), cos r = 1 - r^2/2 + r^4 C(r^2), to which the tail of the reduced angle is
// added to first order.
#pragma once

#include "arithmetic/angle_reduction.hpp"
#include "arithmetic/double_double.hpp"

namespace {

// sin and cos of a reduced angle as unevaluated sums; |small| <= |big| / 2.
struct SinCosParts {
  Real sin_big, sin_small, cos_big, cos_small;
};

MECHKIN_INLINE SinCosParts sincos_parts(const ReducedAngle& angle) {
  const Real r = angle.r, z = r * r;
  const Real half = Real(0.5) * z, big = Real(1.0) - half;

  Real s = Real(-1.58969099521155010221e-10);
  s = s * z + Real(2.50507602534068634195e-08);
  s = s * z + Real(-2.75573137070700676789e-06);
  s = s * z + Real(1.98412698298579493134e-04);
  s = s * z + Real(-8.33333333332248946124e-03);
  s = s * z + Real(1.66666666666666324348e-01);

  Real c = Real(-1.13596475577881948265e-11);
  c = c * z + Real(2.08757232129817482790e-09);
  c = c * z + Real(-2.75573143513906633035e-07);
  c = c * z + Real(2.48015872894767294178e-05);
  c = c * z + Real(-1.38888888888741095749e-03);
  c = c * z + Real(4.16666666666666019037e-02);

  return {r, (z * r) * s + angle.tail * big, big,
          ((Real(1.0) - big) - half) + ((z * z) * c + r * angle.tail)};
}

MECHKIN_INLINE void sincos(Real x, Real& s, Real& c) {
  const ReducedAngle angle = reduce_angle(x);
  const SinCosParts parts = sincos_parts(angle);
  const Words sine = bits(parts.sin_big - parts.sin_small);
  const Words cosine = bits(parts.cos_big + parts.cos_small);
  const Words q = angle.quadrant, one = Words{} + 1, two = Words{} + 2;
  const Words exchanged = (sine ^ cosine) & -(q & one);
  s = from_bits(sine ^ exchanged ^ ((q & two) << 62));
  c = from_bits(cosine ^ exchanged ^ (((q + one) & two) << 62));
}

MECHKIN_INLINE Real sin(Real x) {
  Real s, c;
  sincos(x, s, c);
  return s;
}

MECHKIN_INLINE Real cos(Real x) {
  Real s, c;
  sincos(x, s, c);
  return c;
}

// sin / cos, or -cos / sin in odd quadrants, of the unrounded parts; the quotient is corrected by its
// remainder.
MECHKIN_INLINE Real tan(Real x) {
  const ReducedAngle angle = reduce_angle(x);
  const SinCosParts parts = sincos_parts(angle);
  const DoubleDouble sine = fast_two_sum(parts.sin_big, -parts.sin_small);
  const DoubleDouble cosine = fast_two_sum(parts.cos_big, parts.cos_small);
  const Mask odd = mask_of(-(angle.quadrant & (Words{} + 1)));
  const DoubleDouble above = {select(odd, -cosine.high, sine.high),
                              select(odd, -cosine.low, sine.low)};
  const DoubleDouble below = {select(odd, sine.high, cosine.high),
                              select(odd, sine.low, cosine.low)};
  const Real quotient = above.high / below.high;
  const DoubleDouble back = two_product(quotient, below.high);
  const Real remainder = ((above.high - back.high) - back.low) + (above.low - quotient * below.low);
  // below 1e-8 tan x = x to rounding, and the products above would underflow
  return select(abs(x) < Real(1e-8), x, quotient + remainder / below.high);
}

}  // namespace
