// Programs of quantities: values of loads that vary, and other numbers that follow from positions, rates and time, for a
// pack of rows. What they compute is recorded where the file is built (solver/quantity_program.py).
//
// A `RowValue` says what the workspace does not hold: `time()`, `turned(turn, closing, angle)` an angle with its whole
// turns (LoadOf::turn), and `input(number, factor, angle)` an input with them, of which `angle` is the part within one.
#pragma once

#include "outputs.hpp"
#include "tape_replay.hpp"

namespace {

// The tape of a program's instructions.
template <class Number>
inline Tape instructions_of(const ProgramOf<Number>& program) {
  Tape t = {};
  t.inputs = program.inputs, t.constants = program.constants, t.instructions = program.instructions;
  t.operation = program.operation, t.operand = program.operand;
  return t;
}

// The piece from the last knot that is not above lane i of x.
inline const Knot& piece_at(const Knot* first, int count, Pack x, int i) {
  const double leading = lane(part_of(x, 0), i), rest = PARTS == 1 ? 0.0 : lane(part_of(x, PARTS - 1), i);
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (first[middle].x < leading || (first[middle].x == leading && rest >= 0.0))
      low = middle;
    else
      high = middle - 1;
  }
  return first[low];
}

inline Pack curve_value(const ProgramCurve& c, const Knot* knot, Pack at) {
  const Knot* const first = knot + c.begin;
  const int count = c.end - c.begin;
  const Pack start = first->x, end = first[count - 1].x;
  const Mask inside = (at >= Pack(c.low)) & (at <= Pack(c.high));
  const Pack within = select(at < start, start, select(at > end, end, at));
  Knot piece[LANES];
  for (int i = 0; i < LANES; ++i) piece[i] = piece_at(first, count, within, i);
  const auto field = [&piece](double Knot::*of) {
    double values[LANES];
    for (int i = 0; i < LANES; ++i) values[i] = piece[i].*of;
    return Pack(load(values));
  };
  const Pack u = within - field(&Knot::x);
  const Pack value = field(&Knot::y) + u * (field(&Knot::b) + u * (field(&Knot::c) + u * field(&Knot::d)));
  return select(inside, value, Pack(__builtin_nan("")));
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

// As run_program, with every kink's result taken on a side of it (kinks).
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
    r[program.inputs + program.constants + program.kink[k]] = value_on_side(program, k, side[k], r);
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
