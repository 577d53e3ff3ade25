// What programs of quantities read of a row, and their curves and constants, into their first registers. A `RowValue` as in
// quantity_program.hpp.
#pragma once

#include "rows/outputs.hpp"
#include "tape/tape.hpp"

#if MECHKIN_ENCLOSES
#include "forces/enclosed_curve.hpp"
#else
#include "forces/program_curve.hpp"
#endif

namespace {

// The tape of a program's instructions.
template <class Number>
inline Tape instructions_of(const ProgramOf<Number>& program) {
  Tape t = {};
  t.inputs = program.inputs, t.constants = program.constants, t.instructions = program.instructions;
  t.operation = program.operation, t.operand = program.operand;
  return t;
}

// The registers of reads, curves and constants; the reads' quantities are those that the workspace holds by then.
template <class Number, class RowValue>
inline void read_program(const Plan& p, const Workspace& w, const ProgramOf<Number>& program, const RowValue& row_value,
                        Pack* r) {
  for (int k = 0; k < program.reads; ++k) {
    const ReadOf<Number>& read = program.read[k];
    Pack* const at = r + read.output.slot;
    if (read.kind == READ_TIME) {
      *at = row_value.time();
      continue;
    }
    output_value(p, w, nullptr, row_value, read.output, at);
    if (read.kind != READ_ANGLE) continue;
    at[1] = at[0];
    at[0] = read.turn < -1 ? row_value.input(-2 - read.turn, Pack(read.output.factor), at[1])
                           : row_value.turned(read.turn, read.output.type == OUT_CLOSING, at[1]);
  }
  Pack* const curve = r + program.inputs - program.curves;
  for (int c = 0; c < program.curves; ++c)
    curve[c] = curve_value(program.curve[c], program.knot, r[program.curve[c].over]);
  for (int c = 0; c < program.constants; ++c) r[program.inputs + c] = Pack(program.constant[c]);
}

}  // namespace
