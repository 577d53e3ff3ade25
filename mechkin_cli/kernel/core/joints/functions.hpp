// Functions of coordinates (plan/functions.hpp) in the unit's arithmetic.
#pragma once

#include "joints/tree_joints.hpp"

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
    knots_at(curve, p.function_knot, r[curve.over], r + f.arguments + FUNCTION_ORDERS * (c - f.curve_begin));
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


// The course of a joint along a curve or over a surface, up to an order of its derivatives, at states q.
inline void find_course(const Plan& p, const TreeJoint& j, const Pack* q, int order, Pack* registers, Course* c) {
  if (j.function < 0) return;
  const Function& f = p.functions.function[j.function];
  for (int i = 0; i < f.arguments; ++i) registers[i] = q[j.state + i];
  run_function(p, f, order, registers);
  const Pack unit = j.pitch;
  const auto vector = [&](int k) -> Vec3 {
    return {unit * function_output(p, f, k, registers), unit * function_output(p, f, k + 1, registers),
            unit * function_output(p, f, k + 2, registers)};
  };
  const int n = f.arguments;
  c->place = vector(0);
  for (int i = 0; i < n; ++i) c->slope[i] = vector(3 * (1 + i));
  for (int i = 0; i < 2 * n - 1 && order > 1; ++i) c->bend[i] = vector(3 * (1 + n + i));
  for (int i = 0; i < 3 * n - 2 && order > 2; ++i) c->third[i] = vector(3 * (3 * n + i));
}

}  // namespace
