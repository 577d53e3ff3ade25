// Enclosures of positions, rates, accelerations, jerks, forces and outputs in intervals, and of equations and their derivatives over
// boxes.
#define MECHKIN_WIDE_PLAN
#include "plan/parted_plan.hpp"

#include "proofs/contracted_position.hpp"
#include "proofs/enclosed_motion.hpp"
#include "proofs/enclosed_program.hpp"
#include "proofs/enclosing_unit.hpp"
#include "rows/outputs.hpp"

namespace {

struct Memory {
  Workspace w;
  Box box;
  Solving solving;
};

inline long lay_out_solving(const Plan& p, Room& room, Memory* m) {
  long inverse = 0, error = 0;
  for (int b = 0; b < p.blocks; ++b) {
    const long rows = p.block[b].rows, n = p.block[b].size;
    inverse += rows * n, error += n * n;
  }
  const long largest = p.largest_block;
  m->box.turn = room.take<Pack>(p.columns);
  m->box.radius = room.take<Real>(p.columns);
  m->solving.derivatives = room.take<Pack>((int)(largest * p.columns));
  m->solving.inverse = room.take<Real>((int)inverse);
  m->solving.error = room.take<Real>((int)error);
  m->solving.across = room.take<Real>((int)(largest * largest));
  m->solving.room = room.take<Pack>((int)solution_room((int)largest, (int)largest));
  m->solving.scalar = room.take<double>((int)inverse_numbers(largest));
  return room.used;
}

struct Lookup {
  long rows, row;
  int count;
  Real real(const double* base, long number) const {
    double lanes[LANES];
    for (int i = 0; i < LANES; ++i) lanes[i] = base[number * rows + row + (i < count ? i : count - 1)];
    return load(lanes);
  }
  Pack get(const double* base, long number) const {
    const Real part[] = {real(base, PARTS * number), real(base, PARTS * number + 1), real(base, PARTS * number + 2)};
    return from_parts(part);
  }
};

constexpr double UNKNOWN_NUMBER = __builtin_nan("");

// What loads read of a row beside the workspace, see quantity_program.hpp.
struct RowValues {
  const EnclosingRequest& r;
  const Lookup& in;
  Pack time() const { return r.time ? in.get(r.time, 0) : UNKNOWN_NUMBER; }
  Pack turned(int turn, bool closing, Pack angle) const {
    if (turn == -1 || !(turn >= 0 ? r.turned : r.whole)) return angle;
    if (turn < -1) return angle + Pack(FULL_TURN) * Pack(in.real(r.whole, -2 - turn));
    const Real known = in.real(r.turned, turn);
    // how many turns is known from following; of two that are as near either is a value of the angle
    const Real turns = closing ? nearest_integer((known - angle.midpoint.high) / Real(FULL_TURN.first)) : known;
    return angle + Pack(FULL_TURN) * Pack(turns);
  }
  Pack input(int number, Pack, Pack angle) const { return turned(-2 - number, false, angle); }
};

// The states of the box, inputs with their radius, unknowns with that of their columns.
void read_box(const Plan& p, const EnclosingRequest& r, Memory& m, const Lookup& in) {
  Workspace& w = m.w;
  for (int s = 0; s < p.states; ++s) w.q[s] = Pack(in.real(r.states, s));
  for (int i = 0; i < p.inputs; ++i) w.q[p.column_state[p.input_column[i]]] = in.get(r.inputs, i);
  for (int c = 0; c < p.columns; ++c) {
    m.box.turn[c] = 0.0;
    m.box.radius[c] = r.radius ? in.real(r.radius, c) : Real(0.0);
    const int state = p.column_state[c];
    if (state >= 0) w.q[state].radius = widened(w.q[state].radius + m.box.radius[c]);
    else m.box.turn[c].radius = m.box.radius[c];
  }
}

void put_position(const Plan& p, const EnclosingRequest& r, const Memory& m, int index, const Writer& out) {
  const long first = place_of_block(p, index).rows;
  const Block& b = p.block[index];
  if (r.equations)
    for (int i = 0; i < b.rows; ++i) out.to(r.equations).put(first + i, m.w.right[i]);
  if (r.sides)
    for (int c = b.closing_begin; c < b.closing_end; ++c) {
      Pack side = 1.0;
      with_closing_joint(p.closing[c].type, [&](auto entry) { entry.sides(m.w.closure[c], [&](Pack x) { side = x; }); });
      out.to(r.sides).put(c, side);
    }
}

// All forces on the links, or that nothing is known of them: of friction, and of efforts at actuators.
Balance enclose_forces(const Plan& p, Memory& m, const RowValues& row_values, const EnclosingRequest& r) {
  Workspace& w = m.w;
  Balance balance = {p, w, zero_wrench(), zero_wrench(), r.rates != nullptr, UNKNOWN_NUMBER};
  enclose_loads(p, w, row_values);
  apply_inertia(balance, r.accelerations != nullptr);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_values);
  const Vec3 unknown = {UNKNOWN_NUMBER, UNKNOWN_NUMBER, UNKNOWN_NUMBER};
  if (p.frictions || p.actuators)
    for (int k = 0; k < p.links; ++k) w.carried[k] += Wrench{unknown, unknown};
  enclose_distribution(p, w, m.solving);
  return balance;
}

