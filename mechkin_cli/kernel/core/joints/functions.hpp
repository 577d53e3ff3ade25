// Functions of coordinates (plan/functions.hpp) in the unit's arithmetic.
#pragma once

#include "plan/plan.hpp"

#if MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
#include "tape/enclosed_tape.hpp"
#elif MECHKIN_ARITHMETIC == MECHKIN_TAYLOR
#include "tape/modelled_tape.hpp"
#else
#include "tape/tape_replay.hpp"
#endif

#if MECHKIN_ENCLOSES
#include "joints/enclosed_knots.hpp"
#else
#include "joints/knots.hpp"
#endif

namespace {

// Fills the registers of a function up to an order of its derivatives; its arguments stand in the first ones.
inline void run_function(const Plan& p, const Function& f, int order, Pack* r) {
  const FunctionTable& table = p.functions;
  for (int c = f.curve_begin; c < f.curve_end; ++c) {
    const FunctionCurve& curve = table.curve[c];
    knots_at(curve, table.knot, r[curve.over], r + f.arguments + FUNCTION_ORDERS * (c - f.curve_begin));
  }
  Tape t = {};
  t.inputs = f.constants_at(), t.constants = f.constant_end - f.constant_begin;
  t.instructions = f.instructions[order];
  t.operation = table.operation + f.instruction_begin, t.operand = table.operand + 3 * f.instruction_begin;
  for (int c = 0; c < t.constants; ++c) r[t.inputs + c] = Pack(p.function_constant[f.constant_begin + c]);
  replay_pack(t, r);
}
// Output k of a function from its registers.
MECHKIN_INLINE const Pack& function_output(const Plan& p, const Function& f, int k, const Pack* r) {
  return r[p.functions.output[f.output_begin + k]];
}

}  // namespace
