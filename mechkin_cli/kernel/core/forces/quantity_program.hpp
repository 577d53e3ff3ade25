// Programs of quantities: values of loads that vary, and other numbers that follow from positions, rates and time, for a
// pack of rows. What they compute is recorded where the file is built (plan/programs.py).
//
// A `RowValue` says what the workspace does not hold: `time()`, `turned(turn, closing, angle)` an angle with its whole
// turns (LoadOf::turn), and `input(number, factor, angle)` an input with them, of which `angle` is the part within one.
#pragma once

#include "forces/program_reads.hpp"
#include "tape/tape_replay.hpp"

namespace {

// Fills `r` (program.registers()).
template <class Number, class RowValue>
inline void run_program(const Plan& p, const Workspace& w, const ProgramOf<Number>& program, const RowValue& row_value,
                        Pack* r) {
  read_program(p, w, program, row_value, r);
  replay_pack(instructions_of(program), r);
}

// What changes its sign where kink k of a program is passed, from the registers of a run: the argument of a magnitude or a sign,
// the difference of two of which the larger or smaller is taken, and of a rounding the cosine of half its turns.
template <class Number>
inline Pack kink_value(const ProgramOf<Number>& program, int k, const Pack* r) {
  const int instruction = program.kink[k];
  const std::int32_t* const o = program.operand + 3 * instruction;
  switch (program.operation[instruction]) {
    case TAPE_MAGNITUDE:
    case TAPE_SIGN: return r[o[0]];
    case TAPE_WHOLE: return cos(Pack(0.5) * Pack(FULL_TURN) * r[o[0]]);
    default: return r[o[0]] - r[o[1]];
  }
}

// The result of kink k on a side of it, +1 or -1: as on that side also beyond it.
template <class Number>
inline Pack value_on_side(const ProgramOf<Number>& program, int k, Pack side, const Pack* r) {
  const int instruction = program.kink[k];
  const std::int32_t* const o = program.operand + 3 * instruction;
  const Mask up = side > Pack(0.0);
  switch (program.operation[instruction]) {
    case TAPE_MAGNITUDE: return side * r[o[0]];
    case TAPE_SIGN: return select(up, Pack(1.0), Pack(-1.0));
    case TAPE_LARGER: return select(up, r[o[0]], r[o[1]]);
    case TAPE_SMALLER: return select(up, r[o[1]], r[o[0]]);
    default: {  // TAPE_WHOLE: even numbers where the cosine is positive
      const Pack odd = select(up, Pack(0.0), Pack(1.0));
      return Pack(2.0) * nearest_integer(Pack(0.5) * (r[o[0]] - odd)) + odd;
    }
  }
}

// As run_program, with every kink's result taken on a side of it (kinks), or where that is 0 as it is: at its zero.
template <class Number, class RowValue>
inline void run_on_sides(const Plan& p, const Workspace& w, const ProgramOf<Number>& program, const RowValue& row_value,
                         const Pack* side, Pack* r) {
  read_program(p, w, program, row_value, r);
  Tape part = instructions_of(program);
  int done = 0;
  const auto replay_to = [&](int end) {
    part.instructions = end - done;
    replay_pack(part, r);
    part.constants += end - done, part.operation += end - done, part.operand += 3 * (end - done);
    done = end;
  };
  for (int k = 0; k < program.kinks; ++k) {
    replay_to(program.kink[k] + 1);
    Pack& result = r[program.inputs + program.constants + program.kink[k]];
    result = select(side[k] == Pack(0.0), result, value_on_side(program, k, side[k], r));
  }
  replay_to(program.instructions);
}

// The values of loads that vary into `w.load`, before the forces; the lanes in which one has none.
template <class RowValue>
inline Mask evaluate_loads(const Plan& p, Workspace& w, const RowValue& row_value) {
  Mask undefined = all_lanes(false);
  if (!p.load_values) return undefined;
  run_program(p, w, p.law, row_value, w.law);
  for (int v = 0; v < p.load_values; ++v) {
    w.load[v] = w.law[p.law.output[v]];
    undefined = undefined | ~(w.load[v] == w.load[v]);
  }
  return undefined;
}

}  // namespace
