// atan2, atan, asin and acos of doubles, errors below 1.5, 0.9, 0.7 and 0.8 units in the last
// place (1.5 only where the quotient exceeds 1/4 and the angle does not; below 1.2 elsewhere).
//
// atan2: the angle from the nearer half axis, atan t with t = smaller / larger of |x|, |y|, is taken
// as atan c + atan u, u = (t - c) / (1 + c t) with c = 0, 1/2 or 1 so that |u| <= 7/16. The constants
// are from fdlibm (Sun Microsystems, 1993; s_atan.c, e_asin.c, e_acos.c).
#pragma once

#include "arithmetic/double_double.hpp"

namespace {

// c where m holds, else 0.
MECHKIN_INLINE Real where(Mask m, double c) { return from_bits(words(m) & bits(Real(c))); }

// (u - atan u) / u for |u| <= 7/16.
MECHKIN_INLINE Real atan_deficit(Real u) {
  const Real z = u * u, w = z * z;
  Real even = Real(1.62858201153657823623e-02);
  even = even * w + Real(4.97687799461593236017e-02);
  even = even * w + Real(6.66107313738753120669e-02);
  even = even * w + Real(9.09088713343650656196e-02);
  even = even * w + Real(1.42857142725034663711e-01);
  even = even * w + Real(3.33333333333329318027e-01);
  Real odd = Real(-3.65315727442169155270e-02);
  odd = odd * w + Real(-5.83357013379057348645e-02);
  odd = odd * w + Real(-7.69187620504482999495e-02);
  odd = odd * w + Real(-1.11111104054623557880e-01);
  odd = odd * w + Real(-1.99999999998764832476e-01);
  return z * (even + z * odd);
}

// Brings the pair into a range where the sums and halves of it are exact enough: both are scaled by a
// power of two; beside an infinity everything finite counts 0, and 0/0 is 0.
MECHKIN_INLINE void rescale_extremes(Real& smaller, Real& larger) {
  const Real infinity = __builtin_inf(), one = Real(1.0);
  const Real factor = select(larger < Real(0x1p-900), Real(0x1p200),
                             select(larger > Real(0x1p900), Real(0x1p-4), one));
  const Mask infinite = larger == infinity;
  const Real share = select(smaller == infinity, one, smaller * Real(0.0));
  smaller = select(infinite, share, smaller * factor);
  larger = select(infinite | (larger == Real(0.0)), one, larger * factor);
}

// Angle of (x, y) in [-pi, pi], signed zeros and infinities as in C.
MECHKIN_INLINE Real atan2(Real y, Real x) {
  const Real ax = abs(x), ay = abs(y);
  const Mask steep = ay > ax;
  Real smaller = select(steep, ax, ay), larger = select(steep, ay, ax);
  if (__builtin_expect(!all((larger > Real(0x1p-900)) & (larger < Real(0x1p900))), 0))
    rescale_extremes(smaller, larger);

  const Mask beyond_low = smaller > Real(7.0 / 16) * larger;
  const Mask beyond_high = smaller > Real(11.0 / 16) * larger;
  const Real c = where(beyond_low, 0.5) + where(beyond_high, 0.5);
  // The numerator is exact: c * larger lies within a factor 2 of smaller.
  const Real u = (smaller - c * larger) / (larger + c * smaller);

  // angle = axis +- (atan c + atan u) with axis = 0, pi/2 or pi, before the sign of y. The leading
  // parts of the constants are multiples of 2^-26, so their sum is exact; what they leave joins the
  // small term u - atan u.
  const Words sign_bit = Words{} + INT64_MIN;
  const Words flip = (bits(x) ^ words(steep)) & sign_bit;
  const Mask left = mask_of(-shift_right(bits(x), 63));
  const Real axis = select(steep, Real(0x1.921fb54000000p+0), where(left, 0x1.921fb54000000p+1));
  const Real axis_rest =
      select(steep, Real(0x1.10b4611a62633p-30), where(left, 0x1.10b4611a62633p-29));
  const Real offset =
      select(beyond_high, Real(0x1.921fb50000000p-1), where(beyond_low, 0x1.dac6700000000p-2));
  const Real offset_rest =
      select(beyond_high, Real(0x1.110b4611a6263p-27), where(beyond_low, 0x1.586ed3da2b7f2p-28));
  const Real leading = axis + from_bits(bits(offset) ^ flip);
  const Real rest = axis_rest + from_bits(bits(offset_rest) ^ flip);
  const Real turned = from_bits(bits(u) ^ flip);
  return copysign(leading + (turned - (turned * atan_deficit(u) - rest)), y);
}

MECHKIN_INLINE Real atan(Real x) { return atan2(x, Real(1.0)); }

// (asin x - x) / x with z = x^2 <= 1/4.
MECHKIN_INLINE Real asin_excess(Real z) {
  Real p = Real(3.47933107596021167570e-05);
  p = p * z + Real(7.91534994289814532176e-04);
  p = p * z + Real(-4.00555345006794114027e-02);
  p = p * z + Real(2.01212532134862925881e-01);
  p = p * z + Real(-3.25565818622400915405e-01);
  p = p * z + Real(1.66666666666666657415e-01);
  Real q = Real(7.70381505559019352791e-02);
  q = q * z + Real(-6.88283971605453293030e-01);
  q = q * z + Real(2.02094576023350569471e+00);
  q = q * z + Real(-2.40339491173441421878e+00);
  q = q * z + Real(1.0);
  return z * p / q;
}

constexpr double HALF_PI_HIGH = 0x1.921fb54442d18p+0, HALF_PI_LOW = 0x1.1a62633145c07p-54;

// acos |x| = 2 asin sqrt((1 - |x|) / 2) for |x| >= 1/2, as an unrounded sum; NaN beyond 1.
MECHKIN_INLINE DoubleDouble acos_near_one(Real x) {
  const Real z = Real(0.5) * (Real(1.0) - abs(x));
  const Real root = sqrt(z);
  const DoubleDouble square = two_product(root, root);
  const Real doubled = root + root;
  const Real correction =
      ((z - square.high) - square.low) / select(root == Real(0.0), Real(1.0), doubled);
  const Real low = correction + root * asin_excess(z);
  return {doubled, low + low};
}

// In [-pi/2, pi/2]; NaN for |x| > 1.
MECHKIN_INLINE Real asin(Real x) {
  const Real near_zero = x + x * asin_excess(x * x);
  const DoubleDouble rest = acos_near_one(x);
  const DoubleDouble sum = fast_two_sum(Real(HALF_PI_HIGH), -rest.high);
  const Real near_one = sum.high + (sum.low + (Real(HALF_PI_LOW) - rest.low));
  return select(abs(x) < Real(0.5), near_zero, copysign(near_one, x));
}

// In [0, pi]; NaN for |x| > 1.
MECHKIN_INLINE Real acos(Real x) {
  const Real near_zero =
      Real(HALF_PI_HIGH) - (x - (Real(HALF_PI_LOW) - x * asin_excess(x * x)));
  const DoubleDouble rest = acos_near_one(x);
  const DoubleDouble sum = fast_two_sum(Real(2.0 * HALF_PI_HIGH), -rest.high);
  const Real near_minus_one = sum.high + (sum.low + (Real(2.0 * HALF_PI_LOW) - rest.low));
  const Real near_one = rest.high + rest.low;
  return select(abs(x) < Real(0.5), near_zero,
                select(x < Real(0.0), near_minus_one, near_one));
}

}  // namespace
