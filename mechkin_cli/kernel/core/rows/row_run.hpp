// The rows of a request: closed, moved, balanced, and what is asked of them written.
//
// A unit includes its `judge_blocks` first: condition.hpp, or where no condition is wanted factored_block.hpp.
#pragma once

#include "forces/actuated_balance.hpp"
#include "forces/energy.hpp"
#include "rows/held.hpp"
#include "forces/quantity_program.hpp"

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
  if (all(converged & side)) {
    for (int i = 0; i < in.count; ++i) flags[in.row + i] = ROW_GOOD;
    return;
  }
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
}

void read_friction(const Plan& p, const Request& r, Workspace& w, const Reader& in) {
  w.rubbing.is_told = r.friction_told;
  for (int i = 0; w.rubbing.is_told && i < p.frictions * TOLD_NUMBERS; ++i) w.rubbing.told[i] = in.get(r.friction_told, i);
}

// Factors cost more than a step where an operation is many.
constexpr bool FACTORS_SERVE_AGAIN = PARTS > 1;

// An output with all parts of its numbers.
inline decltype(auto) output_of(const Request& r, int number) {
  const Output& o = r.wanted.output[number];
  if constexpr (PARTS == 1) {
    return (o);
  } else {
    const Output* const low = r.wanted_second.output ? &r.wanted_second.output[number] : nullptr;
    OutputOf<TwoParts> both = {o.type, o.index, o.order, o.freedom, o.slot, {}, {o.factor, low ? low->factor : 0.0}};
    for (int i = 0; i < 3; ++i) both.data[i] = {o.data[i], low ? low->data[i] : 0.0};
    return both;
  }
}

// A pack of rows on its way through a request.
struct RowPack {
  const Plan& p;
  const Request& r;
  Workspace& w;
  Reader in;
  bool wants_level;
  Pack residual = 0.0, correction = 0.0, condition = 0.0;
  Mask converged = all_lanes(true), side = all_lanes(true);
  Balance balance = {p, w, zero_wrench(), zero_wrench(), false, Pack(0.0)};

  Writer writer(double* base) const { return {base, in.rows, in.row, in.count}; }

  void read_guess() {
    for (int s = 0; s < p.states; ++s) w.q[s] = in.get(r.guess, s);
    for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = in.get(r.inputs, i);
    if (p.charts) read_chart(p, r, w, in);
    if (p.frictions) read_friction(p, r, w, in);
  }
  void read_columns(const double* given, Pack* to) const {
    for (int i = 0; i < p.inputs; ++i) to[p.input_column[i]] = in.get(given, i);
  }

  // runs in other arithmetics hold nothing, and their requests tell no turns
  static bool skips(const Request& r, int b) { return PARTS == 1 && r.held && r.held->use[b] == BLOCK_LEFT; }
  static bool holds(const Request& r, int b) { return PARTS == 1 && r.held && r.held->use[b] == BLOCK_HELD; }
  // Of a held block's unknowns, or equations, among those of all.
  auto given(const double* base, int b) const {
    long first = 0;
    for (int other = 0; other < b; ++other)
      if (holds(r, other)) first += p.block[other].size;
    return [this, base, first](int u) { return in.get(base, first + u); };
  }
  Writer equations(double* base, int b) const {
    long first = 0;
    for (int other = 0; other < b; ++other)
      if (holds(r, other)) first += p.block[other].rows;
    return writer(base + first * in.rows);
  }
  void write_jacobian(int b, const BlockMatrices& at) const {
    if (!r.jacobian) return;
    const long first = p.block[b].full_at;
    for (int e = 0; !at.row && e < at.m * at.n; ++e) writer(r.jacobian).put(first + e, at.jacobian[e]);
    for (int e = 0; at.row && e < at.m * at.n; ++e) writer(r.jacobian).put(first + e, at.entry(e / at.n, e % at.n));
  }

