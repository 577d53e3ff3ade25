// One instruction set's equations of motion: compiled once per width, with MECHKIN_LANES and MECHKIN_MOTION set by the
// build.
#define MECHKIN_WIDE_PLAN
#include "plan/wide_plan.hpp"

#include "response/motion_unit.hpp"
#include "forces/quantity_program.hpp"
#include "response/regular.hpp"
#include "response/sliding.hpp"

namespace {

// The arrays of a stage as packs.
MECHKIN_INLINE const Pack* packs(const double* at) { return reinterpret_cast<const Pack*>(at); }
MECHKIN_INLINE Pack* packs(double* at) { return reinterpret_cast<Pack*>(at); }

inline void copy(const Pack* from, int count, Pack* to) {
  for (int i = 0; i < count; ++i) to[i] = from[i];
}

// What loads read of a stage.
struct StageValues {
  const StageGiven& given;
  MECHKIN_INLINE Pack time() const { return *packs(given.time); }
  // The turn nearest to where the angle was at the origin; a tree's angle is continuous by itself.
  MECHKIN_INLINE Pack turned(int turn, bool closing, Pack angle) const {
    const Pack full = 2.0 * 3.14159265358979323846;
    if (turn < 0 || !closing) return angle;
    return angle + full * nearest_integer((packs(given.turned)[turn] - angle) / full);
  }
  MECHKIN_INLINE Pack input(int, Pack, Pack angle) const { return angle; }
};

// Where the states would be by the origin's derivatives, moved along the chart to the wanted place; what that missed at
// another stage grows with the third power of the time. `missing` keeps where they would be without it.
inline void predict(const Plan& p, Workspace& w, const StageGiven& given, Pack* missing) {
  const Pack* const q = packs(given.origin);
  const Pack t = *packs(given.elapsed), half = Pack(0.5) * t * t;
  for (int c = 0; c < p.columns; ++c)
    w.rate[c] = t * packs(given.origin_rate)[c] + half * packs(given.origin_second)[c];
  for (int i = 0; i < p.charts; ++i) {
    const Pack* const along = w.direction + i * p.columns;
    Pack off = w.place[i];
    for (int c = 0; c < p.columns; ++c) off -= along[c] * w.rate[c];
    // the directions are orthonormal in the weighted columns
    for (int c = 0; c < p.columns; ++c) w.rate[c] += off * along[c] * p.column_weight[c] * p.column_weight[c];
  }
  const Pack other = *packs(given.miss_elapsed), part = t / select(other > Pack(0.0), other, Pack(1.0));
  Pack cube = select(other > Pack(0.0), part * part * part, Pack(0.0)), most = 0.0, added = 0.0;
  for (int c = 0; c < p.columns; ++c) {
    const Pack per = Pack(1.0) / p.column_weight[c];
    most = max(most, per * abs(w.rate[c])), added = max(added, per * abs(cube * packs(given.miss)[c]));
  }
  // more than the way itself is what a stage far off, of an explicit step in a stiff motion, has left of its rounding
  cube = select(added <= most, cube, Pack(0.0));
  for (int c = 0; c < p.columns; ++c) {
    missing[c] = -w.rate[c];
    w.rate[c] += cube * packs(given.miss)[c];
  }
  copy(q, p.states, w.q);
  for (int k = 0; k < p.links; ++k) {
    const TreeJoint& j = p.joints[k];
    with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      advance(entry, w.q + j.state, w.rate + j.column, all_lanes(true));
    });
  }
  for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = packs(given.inputs)[i];
}

// The largest weighted way of a column from the origin.
inline Pack way(const Plan& p, const Workspace& w) {
  Pack length = 0.0;
  for (int c = 0; c < p.columns; ++c) length = max(length, abs(w.rate[c]));
  return length;
}

struct Placed {
  Mask closed, on_branch;
};

// The lanes with places of a kind.
inline Mask lanes_placed(const StageGiven& given, double kind) {
  return given.placed ? *packs(given.placed) == Pack(kind) : all_lanes(false);
}