OutputOf<ThreeParts> enclosed_output(const EnclosingRequest& r, int number) {
  const Output& o = r.wanted->output[number];
  const auto part = [&](const OutputsView* outputs, auto&& at) { return outputs ? at(outputs->output[number]) : 0.0; };
  const auto all = [&](auto&& at) -> ThreeParts { return {at(o), part(r.wanted_low, at), part(r.wanted_radii, at)}; };
  OutputOf<ThreeParts> out = {o.type, o.index, o.order, o.freedom, o.slot, {}, all([](const Output& x) { return x.factor; })};
  for (int k = 0; k < 3; ++k) out.data[k] = all([k](const Output& x) { return x.data[k]; });
  return out;
}

// What friction and actuators would find, which nothing is known of.
void forget_others(const Plan& p, Workspace& w) {
  for (int e = 0; e < efforts(p); ++e) w.actuation.motor[e] = UNKNOWN_NUMBER;
  *w.actuation.least = UNKNOWN_NUMBER;
  w.rubbing.self_locking = UNKNOWN_NUMBER;
  Rubbing& r = w.rubbing;
  for (int f = 0; f < p.frictions; ++f) r.force[f] = r.normal[f] = r.state[f] = r.speed[f] = UNKNOWN_NUMBER;
}

void enclose_positions(const Plan& p, const EnclosingRequest& r, Memory& m, const Lookup& in, const Writer& out) {
  Workspace& w = m.w;
  read_box(p, r, m, in);
  for (int b = 0; b < p.blocks; ++b) {
    // of more equations than unknowns it holds a zero of those of the proof, which are not told
    const bool holds = r.box == EnclosedBox::CLOSED || (r.box == EnclosedBox::SOLVED && p.block[b].rows == p.block[b].size);
    if (holds) contract_block(p, w, m.box, m.solving, b);
    close_enclosed_block(p, w, m.box, b);
    put_position(p, r, m, b, out);
    if (!r.derivatives) continue;
    enclosed_derivatives(p, w, m.box, b, m.solving.derivatives);
    const long first = place_of_block(p, b).rows * p.columns;
    for (long e = 0; e < (long)p.block[b].rows * p.columns; ++e) out.to(r.derivatives).put(first + e, m.solving.derivatives[e]);
  }
  for (int k = 0; k < p.rest_count; ++k) place_enclosed(p, w, m.box, p.rest[k]);
}

