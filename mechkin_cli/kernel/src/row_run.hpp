// The rows of a request: closed, moved, balanced, and what is asked of them written.
//
// A unit includes its `judge_block` first: condition.hpp, or where no condition is wanted factored_block.hpp.
#pragma once

#include "actuated_balance.hpp"
#include "energy.hpp"
#include "held.hpp"
#include "quantity_program.hpp"

namespace {

// Reads a pack of rows; lanes beyond the last row repeat it.
struct Reader {
  long rows, row;
  int count;
  MECHKIN_INLINE Pack get(const double* base, long slot) const {
    Real part[PARTS];
    for (int k = 0; k < PARTS; ++k) part[k] = get_part(base + (PARTS * slot + k) * rows + row);
    return from_parts(part);
  }
  MECHKIN_INLINE Real get_part(const double* at) const {
    if (count == LANES) return load(at);
    double buffer[LANES];
    for (int i = 0; i < LANES; ++i) buffer[i] = at[i < count ? i : count - 1];
    return load(buffer);
  }
};

// What loads and their laws read of a row beside the workspace.
struct RowValues {
  const Request& r;
  const Reader& in;
  MECHKIN_INLINE Pack time() const { return r.time ? in.get(r.time, 0) : Pack(__builtin_nan("")); }
  // An angle with its whole turns, see LoadOf::turn: of a closing joint, what is nearest to what following says.
  MECHKIN_INLINE Pack turned(int turn, bool closing, Pack angle) const {
    const Pack full = FULL_TURN;
    if (turn == -1 || !(turn >= 0 ? r.turned : r.whole)) return angle;
    if (turn < -1) return angle + full * in.get(r.whole, -2 - turn);
    const Pack known = in.get(r.turned, turn);
    return angle + full * (closing ? nearest_integer((known - angle) / full) : known);
  }
  // The value of an input whose part within a turn is `angle`: as it was given, which a sum with its turns rounds.
  MECHKIN_INLINE Pack input(int number, Pack factor, Pack angle) const {
    return r.full ? factor * in.get(r.full, number) : turned(-2 - number, false, angle);
  }
};

void write_flags(unsigned char* flags, const Reader& in, Mask converged, Mask side) {
  for (int i = 0; i < in.count; ++i) {
    unsigned f = 0;
    if (!lane(converged, i)) f |= ROW_NOT_CONVERGED;
    if (!lane(side, i)) f |= ROW_SIDE_CONDITION;
    flags[in.row + i] = (unsigned char)f;
  }
}

// Angles and orientations of closing joints with their first and second derivatives.
void write_turns(const Plan& p, const Workspace& w, const Request& r, const Reader& in) {
  const Writer value = {r.turn, in.rows, in.row, in.count}, first = {r.turn_first, in.rows, in.row, in.count},
               second = {r.turn_second, in.rows, in.row, in.count};
  for (int t = 0; t < r.turn_count; ++t) {
    Pack found[3][4];
    closing_turn(p, w, r.turns[t], 2, found);
    for (int k = 0; k < r.turns[t].width; ++k) {
      const int slot = r.turns[t].slot + k;
      value.put(slot, found[0][k]), first.put(slot, found[1][k]), second.put(slot, found[2][k]);
    }
  }
}

void read_chart(const Plan& p, const Request& r, Workspace& w, const Reader& in) {
  const auto values = [&](const double* given, int count, Pack* to) {
    for (int i = 0; i < count; ++i) to[i] = given ? in.get(given, i) : Pack(0.0);
  };
  values(r.chart, p.charts * p.columns, w.direction);
  values(r.chart_origin ? r.chart_origin : r.guess, p.states, w.origin);
  values(r.chart_place, p.charts, w.place);
  values(r.chart_rates, p.charts, w.place_rate);
  values(r.chart_accelerations, p.charts, w.place_acceleration);
  w.rubbing.is_told = p.frictions && r.friction_told;
  if (w.rubbing.is_told) values(r.friction_told, p.frictions * TOLD_NUMBERS, w.rubbing.told);
}

// Factors cost more than a step where an operation is many.
constexpr bool FACTORS_SERVE_AGAIN = PARTS > 1;

// An output with all parts of its numbers.
inline auto output_of(const Request& r, int number) {
  const Output& o = r.wanted.output[number];
  if constexpr (PARTS == 1) {
    return o;
  } else {
    const Output* const low = r.wanted_second.output ? &r.wanted_second.output[number] : nullptr;
    OutputOf<TwoParts> both = {o.type, o.index, o.order, o.freedom, o.slot, {}, {o.factor, low ? low->factor : 0.0}};
    for (int i = 0; i < 3; ++i) both.data[i] = {o.data[i], low ? low->data[i] : 0.0};
    return both;
  }
}

void run_pack(const Plan& p, const Request& r, Workspace& w, const Reader& in) {
  const bool velocities = r.demand & DEMAND_VELOCITY, accelerations = r.demand & DEMAND_ACCELERATION;
  for (int s = 0; s < p.states; ++s) w.q[s] = in.get(r.guess, s);
  for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = in.get(r.inputs, i);

  if (p.charts) read_chart(p, r, w, in);

  Pack residual = 0.0, correction = 0.0, condition = 0.0;
  Mask converged = all_lanes(true), side = all_lanes(true);
  // runs in other arithmetics hold nothing, and their requests tell no turns
  const auto skips = [&](int b) { return PARTS == 1 && r.held && r.held->use[b] == BLOCK_LEFT; };
  const auto holds = [&](int b) { return PARTS == 1 && r.held && r.held->use[b] == BLOCK_HELD; };
  // first unknown and first equation of a held block among those of all
  const auto first_held = [&](int b) {
    struct {
      long unknown, equation;
    } first = {0, 0};
    for (int other = 0; other < b; ++other)
      if (holds(other)) first.unknown += p.block[other].size, first.equation += p.block[other].rows;
    return first;
  };
  const auto given = [&](const double* base, int b) {
    return [&in, base, from = first_held(b).unknown](int u) { return in.get(base, from + u); };
  };
  const auto equations = [&](double* base, int b) {
    return Writer{base + first_held(b).equation * in.rows, in.rows, in.row, in.count};
  };
  const auto writer = [&](double* base) { return Writer{base, in.rows, in.row, in.count}; };
  const auto write_jacobian = [&](const BlockMatrices& at) {
    if (!r.jacobian) return;
    for (long e = 0; e < at.m * at.n; ++e) writer(r.jacobian).put(at.jacobian - w.jacobian + e, at.jacobian[e]);
  };
  for (int b = 0; b < p.blocks; ++b) {
    if (skips(b)) {
      leave_block(p, w, b);
      continue;
    }
    if (holds(b)) {
      const Residual held = hold_block(p, w, b, equations(r.held->equations, b));
      Mask near = held.test <= Pack(r.accept);
      if (!all(near)) near = near | (residual_with_rounding(p, w, p.block[b], r.accept) <= Pack(r.accept));
      converged = converged & near;
      side = side & block_side_conditions(p, w, p.block[b]);
      write_jacobian(matrices_of(p, w, b));
      continue;
    }
    const Closed closed = close_block<FACTORS_SERVE_AGAIN>(p, w, b, r);
    // a NaN wins
    residual = select(closed.residual <= residual, residual, closed.residual);
    correction = select(closed.correction <= correction, correction, closed.correction);
    converged = converged & closed.converged;
    side = side & closed.side;
    if (!r.demand) continue;
    const BlockVerdict verdict = judge_block(p, w, b, r, closed, write_jacobian);
    condition = max(verdict.condition, condition);
    if (r.side) writer(r.side).put(b, verdict.side);
    if (r.pivot) writer(r.pivot).put(b, matrices_of(p, w, b).least());
  }
  const int rest_count = r.held && !r.held->complete ? 0 : p.rest_count;
  const auto tie_value = [&](int t) { return in.get(r.ties, t); };
  for (int k = 0; k < rest_count; ++k) {
    place_joint(p, w, p.rest[k]);
    find_screws(p, w, p.rest[k]);
  }
  if (r.demand & DEMAND_FORCES && p.actuators) find_influence(p, w, tie_value);
  if (velocities) {
    for (int i = 0; i < p.inputs; ++i) w.rate[p.input_column[i]] = in.get(r.rates, i);
    for (int b = 0; b < p.blocks; ++b)
      if (holds(b))
        hold_velocities(p, w, b, given(r.held->rates, b), equations(r.held->first, b));
      else if (skips(b))
        move_block(p, w, p.block[b]);
      else
        block_velocities(p, w, b);
    if (rest_count) move_rest(p, w);
  }
  if (accelerations) {
    for (int i = 0; i < p.inputs; ++i) w.acceleration[p.input_column[i]] = in.get(r.accelerations, i);
    for (int b = 0; b < p.blocks; ++b)
      if (holds(b))
        hold_accelerations(p, w, b, given(r.held->accelerations, b), equations(r.held->second, b));
      else if (skips(b))
        accelerate_block(p, w, p.block[b], false);
      else
        block_accelerations(p, w, b);
    if (rest_count) accelerate_rest(p, w);
  }

  if (r.demand & DEMAND_JERK) {
    for (int i = 0; i < p.inputs; ++i) w.jerk[p.input_column[i]] = in.get(r.jerks, i);
    for (int b = 0; b < p.blocks; ++b) block_jerks(p, w, b);
    for (int k = 0; k < p.rest_count; ++k) jerk_link(p, w, p.rest[k]);
  }

  if (r.states)
    for (int s = 0; s < p.states; ++s) writer(r.states).put(s, w.q[s]);
  if (r.velocities && velocities)
    for (int c = 0; c < p.columns; ++c) writer(r.velocities).put(c, w.rate[c]);
  if (r.second && accelerations)
    for (int c = 0; c < p.columns; ++c) writer(r.second).put(c, w.acceleration[c]);
  writer(r.residual).put(0, residual);
  writer(r.correction).put(0, correction);
  if (PARTS == 1 && r.turn_count) write_turns(p, w, r, in);
  if (r.demand & DEMAND_CONDITION) writer(r.condition).put(0, condition);

  const RowValues row_values = {r, in};
  const auto outputs = [&](const Balance* balance) {
    const Writer out = writer(r.outputs);
    for (int o = 0; o < r.wanted.count; ++o) write_output(p, w, balance, row_values, output_of(r, o), out);
  };
  if (r.demand & DEMAND_FORCES) {
    const Mask undefined = evaluate_loads(p, w, row_values);
    if (r.loads)
      for (int v = 0; v < p.load_values; ++v) writer(r.loads).put(v, w.load[v]);
    if (r.undefined)
      for (int i = 0; i < in.count; ++i) r.undefined[in.row + i] = lane(undefined, i);
    const Balance balance =
        balance_with_actuators(p, w, velocities, accelerations, r.shift, row_values, tie_value);
    // the chart stands in the one block, behind its closing equations
    if (PARTS > 1 && r.chart_forces)
      for (int i = 0; i < p.charts; ++i)
        writer(r.chart_forces).put(i, w.multiplier[p.block[0].rows - p.charts + i]);
    const auto actuators = [&](Powers& powers) { add_actuator_power(powers, p, w); };
    if (r.demand & DEMAND_POWER)
      writer(r.power_error)
          .put(0, velocities ? power_error(p, w, accelerations, balance.level, row_values, actuators)
                             : Pack(__builtin_nan("")));
    if (r.outputs) outputs(&balance);
  } else if (r.outputs) {
    outputs(nullptr);
  }
  write_flags(r.flags, in, converged, side);
}

long workspace_size(const Plan& p) {
  Workspace w;
  return lay_out(p, nullptr, &w) + 64;
}

Workspace workspace_at(const Plan& p, char* memory) {
  Workspace w;
  lay_out(p, memory + (64 - (std::uintptr_t)memory % 64) % 64, &w);
  find_moving(p, w);
  return w;
}

void run_rows(const Plan& p, const Request& r, long begin, long end, char* memory) {
  Workspace w = workspace_at(p, memory);
  for (long row = begin; row < end; row += LANES) {
    const int count = end - row < LANES ? (int)(end - row) : LANES;
    run_pack(p, r, w, {r.rows, row, count});
  }
}

}  // namespace