  void hold(int b) {
    const Residual held = hold_block(p, w, b, equations(r.held->equations, b));
    Mask near = held.test <= Pack(r.accept);
    if (!all(near)) near = near | (residual_with_rounding(p, w, p.block[b], r.accept) <= Pack(r.accept));
    converged = converged & near;
    side = side & block_side_conditions(p, w, p.block[b]);
    write_jacobian(b, matrices_of(p, w, b));
  }
  // How far a block closed; a NaN wins.
  void take_closed(const Closed& closed) {
    residual = select(closed.residual <= residual, residual, closed.residual);
    correction = select(closed.correction <= correction, correction, closed.correction);
    converged = converged & closed.converged;
    side = side & closed.side;
  }
  void take_verdict(int b, const Judged& verdict) {
    condition = max(verdict.condition, condition);
    if (r.side) writer(r.side).put(b, verdict.side);
    if (r.pivot) writer(r.pivot).put(b, matrices_of(p, w, b).least());
  }
  void close_explicitly(int b) {
    take_closed(::close_explicitly(p, w, b, r));
    if (!r.demand) return;
    const Block& block = p.block[b];
    const BlockMatrices at = matrices_of(p, w, b);
    const Pack inverse = *at.jacobian;
    block_screws(p, w, block);
    if (r.jacobian) writer(r.jacobian).put(block.full_at, explicit_slope(p, w, b));
    if (r.side) writer(r.side).put(b, copysign(Pack(1.0), inverse));
    if (r.pivot) writer(r.pivot).put(b, at.least());
    if (!(r.demand & DEMAND_CONDITION)) return;
    const bool length = p.closing[block.closing_begin].type == RELATION_OF_LENGTHS;
    const Pack row = length ? Pack(p.row_weight) : Pack(1.0), column = p.column_weight[p.unknown[block.column_begin]];
    condition = max(abs(inverse) / (row * column), condition);
  }
  void find_velocities(int b) {
    if (holds(r, b))
      hold_velocities(p, w, b, given(r.held->rates, b), equations(r.held->first, b));
    else if (skips(r, b))
      move_block(p, w, p.block[b]);
    else
      block_velocities(p, w, b);
  }
  void find_accelerations(int b) {
    if (holds(r, b))
      hold_accelerations(p, w, b, given(r.held->accelerations, b), equations(r.held->second, b));
    else if (skips(r, b))
      accelerate_block(p, w, p.block[b], false);
    else
      block_accelerations(p, w, b);
  }

  void write_motion() const {
    if (r.states)
      for (int s = 0; s < p.states; ++s) writer(r.states).put(s, w.q[s]);
    if (r.velocities && r.demand & DEMAND_VELOCITY)
      for (int c = 0; c < p.columns; ++c) writer(r.velocities).put(c, w.rate[c]);
    if (r.second && r.demand & DEMAND_ACCELERATION)
      for (int c = 0; c < p.columns; ++c) writer(r.second).put(c, w.acceleration[c]);
    writer(r.residual).put(0, residual);
    writer(r.correction).put(0, correction);
    if (PARTS == 1 && r.turn_count) write_turns(p, w, r, in);
    if (r.demand & DEMAND_CONDITION) writer(r.condition).put(0, condition);
    write_flags(r.flags, in, converged, side);
  }
  // A coordinate of a closing joint with those of its derivatives that stand behind it, for they share much; how many.
  int write_closing(int number, const Writer& out) const {
    const Output* const o = r.wanted.output + number;
    const int left = r.wanted.count - number;
    int count = 1;
    while (count < left && o[count].type == OUT_CLOSING && o[count].index == o->index && o[count].freedom == o->freedom &&
           o[count].order == o->order + count)
      ++count;
    Pack found[4];
    closing_coordinate(p, w, o->index, o->freedom, o->order, o->order + count - 1, found);
    for (int k = 0; k < count; ++k) out.put(o[k].slot, Pack(output_of(r, number + k).factor) * found[o[k].order]);
    return count;
  }
  void write_outputs(const Balance* balance) const {
    const Writer out = writer(r.outputs);
    const int count = r.wanted.count;
    for (int o = 0; o < count; ++o)
      if (balance && o + 1 < count && are_of_one_wrench(r.wanted.output[o], r.wanted.output[o + 1]))
        write_wrench(p, w, output_of(r, o), output_of(r, o + 1), out), ++o;
      else if (r.wanted.output[o].type == OUT_CLOSING)
        o += write_closing(o, out) - 1;
      else
        write_output(p, w, balance, RowValues{r, in}, output_of(r, o), out);
  }
  Pack rate_by_leader(int t) const { return in.get(r.constraint_rates, t); }
  void begin_balance() {
    balance.moving = r.demand & DEMAND_VELOCITY;
    const RowValues row_values = {r, in};
    const Mask undefined = evaluate_loads(p, w, row_values);
    if (r.loads)
      for (int v = 0; v < p.load_values; ++v) writer(r.loads).put(v, w.load[v]);
    if (r.undefined)
      for (int i = 0; i < in.count; ++i) r.undefined[in.row + i] = lane(undefined, i);
    ::begin_balance(balance, r.demand & DEMAND_ACCELERATION, r.shift, row_values, [this](int t) { return rate_by_leader(t); });
  }
  void finish_balance() {
    const bool velocities = r.demand & DEMAND_VELOCITY, accelerations = r.demand & DEMAND_ACCELERATION;
    const RowValues row_values = {r, in};
    if (solves_friction_together(p)) ::finish_balance(balance, r.shift, [this](int t) { return rate_by_leader(t); });
    if (wants_level) balance.level = reaction_level(p, w);
    // the chart stands in the one block, behind its closing equations
    if (r.chart_forces)
      for (int i = 0; i < p.charts; ++i)
        writer(r.chart_forces).put(i, w.multiplier[p.block[0].rows - p.charts + i]);
    const auto actuators = [&](Powers& powers) { add_actuator_power(powers, p, w); };
    if (r.demand & DEMAND_POWER)
      writer(r.power_error)
          .put(0, velocities ? power_error(p, w, accelerations, balance.level, row_values, actuators)
                             : Pack(__builtin_nan("")));
    if (r.outputs) write_outputs(&balance);
  }
};