void enclose_motion(const Plan& p, const EnclosingRequest& r, Memory& m, const Lookup& in) {
  Workspace& w = m.w;
  for (int i = 0; i < p.inputs; ++i) w.rate[p.input_column[i]] = in.get(r.rates, i);
  for (int b = 0; b < p.blocks; ++b) enclose_rates(p, w, m.solving, b);
  move_rest(p, w);
  if (!r.accelerations) return;
  for (int i = 0; i < p.inputs; ++i) w.acceleration[p.input_column[i]] = in.get(r.accelerations, i);
  for (int b = 0; b < p.blocks; ++b) enclose_accelerations(p, w, m.solving, b);
  accelerate_rest(p, w);
  if (!r.jerks) return;
  for (int i = 0; i < p.inputs; ++i) w.jerk[p.input_column[i]] = in.get(r.jerks, i);
  for (int b = 0; b < p.blocks; ++b) enclose_jerks(p, w, m.solving, b);
  for (int k = 0; k < p.rest_count; ++k) jerk_link(p, w, p.rest[k]);
}

void enclose_pack(const Plan& p, const EnclosingRequest& r, Memory& m, const Lookup& in) {
  Workspace& w = m.w;
  const Writer out = {nullptr, in.rows, in.row, in.count};
  enclose_positions(p, r, m, in, out);
  if (r.rates || r.forces)
    for (int b = 0; b < p.blocks; ++b) prepare_block(p, w, m.solving, b);
  if (r.rates) enclose_motion(p, r, m, in);
  for (int c = 0; c < p.columns; ++c) {
    if (r.position) out.to(r.position).put(c, p.column_state[c] < 0 ? m.box.turn[c] : w.q[p.column_state[c]]);
    if (r.velocities && r.rates) out.to(r.velocities).put(c, w.rate[c]);
    if (r.second && r.accelerations) out.to(r.second).put(c, w.acceleration[c]);
  }
  const RowValues row_values = {r, in};
  forget_others(p, w);
  Balance balance = {p, w, zero_wrench(), zero_wrench(), false, UNKNOWN_NUMBER};
  if (r.forces) {
    const Balance found = enclose_forces(p, m, row_values, r);
    balance.inertia = found.inertia, balance.outside = found.outside;
    if (!p.actuators) find_motors(p, w, [&](int t) { return r.constraint_rates ? in.get(r.constraint_rates, t) : UNKNOWN_NUMBER; });
  }
  if (!r.wanted) return;
  for (int o = 0; o < r.wanted->count; ++o) {
    const OutputOf<ThreeParts> wanted = enclosed_output(r, o);
    Pack value[3];
    const int width = output_value(p, w, &balance, row_values, wanted, value);
    for (int k = 0; k < width; ++k) out.to(r.outputs).put(wanted.slot + k, value[k]);
  }
}

char* aligned(char* memory) { return memory + (64 - (std::uintptr_t)memory % 64) % 64; }

// The plan's structure alone, which the sizes of memory go by.
Plan structure_of(const LanePlan& given) {
  Plan p = {};
  static_cast<PlanShape&>(p) = given;
  p.law.reads = given.law.reads, p.law.curves = given.law.curves, p.law.constants = given.law.constants;
  p.law.inputs = given.law.inputs, p.law.instructions = given.law.instructions;
  return p;
}

long workspace_size(const LanePlan& given) {
  const Plan p = structure_of(given);
  Memory m;
  Room room = {nullptr};
  return join_all_parts(given, nullptr, nullptr, nullptr) + lay_out(p, nullptr, &m.w) + lay_out_solving(p, room, &m) + 256;
}

void enclose(const LanePlan& given, const LanePlan* low, const LanePlan* radii, const EnclosingRequest& r, char* memory) {
  char* at = aligned(memory);
  const long used = join_all_parts(given, low, radii, at);
  Plan& p = *reinterpret_cast<Plan*>(at);
  // conventions, not measures
  PlanNumber* const conventions[] = {&p.length, &p.size, &p.row_weight};
  for (PlanNumber* of : conventions) of->second = of->radius = 0.0;
  at = aligned(at + used);
  Memory m;
  at = aligned(at + lay_out(p, at, &m.w));
  Room room = {at};
  lay_out_solving(p, room, &m);
  for (long row = 0; row < r.rows; row += LANES)
    enclose_pack(p, r, m, {r.rows, row, r.rows - row < LANES ? (int)(r.rows - row) : LANES});
}

const EnclosingUnit unit = {workspace_size, enclose};

}  // namespace

extern "C" const EnclosingUnit* MECHKIN_ENCLOSING() { return &unit; }
