// The replay of a tape with derivatives: every register is a number that moves with the first input, with its first and
// second derivative. Sums, products (Leibniz), quotients and functions (Faa di Bruno) are exact; nothing is differenced.
// Source: A. Griewank and A. Walther, Evaluating Derivatives, chapter 13.
//
// A *switch* is an instruction that chooses (a magnitude, the larger of two, a comparison, a rounding). Between two
// kinks each of them goes one way, which is given: at a kink itself rounding would choose either.
#pragma once

#include "tape/tape_replay.hpp"

namespace {

struct Jet {
  Pack value, first, second;
};

MECHKIN_INLINE Jet operator+(Jet a, Jet b) { return {a.value + b.value, a.first + b.first, a.second + b.second}; }
MECHKIN_INLINE Jet operator-(Jet a, Jet b) { return {a.value - b.value, a.first - b.first, a.second - b.second}; }
MECHKIN_INLINE Jet operator-(Jet a) { return {-a.value, -a.first, -a.second}; }
MECHKIN_INLINE Jet operator*(Jet a, Jet b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          (a.second * b.value + a.value * b.second) + Pack(2.0) * (a.first * b.first)};
}
MECHKIN_INLINE Jet operator/(Jet a, Jet b) {
  const Pack q = a.value / b.value, first = (a.first - q * b.first) / b.value;
  return {q, first, (a.second - Pack(2.0) * (first * b.first) - q * b.second) / b.value};
}

// f(a) from f, f' and f''; what stands still needs no derivative of f.
MECHKIN_INLINE Jet through(Jet a, Pack value, Pack slope, Pack bend) {
  const Mask still = (a.first == Pack(0.0)) & (a.second == Pack(0.0));
  const Pack zero = 0.0;
  return {value, select(still, zero, slope * a.first), select(still, zero, bend * (a.first * a.first) + slope * a.second)};
}

MECHKIN_INLINE Jet square_root(Jet a) {
  const Pack root = sqrt(a.value), slope = Pack(0.5) / root;
  return through(a, root, slope, Pack(-0.5) * slope / a.value);
}

MECHKIN_INLINE Jet arc_sine(Jet a, Pack value, double sign) {
  const Pack slope = Pack(sign) / sqrt((Pack(1.0) - a.value) * (Pack(1.0) + a.value));
  return through(a, value, slope, a.value * (slope * slope * slope));
}

// atan2(y, x): its rate is (x y' - y x') / (x^2 + y^2).
MECHKIN_INLINE Jet angle_of(Jet y, Jet x) {
  const Pack square = x.value * x.value + y.value * y.value;
  const Pack turning = x.value * y.first - y.value * x.first;
  const Pack rate = turning / square;
  const Pack more = x.value * y.second - y.value * x.second;
  const Pack growing = Pack(2.0) * (x.value * x.first + y.value * y.first);
  return {apart::atan2(y.value, x.value), rate, (more - rate * growing) / square};
}

MECHKIN_INLINE Jet power_of(Jet x, Jet n) {
  const Pack value = apart::pow(x.value, n.value), one = 1.0;
  const Mask fixed = (n.first == Pack(0.0)) & (n.second == Pack(0.0));
  // a factor that is zero leaves nothing, whatever the base
  const Pack zero = 0.0, lower = n.value * (n.value - one);
  const Pack slope = select(n.value == zero, zero, n.value * apart::pow(x.value, n.value - one));
  const Pack bend = select(lower == zero, zero, lower * apart::pow(x.value, n.value - Pack(2.0)));
  const Jet constant = through(x, value, slope, bend);
  const Pack inverse = one / x.value;
  const Jet exponent = n * through(x, apart::log(x.value), inverse, -(inverse * inverse));
  const Jet moving = through(exponent, value, value, value);
  return {value, select(fixed, constant.first, moving.first), select(fixed, constant.second, moving.second)};
}