// Whether the level of the joints' wrenches is asked for.
inline bool level_is_wanted(const Request& r) {
  bool wanted = r.demand & DEMAND_POWER;
  for (int o = 0; o < r.wanted.count; ++o) wanted = wanted || r.wanted.output[o].type == OUT_REACTION_LEVEL;
  return wanted;
}

// Packs that go through each stage of a run together: see close_packs. More would not stay in the nearest cache.
constexpr int TOGETHER = PARTS == 1 ? 2 : 1;

inline void close_rows(const Plan& p, const Request& r, RowPack* pack, int count, int b) {
  Closing closing[] = {Closing(pack[0].w), Closing(pack[count - 1].w)};
  close_packs<FACTORS_SERVE_AGAIN>(p, closing, count, b, r);
  const Closed closed[] = {closed_block(p, closing[0], b, r),
                           count > 1 ? closed_block(p, closing[1], b, r) : Closed{}};
  for (int k = 0; k < count; ++k) pack[k].take_closed(closed[k]);
  if (!r.demand) return;
  Judged judged[] = {{pack[0].w, closed[0]}, {pack[count - 1].w, closed[1]}};
  judge_blocks(p, b, r, judged, count, [&](int k, const BlockMatrices& at) { pack[k].write_jacobian(b, at); });
  for (int k = 0; k < count; ++k) pack[k].take_verdict(b, judged[k]);
}