inline void take_places(const Plan& p, Workspace& w, const StageGiven& given, Mask lanes) {
  if (!any(lanes)) return;
  for (int s = 0; s < p.states; ++s) w.q[s] = select(lanes, packs(given.placed_state)[s], w.q[s]);
  for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = packs(given.inputs)[i];
}

// Limit of placed states' residuals in parts of that of closed ones: interpolation rounds some times.
constexpr double PLACED_ROUNDING = 16.0;

// The states of lanes that are placed, which Newton's method has moved, and whether they are closed.
// Kept apart: see is_regular.
__attribute__((noinline)) void place_again(const Plan& p, Workspace& w, int block, const StageGiven& given, Mask lanes, Closed* closed) {
  take_places(p, w, given, lanes);
  place_block(p, w, p.block[block]);
  const Pack limit = PLACED_ROUNDING * given.accept;
  Mask near = block_residual(p, w, p.block[block]).test <= limit;
  if (any(lanes & ~near)) near = near | (residual_with_rounding(p, w, p.block[block], given.accept) <= limit);
  const Mask side = block_side_conditions(p, w, p.block[block]);
  closed->converged = (lanes & near) | (~lanes & closed->converged);
  closed->side = (lanes & side) | (~lanes & closed->side);
}

// Rates and twists of lanes that are placed.
inline void place_directions(const Plan& p, Workspace& w, ReducedMotion& m, const StageGiven& given, Mask lanes) {
  if (!any(lanes)) return;
  for (int d = 0; d < directions(p); ++d) {
    for (int c = 0; c < p.columns; ++c) {
      Pack& rate = m.tangent[d * p.columns + c];
      rate = select(lanes, packs(given.placed_tangent)[d * p.columns + c], rate);
      w.rate[c] = rate;
    }
    if (has_composites(p)) continue;
    for (int b = 0; b < p.blocks; ++b) move_block(p, w, p.block[b]);
    move_rest(p, w);
    for (int k = 0; k < p.links; ++k) m.twist[d * p.links + k] = w.motion[k].velocity;
  }
}

inline void place_accelerations(const Plan& p, Workspace& w, const StageGiven& given, Mask lanes) {
  if (!any(lanes)) return;
  for (int c = 0; c < p.columns; ++c)
    w.acceleration[c] = select(lanes, packs(given.placed_bend)[c], w.acceleration[c]);
  for (int b = 0; b < p.blocks; ++b) accelerate_block(p, w, p.block[b], false);
  accelerate_rest(p, w);
}

// Whether a block's Jacobian, `here` and factored, is joined with that of the origin by regular ones.
inline Mask is_joined(const Plan& p, Workspace& w, int block, const BlockMatrices& at, const Pack* here, const Pack* origin,
                      double limit, const ReducedMotion& m) {
  if (at.row) return is_regular_band(at.band(), at.entries, here, origin, limit, m.segment);
  return is_regular(p, w, block, origin, limit, m.radius);
}

// Kept apart as is_regular is.
__attribute__((noinline)) Closed close_in_chart(const Plan& p, Workspace& w, int block, const Request& limits) {
  return close_block<true>(p, w, block, limits);
}

inline Placed close_stage(const Plan& p, Workspace& w, ReducedMotion& m, const StageGiven& given,
                          const StageFound& found) {
  Request limits = {};
  limits.tight = given.tight, limits.coarse = given.coarse, limits.accept = given.accept;
  limits.iterations = given.iterations;
  const Pack room = Pack(given.jump) * way(p, w);
  Placed placed = {all_lanes(true), all_lanes(true)};
  const Mask fixed = lanes_placed(given, PLACED);
  take_places(p, w, given, fixed | lanes_placed(given, GUESSED));
  long entries = 0;
  for (int b = 0; b < p.blocks; ++b) {
    Closed closed = close_in_chart(p, w, b, limits);
    if (any(fixed)) place_again(p, w, b, given, fixed, &closed);
    const BlockMatrices at = matrices_of(p, w, b);
    block_screws(p, w, p.block[b]);
    find_jacobian(p, w, b, at);
    copy(at.jacobian, at.entries, packs(found.jacobian) + entries);
    at.factor_jacobian();
    placed.closed = placed.closed & closed.converged & closed.side;
    placed.on_branch = placed.on_branch & (closed.correction <= room + Pack(given.coarse)) &
                       is_joined(p, w, b, at, packs(found.jacobian) + entries, packs(given.origin_jacobian) + entries,
                                 given.radius, m);
    entries += at.entries;
  }
  placed.on_branch = placed.on_branch | fixed;
  for (int k = 0; k < p.rest_count; ++k) {
    place_joint(p, w, p.rest[k]);
    find_screws(p, w, p.rest[k]);
  }
  return placed;
}