MECHKIN_INLINE bool is_switch(int operation) {
  return operation == TAPE_MAGNITUDE || operation == TAPE_SIGN || operation == TAPE_LARGER || operation == TAPE_SMALLER ||
         (operation >= TAPE_LESS && operation <= TAPE_WHOLE);
}

MECHKIN_INLINE Jet switched(int operation, Jet a, Jet b, double way) {
  const Pack zero = 0.0;
  switch (operation) {
    case TAPE_MAGNITUDE: return way < 0.0 ? -a : a;
    case TAPE_LARGER: case TAPE_SMALLER: return way != 0.0 ? b : a;
    case TAPE_POWER_OF_TWO: return {next_power_of_two(a.value), zero, zero};
    default: return {Pack(way), zero, zero};
  }
}

MECHKIN_INLINE Jet smooth(int operation, Jet a, Jet b, Jet c) {
  const Pack one = 1.0;
  switch (operation) {
    case TAPE_ADD: return a + b;
    case TAPE_SUBTRACT: return a - b;
    case TAPE_MULTIPLY: return a * b;
    case TAPE_DIVIDE: return a / b;
    case TAPE_NEGATE: return -a;
    case TAPE_SQUARE_ROOT: return square_root(a);
    case TAPE_CHOOSE: {
      const Mask other = a.value == Pack(0.0);
      return {select(other, c.value, b.value), select(other, c.first, b.first), select(other, c.second, b.second)};
    }
    case TAPE_SIN: { const Pack s = apart::sin(a.value); return through(a, s, apart::cos(a.value), -s); }
    case TAPE_COS: { const Pack k = apart::cos(a.value); return through(a, k, -apart::sin(a.value), -k); }
    case TAPE_TAN: {
      const Pack t = apart::tan(a.value), slope = one + t * t;
      return through(a, t, slope, Pack(2.0) * t * slope);
    }
    case TAPE_ASIN: return arc_sine(a, apart::asin(a.value), 1.0);
    case TAPE_ACOS: return arc_sine(a, apart::acos(a.value), -1.0);
    case TAPE_ATAN: {
      const Pack slope = one / (one + a.value * a.value);
      return through(a, apart::atan(a.value), slope, Pack(-2.0) * a.value * (slope * slope));
    }
    case TAPE_ATAN2: return angle_of(a, b);
    case TAPE_EXP: { const Pack e = apart::exp(a.value); return through(a, e, e, e); }
    case TAPE_LOG: { const Pack slope = one / a.value; return through(a, apart::log(a.value), slope, -(slope * slope)); }
    case TAPE_POWER: return power_of(a, b);
    default: return {Pack(__builtin_nan("")), Pack(0.0), Pack(0.0)};
  }
}

long jets_size(const Tape& t) { return (long)sizeof(Jet) * t.registers() + 64; }

// `given` (inputs), of which the first moves; `way` (switches, in the tape's order); `out` (outputs x 3).
void replay_jets(const Tape& t, const double* given, const double* way, double* out, char* memory) {
  Jet* const r = (Jet*)(memory + (64 - (std::uintptr_t)memory % 64) % 64);
  const Pack zero = 0.0;
  for (int k = 0; k < t.inputs; ++k) r[k] = {Pack(given[k]), k ? zero : Pack(1.0), zero};
  for (int c = 0; c < t.constants; ++c) r[t.inputs + c] = {Pack(t.constant[c]), zero, zero};
  Jet* const result = r + t.inputs + t.constants;
  const std::int32_t* o = t.operand;
  for (int i = 0; i < t.instructions; ++i, o += 3) {
    const int operation = t.operation[i];
    result[i] = is_switch(operation) ? switched(operation, r[o[0]], r[o[1]], *way++)
                                     : smooth(operation, r[o[0]], r[o[1]], r[o[2]]);
  }
  for (int k = 0; k < t.outputs; ++k) {
    const Jet& j = r[t.output[k]];
    out[3 * k] = ((const double*)&j.value)[0];
    out[3 * k + 1] = ((const double*)&j.first)[0];
    out[3 * k + 2] = ((const double*)&j.second)[0];
  }
}

}  // namespace
