// The operations of a tape over Taylor models. Where an instruction chooses by what is not certain over all of a curve, a
// model of both holds all that it may choose; a function that has no value somewhere gives a radius that no proof accepts.
#pragma once

#include "arithmetic/elementary.hpp"
#include "arithmetic/exponential.hpp"
#include "tape/tape.hpp"

namespace {

MECHKIN_INLINE Real upper_bound(const Taylor& a) { return -lower_bound(-a); }

MECHKIN_MODEL Taylor chosen(Mask first, const Taylor& a, const Taylor& b) {
  Taylor r;
  for (int k = 0; k <= ORDER; ++k) r.c[k] = select(first, a.c[k], b.c[k]);
  r.radius = select(first, a.radius, b.radius);
  return r;
}
MECHKIN_MODEL Taylor hull(const Taylor& a, const Taylor& b) {
  return widened(scaled(Real(0.5), a + b), bound(scaled(Real(0.5), a - b)));
}
// 1 where it must be, 0 where it cannot, else anything between.
MECHKIN_INLINE Taylor truth(Mask must, Mask cannot) {
  const Real one = 1.0, none = 0.0, half = 0.5;
  return {select(must, one, select(cannot, none, half)), select(must | cannot, none, half)};
}
// Zero, or no number where nothing is known.
MECHKIN_INLINE Real knowledge(const Taylor& a) { return bound(a) - bound(a); }
MECHKIN_INLINE Taylor if_known(const Taylor& found, const Taylor& a, const Taylor& b) {
  return widened(found, knowledge(a) + knowledge(b));
}
MECHKIN_MODEL Taylor less(const Taylor& a, const Taylor& b) {
  return if_known(truth(upper_bound(a) < lower_bound(b), lower_bound(a) >= upper_bound(b)), a, b);
}
MECHKIN_MODEL Taylor not_more(const Taylor& a, const Taylor& b) {
  return if_known(truth(upper_bound(a) <= lower_bound(b), lower_bound(a) > upper_bound(b)), a, b);
}
MECHKIN_MODEL Taylor equal(const Taylor& a, const Taylor& b) {
  return if_known(truth(all_lanes(false), (upper_bound(a) < lower_bound(b)) | (upper_bound(b) < lower_bound(a))), a, b);
}
// b where a is not zero, else c.
MECHKIN_MODEL Taylor choose(const Taylor& a, const Taylor& b, const Taylor& c) {
  const Real zero = 0.0;
  const Mask other = (lower_bound(a) > zero) | (upper_bound(a) < zero), none = bound(a) == zero;
  return if_known(chosen(other, b, chosen(none, c, hull(b, c))), a, a);
}
MECHKIN_MODEL Taylor larger(const Taylor& a, const Taylor& b) {
  const Mask first = lower_bound(a) >= upper_bound(b), second = lower_bound(b) >= upper_bound(a);
  return if_known(chosen(first, a, chosen(second, b, hull(a, b))), a, b);
}
MECHKIN_MODEL Taylor whole(const Taylor& a) {
  const Real low = nearest_integer(lower_bound(a)), high = nearest_integer(upper_bound(a));
  return {Real(0.5) * (low + high), Real(0.5) * (high - low)};
}
MECHKIN_MODEL Taylor sign(const Taylor& a) { return less(Taylor(0.0), a) - less(a, Taylor(0.0)); }

// Of coefficients below 1 that were rounded, and of the doubles' functions, which are off by less.
constexpr double SERIES_ERROR = 0x1p-49;

// exp(m + e) = exp m exp e; behind order K the series of exp e is at most e^(K+1) / (K+1)! exp e, and exp e < 3 for e <= 1.
MECHKIN_MODEL Taylor exponential(const Taylor& x) {
  Taylor e = x;
  e.c[0] = 0.0;
  double series[ORDER + 2];
  series[0] = 1.0;
  for (int k = 1; k <= ORDER + 1; ++k) series[k] = series[k - 1] / k;
  const Real size = bound(e), value = exp(x.c[0]);
  const Real rest = Real(3.0 * series[ORDER + 1]) * next_power(size) + Real(8.0 * SERIES_ERROR);
  const Taylor known = {value, Real(SERIES_ERROR) * value};
  return known * widened(power_series(series, e), select(size <= Real(1.0), rest, Real(__builtin_inf())));
}
// log(m (1 + e)) = log m + e - e^2 / 2 + ...
MECHKIN_MODEL Taylor logarithm(const Taylor& x) {
  double series[ORDER + 1];
  series[0] = 0.0;
  for (int k = 1; k <= ORDER; ++k) series[k] = (k % 2 ? 1.0 : -1.0) / k;
  const Taylor e = scaled(Real(1.0) / x.c[0], x) - Taylor(1.0);
  const Real value = log(x.c[0]);
  // 1 / m was rounded, too
  const Real off = Real(SERIES_ERROR) * abs(value) + Real(8.0 * SERIES_ERROR);
  const Real rest = select(lower_bound(x) > Real(0.0), geometric_rest(bound(e)) + off, Real(__builtin_inf()));
  return widened(Taylor(value) + power_series(series, e), rest);
}
// x^n of a whole exponent by products, else exp(n log x).
MECHKIN_MODEL Taylor modelled_power(const Taylor& x, const Taylor& n) {
  const double exponent = lane(n.c[0], 0);
  const bool fixed = lane(bound(n - Taylor(exponent)), 0) == 0.0 && lane(bound(n - Taylor(exponent)), LANES - 1) == 0.0;
  const int whole = fixed && exponent >= 0.0 && exponent <= 64.0 ? (int)exponent : -1;
  if (whole < 0 || whole != exponent) return exponential(n * logarithm(x));
  Taylor power = 1.0;
  for (int k = 0; k < whole; ++k) power *= x;
  return power;
}

MECHKIN_MODEL Taylor modelled_turn(int operation, const Taylor& a) {
  Taylor s, c;
  sincos(a, s, c);
  return operation == TAPE_SIN ? s : operation == TAPE_COS ? c : s / c;
}
// By atan2, which goes on beyond its cut, where the angle of a tape is another one.
MECHKIN_MODEL Taylor modelled_arc(int operation, const Taylor& a, const Taylor& b) {
  const Taylor one = 1.0;
  if (operation == TAPE_ATAN) return atan2(a, one);
  if (operation == TAPE_ASIN) return atan2(a, sqrt((one - a) * (one + a)));
  if (operation == TAPE_ACOS) return atan2(sqrt((one - a) * (one + a)), a);
  const Real zero = 0.0;
  const Mask on_cut = (lower_bound(b) <= zero) & (lower_bound(a) <= zero) & (upper_bound(a) >= zero);
  return widened(atan2(a, b), select(on_cut, Real(__builtin_inf()), zero));
}

inline Taylor modelled_result(int operation, const Taylor& a, const Taylor& b, const Taylor& c) {
  switch (operation) {
    case TAPE_ADD: return a + b;
    case TAPE_SUBTRACT: return a - b;
    case TAPE_MULTIPLY: return a * b;
    case TAPE_DIVIDE: return a / b;
    case TAPE_NEGATE: return -a;
    case TAPE_MAGNITUDE: return larger(a, -a);
    case TAPE_SQUARE_ROOT: return sqrt(a);
    case TAPE_LARGER: return larger(a, b);
    case TAPE_SMALLER: return -larger(-a, -b);
    case TAPE_CHOOSE: return choose(a, b, c);
    case TAPE_LESS: return less(a, b);
    case TAPE_NOT_MORE: return not_more(a, b);
    case TAPE_EQUAL: return equal(a, b);
    case TAPE_WHOLE: return whole(a);
    case TAPE_SIN:
    case TAPE_COS:
    case TAPE_TAN: return modelled_turn(operation, a);
    case TAPE_ASIN:
    case TAPE_ACOS:
    case TAPE_ATAN:
    case TAPE_ATAN2: return modelled_arc(operation, a, b);
    case TAPE_EXP: return exponential(a);
    case TAPE_LOG: return logarithm(a);
    case TAPE_POWER: return modelled_power(a, b);
    case TAPE_SIGN: return sign(a);
    default: return {Real(0.0), Real(__builtin_nan(""))};
  }
}

inline void replay_pack(const Tape& t, Pack* r) {
  Pack* const result = r + t.inputs + t.constants;
  for (int i = 0; i < t.instructions; ++i) {
    const std::int32_t* const o = t.operand + 3 * i;
    result[i] = modelled_result(t.operation[i], r[o[0]], r[o[1]], r[o[2]]);
  }
}

}  // namespace