struct Undefined {
  Mask load, stop;
};

// The values of loads, of kinks and of what else is watched from the registers of a run, in some lanes.
inline void take_program(const Plan& p, Workspace& w, Mask lanes, Pack* watched) {
  for (int v = 0; v < p.load_values; ++v) w.load[v] = select(lanes, w.law[p.law.output[v]], w.load[v]);
  for (int k = 0; k < p.law.kinks; ++k) watched[k] = select(lanes, kink_value(p.law, k, w.law), watched[k]);
  Pack* const other = watched + p.law.kinks - p.load_values;
  for (int v = p.load_values; v < p.law.outputs; ++v) other[v] = select(lanes, w.law[p.law.output[v]], other[v]);
}

inline Undefined undefined_values(const Plan& p, const Workspace& w, const Pack* watched) {
  Undefined undefined = {all_lanes(false), all_lanes(false)};
  for (int v = 0; v < p.load_values; ++v) undefined.load = undefined.load | ~(w.load[v] == w.load[v]);
  const Pack* const other = watched + p.law.kinks - p.load_values;
  for (int v = p.load_values; v < p.law.outputs; ++v) undefined.stop = undefined.stop | ~(other[v] == other[v]);
  return undefined;
}

// The values of loads, of kinks and of what else is watched; the lanes in which a load or a stop has none. Where one has none
// beyond a kink on the side before it, such as a root of what was positive, it is taken as it is there: the step that ends
// on the kink asks for no such place but by rounding.
inline Undefined evaluate_program(const Plan& p, Workspace& w, const StageGiven& given, const StageValues& values,
                                  Pack* watched) {
  if (!p.law.outputs) return {all_lanes(false), all_lanes(false)};
  run_on_sides(p, w, p.law, values, packs(given.side), w.law);
  take_program(p, w, all_lanes(true), watched);
  const Undefined undefined = undefined_values(p, w, watched);
  const Mask lost = undefined.load | undefined.stop;
  if (!p.law.kinks || !any(lost)) return undefined;
  run_program(p, w, p.law, values, w.law);
  take_program(p, w, lost, watched);
  return undefined_values(p, w, watched);
}