void run_packs(const Plan& p, const Request& r, RowPack* pack, int count) {
  const auto each = [&](auto&& stage) __attribute__((always_inline)) {
    for (RowPack* k = pack; k < pack + count; ++k) stage(*k);
  };
  each([&](RowPack& k) { k.read_guess(); });
  for (int b = 0; b < p.blocks; ++b)
    if (RowPack::skips(r, b))
      each([&](RowPack& k) { leave_block(p, k.w, b); });
    else if (RowPack::holds(r, b))
      each([&](RowPack& k) { k.hold(b); });
    else if (p.block[b].is_explicit)
      each([&](RowPack& k) { k.close_explicitly(b); });
    else
      close_rows(p, r, pack, count, b);
  const int rest_count = r.held && !r.held->complete ? 0 : p.rest_count;
  each([&](RowPack& k) {
    for (int j = 0; j < rest_count; ++j) {
      place_joint(p, k.w, p.rest[j]);
      find_screws(p, k.w, p.rest[j]);
    }
    if (r.demand & DEMAND_FORCES && p.actuators)
      find_influence(p, k.w, [&](int t) { return k.rate_by_leader(t); });
  });
  if (r.demand & DEMAND_VELOCITY) {
    each([&](RowPack& k) { k.read_columns(r.rates, k.w.rate); });
    for (int b = 0; b < p.blocks; ++b) each([&](RowPack& k) { k.find_velocities(b); });
    if (rest_count) each([&](RowPack& k) { move_rest(p, k.w); });
  }
  if (r.demand & DEMAND_ACCELERATION) {
    each([&](RowPack& k) { k.read_columns(r.accelerations, k.w.acceleration); });
    for (int b = 0; b < p.blocks; ++b) each([&](RowPack& k) { k.find_accelerations(b); });
    if (rest_count) each([&](RowPack& k) { accelerate_rest(p, k.w); });
  }
  if (r.demand & DEMAND_JERK) {
    each([&](RowPack& k) { k.read_columns(r.jerks, k.w.jerk); });
    for (int b = 0; b < p.blocks; ++b) each([&](RowPack& k) { block_jerks(p, k.w, b); });
    each([&](RowPack& k) {
      for (int j = 0; j < p.rest_count; ++j) jerk_link(p, k.w, p.rest[j]);
    });
  }
  each([&](RowPack& k) {
    k.write_motion();
    if (r.demand & DEMAND_FORCES)
      k.begin_balance();
    else if (r.outputs)
      k.write_outputs(nullptr);
  });
  if (!(r.demand & DEMAND_FORCES)) return;
  if (solves_friction_together(p)) {
    Rubbing* const rubbing[] = {&pack[0].w.rubbing, &pack[count - 1].w.rubbing};
    solve_frictions(p, rubbing, count);
  }
  each([&](RowPack& k) { k.finish_balance(); });
}

// Room for a workspace that stays laid out, before the arrays that it names.
constexpr long HEAD = (sizeof(Workspace) + 63) / 64 * 64;

long workspace_size(const Plan& p) {
  Workspace w;
  return HEAD + TOGETHER * lay_out(p, nullptr, &w) + 64;
}

inline char* aligned(char* memory) { return memory + (64 - (std::uintptr_t)memory % 64) % 64; }

// The first of the packs that go together, and what it takes of the memory.
Workspace workspace_at(const Plan& p, char* memory, long* size = nullptr) {
  Workspace w;
  const long used = lay_out(p, aligned(memory), &w);
  if (size) *size = used;
  find_moving(p, w);
  return w;
}

inline void prepare(const Plan& p, char* memory) {
  char* const head = aligned(memory);
  *reinterpret_cast<Workspace*>(head) = workspace_at(p, head + HEAD);
}
inline void run_row(const Plan& p, const Request& r, char* memory) {
  Workspace& w = *reinterpret_cast<Workspace*>(aligned(memory));
  RowPack pack = {p, r, w, {r.rows, 0, (int)r.rows}, level_is_wanted(r)};
  run_packs(p, r, &pack, 1);
}

void run_rows(const Plan& p, const Request& r, long begin, long end, char* memory) {
  long size;
  Workspace w = workspace_at(p, memory, &size), other = w;
  if (TOGETHER > 1 && end - begin > LANES) other = workspace_at(p, memory + size);
  const bool wants_level = level_is_wanted(r);
  const auto pack_at = [&](long row, Workspace& at) -> RowPack {
    return {p, r, at, {r.rows, row, end - row < LANES ? (int)(end - row) : LANES}, wants_level};
  };
  long row = begin;
  for (; TOGETHER > 1 && end - row > LANES; row += TOGETHER * LANES) {
    RowPack pack[] = {pack_at(row, w), pack_at(row + LANES, other)};
    run_packs(p, r, pack, TOGETHER);
  }
  for (; row < end; row += LANES) {
    RowPack pack = pack_at(row, w);
    run_packs(p, r, &pack, 1);
  }
}

}  // namespace
