// The operations of a tape over intervals: where an instruction chooses, all that it may choose is kept.
#pragma once

#include "arithmetic/elementary_apart.hpp"
#include "tape/tape.hpp"

namespace {

// Zero, or no number where nothing is known: added to what is found of an interval otherwise than by arithmetic.
MECHKIN_INLINE Real knowledge(const Interval& a) {
  const Real low = a.midpoint.low, rest = a.radius - a.radius;
  return (a.midpoint.high - a.midpoint.high) + (low - low) + rest;
}
MECHKIN_INLINE Interval if_known(const Interval& found, const Interval& a, const Interval& b) {
  return {found.midpoint, found.radius + knowledge(a) + knowledge(b)};
}
// An interval for each lane: 1 where it must be, 0 where it cannot, else both.
MECHKIN_INLINE Interval truth(Mask must, Mask cannot) {
  const Real one = 1.0, none = 0.0, half = 0.5;
  return {select(must, one, select(cannot, none, half)), select(must | cannot, none, half)};
}

MECHKIN_INLINE Interval chosen(Mask first, const Interval& a, const Interval& b) {
  return {select(first, a.midpoint, b.midpoint), select(first, a.radius, b.radius)};
}
MECHKIN_INLINE Interval larger(Interval a, Interval b) {
  const Real la = lower(a), lb = lower(b), ua = upper(a), ub = upper(b);
  const Interval either = chosen(la > ub, a, between(max(la, lb), max(ua, ub)));
  return if_known(chosen(lb > ua, b, either), a, b);
}
MECHKIN_INLINE Interval less(Interval a, Interval b) {
  return if_known(truth(upper(a) < lower(b), lower(a) >= upper(b)), a, b);
}
MECHKIN_INLINE Interval not_more(Interval a, Interval b) {
  return if_known(truth(upper(a) <= lower(b), lower(a) > upper(b)), a, b);
}
MECHKIN_INLINE Interval equal(Interval a, Interval b) {
  const Mask points = (a.radius == Real(0.0)) & (b.radius == Real(0.0)) & (a.midpoint == b.midpoint);
  return if_known(truth(points, (upper(a) < lower(b)) | (upper(b) < lower(a))), a, b);
}
MECHKIN_INLINE Interval sign(Interval a) {
  const Interval zero = 0.0;
  return less(zero, a) - less(a, zero);
}
// b where a is not zero, else c.
MECHKIN_INLINE Interval choose(Interval a, Interval b, Interval c) {
  const Interval is_zero = equal(a, Interval(0.0)), either = hull(b, c);
  const Mask zero = is_zero.midpoint.high == Real(1.0), other = is_zero.midpoint.high == Real(0.0);
  return if_known(chosen(zero, c, chosen(other, b, either)), a, a);
}
MECHKIN_INLINE Interval whole(Interval a) {
  return if_known(between(nearest_integer(lower(a)), nearest_integer(upper(a))), a, a);
}

inline Interval enclosed_result(int operation, Interval a, Interval b, Interval c) {
  switch (operation) {
    case TAPE_ADD: return a + b;
    case TAPE_SUBTRACT: return a - b;
    case TAPE_MULTIPLY: return a * b;
    case TAPE_DIVIDE: return a / b;
    case TAPE_NEGATE: return -a;
    case TAPE_MAGNITUDE: return abs(a);
    case TAPE_SQUARE_ROOT: return sqrt(a);
    case TAPE_LARGER: return larger(a, b);
    case TAPE_SMALLER: return -larger(-a, -b);
    case TAPE_CHOOSE: return choose(a, b, c);
    case TAPE_LESS: return less(a, b);
    case TAPE_NOT_MORE: return not_more(a, b);
    case TAPE_EQUAL: return equal(a, b);
    case TAPE_WHOLE: return whole(a);
    case TAPE_SIN: return apart::sin(a);
    case TAPE_COS: return apart::cos(a);
    case TAPE_TAN: return apart::tan(a);
    case TAPE_ASIN: return apart::asin(a);
    case TAPE_ACOS: return apart::acos(a);
    case TAPE_ATAN: return apart::atan(a);
    case TAPE_ATAN2: return principal_angle(a, b);
    case TAPE_EXP: return apart::exp(a);
    case TAPE_LOG: return apart::log(a);
    case TAPE_POWER: return apart::pow(a, b);
    case TAPE_SIGN: return sign(a);
    default: return Interval(__builtin_nan(""));
  }
}

inline void replay_pack(const Tape& t, Pack* r) {
  Pack* const result = r + t.inputs + t.constants;
  for (int i = 0; i < t.instructions; ++i) {
    const std::int32_t* const o = t.operand + 3 * i;
    result[i] = enclosed_result(t.operation[i], r[o[0]], r[o[1]], r[o[2]]);
  }
}

}  // namespace