void evaluate_stage(const Plan& p, Workspace& w, ReducedMotion& m, const Slips& slips, const StageGiven& given,
                    const StageFound& found) {
  copy(packs(given.direction), p.charts * p.columns, w.direction);
  copy(packs(given.origin), p.states, w.origin);
  copy(packs(given.place), p.charts, w.place);
  predict(p, w, given, packs(found.miss));
  const Placed placed = close_stage(p, w, m, given, found);
  for (int c = 0; c < p.columns; ++c) {
    const int s = p.column_state[c];
    Pack& missed = packs(found.miss)[c];
    missed = s < 0 ? Pack(0.0) : missed + (w.q[s] - packs(given.origin)[s]);
  }

  const Mask fixed = lanes_placed(given, PLACED);
  move_along(p, w, m);
  place_directions(p, w, m, given, fixed);
  const Pack* const input_rate = packs(given.input_rates);
  move(p, w, m, packs(given.rate), input_rate, packs(given.input_seconds));
  place_accelerations(p, w, given, fixed);
  const StageValues values = {given};
  const Undefined undefined = evaluate_program(p, w, given, values, packs(found.watched));
  reduce_inertia(p, w, m);
  reduce_forces(p, w, m, values);
  Pack* const second = packs(found.chart_second);
  const Mask positive = solve_motion(p, m, second);
  Slid slid = {all_lanes(false), Pack(0.0)};
  if (p.frictions)
    slid = slide(p, w, m, slips, {packs(given.sense), packs(given.quiet), packs(given.aim), packs(given.armed), packs(given.span), packs(given.way)}, values, second,
                 {packs(found.slip_rate), packs(found.slip_second), packs(found.slip_force), packs(found.slip_row),
                  packs(found.slip_limit), packs(found.slip_loose), packs(found.slip_state), packs(found.slip_answer), packs(found.slip_span),
                  packs(found.slip_way), packs(found.level), packs(found.told), packs(found.system)});
  powers_of_loads(p, w, m, second, input_rate, values, packs(found.power), packs(found.power) + 1);
  packs(found.power)[1] += slid.power;

  copy(w.q, p.states, packs(found.state));
  copy(w.rate, p.columns, packs(found.first));
  if (found.bend) copy(w.acceleration, p.columns, packs(found.bend));
  copy(m.tangent, directions(p) * p.columns, packs(found.tangent));
  copy(m.inertia, p.charts * p.charts, packs(found.inertia));
  for (int c = 0; c < p.columns; ++c) {
    Pack sum = w.acceleration[c];
    for (int i = 0; i < p.charts; ++i) sum += second[i] * m.tangent[i * p.columns + c];
    packs(found.second)[c] = sum;
  }
  for (int t = 0; t < given.turn_count; ++t) {
    Pack turn[3][4];
    closing_turn(p, w, given.turns[t], 0, turn);
    copy(turn[0], given.turns[t].width, packs(found.turned) + given.turns[t].slot);
  }
  for (int i = 0; i < LANES; ++i) {
    unsigned f = STAGE_GOOD;
    if (!lane(placed.closed, i)) f |= STAGE_NOT_CLOSED;
    if (!lane(placed.on_branch, i)) f |= STAGE_OFF_BRANCH;
    if (!lane(positive, i)) f |= STAGE_SINGULAR_INERTIA;
    if (lane(undefined.load, i)) f |= STAGE_UNDEFINED_LOAD;
    if (lane(undefined.stop, i)) f |= STAGE_UNDEFINED_STOP;
    if (lane(slid.undecided, i)) f |= STAGE_FRICTION;
    found.flags[i] = (unsigned char)f;
  }
}

const Plan& plan_at(const char* wide) { return *reinterpret_cast<const Plan*>(wide); }

// What stands at the beginning of a workspace.
struct Laid {
  Workspace w;
  ReducedMotion m;
  Slips slips;
};
constexpr long LAID = (sizeof(Laid) + 63) / 64 * 64;
Laid& laid_at(char* memory) { return *reinterpret_cast<Laid*>(memory + (64 - (std::uintptr_t)memory % 64) % 64); }

long workspace_size(const char* wide) {
  Workspace w;
  ReducedMotion m;
  Slips s;
  const Plan& p = plan_at(wide);
  return lay_out(p, nullptr, &w) + lay_out_motion(p, nullptr, &m) + lay_out_slips(p, nullptr, &s) + LAID + 128;
}

void prepare(const char* wide, char* memory) {
  const Plan& p = plan_at(wide);
  Laid& laid = laid_at(memory);
  char* const at = reinterpret_cast<char*>(&laid) + LAID;
  long used = lay_out(p, at, &laid.w);
  used += lay_out_motion(p, at + used, &laid.m);
  lay_out_slips(p, at + used, &laid.slips);
  find_moving(p, laid.w);
}

void evaluate(const char* wide, const StageGiven& given, const StageFound& found, char* memory) {
  Laid& laid = laid_at(memory);
  evaluate_stage(plan_at(wide), laid.w, laid.m, laid.slips, given, found);
}

const MotionUnit unit = {LANES, widen, workspace_size, prepare, evaluate};

}  // namespace

extern "C" const MotionUnit* MECHKIN_MOTION() { return &unit; }
