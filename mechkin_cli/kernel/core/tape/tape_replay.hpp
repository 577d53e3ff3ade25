// The replay of a tape in lanes: one set of inputs per lane, every operation the IEEE one or the kernel's own.
#pragma once

#include "arithmetic/elementary_apart.hpp"
#include "tape/tape.hpp"

namespace {

MECHKIN_INLINE Pack as_number(Mask m) { return select(m, Pack(1.0), Pack(0.0)); }

// 2^n with a / 2^n in (0.7, 1.4]; nan where a is not a positive number.
MECHKIN_INLINE Real next_power_of_two(Real a) {
  // numbers below the normal range are scaled into it first
  const Mask tiny = a < Real(0x1p-1000);
  const Real x = select(tiny, a * Real(0x1p600), a);
  const Words exponent = bits(x) & (Words{} + 0x7ff0000000000000);
  const Real below = from_bits(exponent);  // 2^(e-1) for x = m 2^e
  const Real mantissa = from_bits((bits(x) & (Words{} + 0x000fffffffffffff)) | (Words{} + 0x3fe0000000000000));
  const Real power = select(mantissa > Real(0.7), below + below, below);
  const Mask proper = (a > Real(0.0)) & (a < Real(__builtin_inf()));
  return select(proper, select(tiny, power * Real(0x1p-600), power), Real(__builtin_nan("")));
}

MECHKIN_INLINE Mask tape_condition(int operation, Pack a, Pack b) {
  return operation == TAPE_LESS ? a < b : operation == TAPE_NOT_MORE ? a <= b : a == b;
}

void replay_pack(const Tape& t, Pack* r) {
  Pack* result = r + t.inputs + t.constants;
  const std::int32_t* o = t.operand;
  for (int i = 0; i < t.instructions; ++i, o += 3) {
    const Pack a = r[o[0]], b = r[o[1]];
    switch (t.operation[i]) {
      case TAPE_ADD: result[i] = a + b; break;
      case TAPE_SUBTRACT: result[i] = a - b; break;
      case TAPE_MULTIPLY: result[i] = a * b; break;
      case TAPE_DIVIDE: result[i] = a / b; break;
      case TAPE_NEGATE: result[i] = -a; break;
      case TAPE_MAGNITUDE: result[i] = abs(a); break;
      case TAPE_SQUARE_ROOT: result[i] = sqrt(a); break;
      case TAPE_LARGER: result[i] = select(b > a, b, a); break;
      case TAPE_SMALLER: result[i] = select(b < a, b, a); break;
      case TAPE_CHOOSE: result[i] = select(a == Pack(0.0), r[o[2]], b); break;
      case TAPE_LESS: result[i] = as_number(a < b); break;
      case TAPE_NOT_MORE: result[i] = as_number(a <= b); break;
      case TAPE_EQUAL: result[i] = as_number(a == b); break;
      case TAPE_POWER_OF_TWO: result[i] = next_power_of_two(part_of(a, 0)); break;
      case TAPE_WHOLE: result[i] = nearest_integer(a); break;
      case TAPE_SIN: result[i] = apart::sin(a); break;
      case TAPE_COS: result[i] = apart::cos(a); break;
      case TAPE_TAN: result[i] = apart::tan(a); break;
      case TAPE_ASIN: result[i] = apart::asin(a); break;
      case TAPE_ACOS: result[i] = apart::acos(a); break;
      case TAPE_ATAN: result[i] = apart::atan(a); break;
      case TAPE_ATAN2: result[i] = apart::atan2(a, b); break;
      case TAPE_EXP: result[i] = apart::exp(a); break;
      case TAPE_LOG: result[i] = apart::log(a); break;
      case TAPE_POWER: result[i] = apart::pow(a, b); break;
      case TAPE_SIGN: result[i] = select(a > Pack(0.0), Pack(1.0), select(a < Pack(0.0), Pack(-1.0), a)); break;
      default: result[i] = Pack(__builtin_nan("")); break;
    }
  }
}

inline long replay_size(const Tape& t) { return (long)sizeof(Pack) * t.registers() + 64; }

// Lanes beyond the last set of inputs repeat it.
inline void replay(const Tape& t, const TapeRequest& request, char* memory) {
  Pack* const r = (Pack*)(memory + (64 - (std::uintptr_t)memory % 64) % 64);
  for (int c = 0; c < t.constants; ++c) {
    const Real part[2] = {t.constant[c], request.second ? request.second[c] : 0.0};
    r[t.inputs + c] = from_parts(part);
  }
  for (long first = 0; first < request.count; first += LANES) {
    const int count = request.count - first < LANES ? (int)(request.count - first) : LANES;
    for (int k = 0; k < t.inputs; ++k) {
      Real part[PARTS];
      for (int n = 0; n < PARTS; ++n) {
        const double* const from = request.inputs + (PARTS * k + n) * request.count + first;
        double values[LANES];
        for (int i = 0; i < LANES; ++i) values[i] = from[i < count ? i : count - 1];
        part[n] = load(values);
      }
      r[k] = from_parts(part);
    }
    replay_pack(t, r);
    Mask same = all_lanes(true), advised = all_lanes(true);
    for (int g = 0; g < t.guards; ++g) {
      const std::int32_t* const guard = t.guard + 3 * g;
      const Mask found = tape_condition(guard[0], r[guard[1]], r[guard[2]]);
      Mask& holds = t.advice[g] ? advised : same;
      holds = holds & (t.expected[g] ? found : ~found);
    }
    for (int i = 0; i < count; ++i) {
      double* const out = request.outputs + (first + i) * t.outputs * PARTS;
      for (int k = 0; k < t.outputs; ++k)
        for (int n = 0; n < PARTS; ++n) out[PARTS * k + n] = ((const double*)(r + t.output[k]))[n * LANES + i];
      request.verdict[first + i] = !lane(same, i) ? TAPE_OTHER_WAY : lane(advised, i) ? TAPE_SAME : TAPE_OTHER_ADVICE;
    }
  }
}

}  // namespace
