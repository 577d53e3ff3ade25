// The quantities that were asked for, from the workspace into the output columns.
#pragma once

#include "forces/drives.hpp"
#include "forces/powers.hpp"
#if !MECHKIN_ENCLOSES
#include "forces/rest_share.hpp"
#endif

namespace {

#if MECHKIN_ENCLOSES
// no forces with friction are enclosed
MECHKIN_INLINE Pack rest_share(const Plan&, const Workspace&) { return Pack(__builtin_nan("")); }
#endif

// Writes a pack into column `slot` of an array stored column after column; only lanes that are rows.
struct Writer {
  double* base;
  long rows, row;
  int count;
  MECHKIN_INLINE Writer to(double* other) const { return {other, rows, row, count}; }
  MECHKIN_INLINE void put(long slot, Pack x) const {
    for (int k = 0; k < PARTS; ++k) put_part(base + (PARTS * slot + k) * rows + row, part_of(x, k));
  }
  MECHKIN_INLINE void put_part(double* at, Real x) const {
    if (count == LANES) return store(at, x);
    for (int i = 0; i < count; ++i) at[i] = lane(x, i);
  }
  MECHKIN_INLINE void put(long slot, const Vec3& a) const {
    put(slot, a.x), put(slot + 1, a.y), put(slot + 2, a.z);
  }
};

template <class Number>
inline Vec3 output_point(const Plan& p, const Workspace& w, const OutputOf<Number>& o) {
  const Pack unit = p.length;
  if (o.index < 0) return o.order ? zero3() : unit * constant(o.data) + constant(p.origin);
  const Vec3 at = w.pose[o.index].point(o.data);
  if (o.order == 0) return unit * at + constant(p.origin);
  const Motion& m = w.motion[o.index];
  if (o.order == 3) return unit * motion_to_jerk(w, o.index).point_jerk(at);
  return unit * (o.order == 1 ? m.velocity.at(at) : m.point_acceleration(at));
}

// Moment about the ground's origin of a wrench of the kernel.
inline Vec3 ground_moment(const Plan& p, const Wrench& r) {
  return r.moment + (Pack(1.0) / Pack(p.length)) * cross(constant(p.origin), r.force);
}

inline Vec3 joint_force(const Plan& p, const Workspace& w, const JointPlace& j, const Wrench& r) {
  return without_free(p, w, j, true, r.force);
}
inline Vec3 joint_moment(const Plan& p, const Workspace& w, const JointPlace& j, const Wrench& r) {
  if (is_free_of_moments(p, j)) return zero3();
  return without_free(p, w, j, false, r.moment - cross(carried_point(w, j.point_on, j.point), r.force));
}
inline Vec3 output_joint(const Plan& p, const Workspace& w, int type, int index) {
  const JointPlace& j = p.place[index];
  const Wrench r = joint_wrench(p, w, j);
  return type == OUT_JOINT_FORCE ? joint_force(p, w, j, r)
         : type == OUT_JOINT_MOMENT ? joint_moment(p, w, j, r)
                                    : ground_moment(p, r);
}

inline Vec3 output_total(const Plan& p, const Workspace& w, int type, int index) {
  const JointPlace& j = p.place[index];
  if (type == OUT_TOTAL_FORCE || type == OUT_TOTAL_MOMENT) {
    const Wrench r = total_wrench(p, w, j);
    return type == OUT_TOTAL_FORCE ? r.force : r.moment;
  }
  const Wrench r = joint_wrench(p, w, j);
  if (type == OUT_CARRIED_FORCE) return r.force;
  return r.moment - cross(carried_point(w, j.point_on, j.point), r.force);
}

template <class Number>
inline Vec3 output_slip(const Plan& p, const Workspace& w, const OutputOf<Number>& o) {
  const JointPlace& j = p.place[o.index];
  return carried_point(w, j.point_on, j.point) - carried_point(w, j.second, o.data);
}

inline Vec3 output_friction(const Workspace& w, int type, int index) {
  const Wrench r = (-w.rubbing.force[index]) * w.rubbing.drag[index];
  if (type == OUT_FRICTION_FORCE) return r.force;
  return r.moment - cross(w.rubbing.point[index], r.force);
}

template <class Number>
inline Pack output_closing(const Plan& p, const Workspace& w, const OutputOf<Number>& o) {
  Pack k[4];
  closing_coordinate(p, w, o.index, o.freedom, o.order, o.order, k);
  return k[o.order];
}

// The effort of a relation along the coordinate of one of its terms.
template <class Number>
inline Pack output_multiplier(const Plan& p, const Workspace& w, const OutputOf<Number>& o) {
  const LoopEntry& e = p.loop[p.closing[o.index].loop_begin + o.freedom];
  return term_slope(p, w.curve, e.term) * w.reaction[o.index].force.x;
}

// What pulls in a strand of a relation that acts by such.
template <class Number>
inline Pack output_tension(const Workspace& w, const OutputOf<Number>& o) {
  const Pack multiplier = w.reaction[o.index].force.x;
  return Pack(o.data[0]) * multiplier + Pack(o.data[1]) * abs(multiplier) + Pack(o.data[2]);
}

template <class Number>
inline Vec3 output_bushing(const Plan& p, const Workspace& w, const OutputOf<Number>& o) {
  const Load& l = p.load[o.index];
  const Deflection d = deflection(p, w, l);
  if (o.type == OUT_BUSHING_SHIFT) return d.shift;
  if (o.type == OUT_BUSHING_TURN) return d.turn;
  Six by = bushing_force(p, w, l, d);
  if (o.freedom) {
    const Six damps = bushing_force(p, w, p.load[o.index + 1], d);
    by = {by.slides + damps.slides, by.turns + damps.turns};
  }
  return o.type == OUT_BUSHING_FORCE ? by.slides : by.turns;
}

// The value of a quantity, one pack or three; returns how many. `balance` for those that need forces, `row_value` as in
// apply_load.
template <class Number, class RowValue>
inline int output_value(const Plan& p, const Workspace& w, const Balance* balance, const RowValue& row_value,
                        const OutputOf<Number>& o, Pack* out) {
  const auto one = [out](Pack a) {
    out[0] = a;
    return 1;
  };
  const auto three = [out](const Vec3& a) {
    out[0] = a.x, out[1] = a.y, out[2] = a.z;
    return 3;
  };
  const Pack factor = o.factor;
  switch (o.type) {
    case OUT_STATE: return one(factor * w.q[o.index]);
    case OUT_RATE: return one(factor * w.rate[o.index]);
    case OUT_ACCELERATION: return one(factor * w.acceleration[o.index]);
    case OUT_JERK: return one(factor * w.jerk[o.index]);
    case OUT_CLOSING: return one(factor * output_closing(p, w, o));
    case OUT_SLIP: return three(factor * output_slip(p, w, o));
    case OUT_POINT: return three(output_point(p, w, o));
    case OUT_VECTOR: return three(carried_vector(w, o.index, o.data));
    case OUT_OMEGA: return three(w.motion[o.index].velocity.angular);
    case OUT_ALPHA: return three(w.motion[o.index].acceleration.angular);
    case OUT_JOINT_FORCE:
    case OUT_JOINT_MOMENT:
    case OUT_JOINT_MOMENT_ORIGIN: return three(factor * output_joint(p, w, o.type, o.index));
    case OUT_HOLDING_MOMENT: return one(factor * w.holding[o.index]);
    case OUT_MESH_FORCE: return three(factor * mesh_force(w, p.closing[o.index], w.reaction[o.index].force.x));
    case OUT_TENSION: return one(factor * output_tension(w, o));
    case OUT_MULTIPLIER: return one(factor * output_multiplier(p, w, o));
    case OUT_REACTION_LEVEL: return one(factor * balance->level);
    case OUT_MOTOR: return one(factor * w.actuation.motor[o.index]);
    case OUT_ACTUATION: return one(factor * *w.actuation.least);
    case OUT_TOTAL_FORCE:
    case OUT_TOTAL_MOMENT:
    case OUT_CARRIED_FORCE:
    case OUT_CARRIED_MOMENT: return three(factor * output_total(p, w, o.type, o.index));
    case OUT_EFFORT: return one(factor * w.effort[o.index]);
    case OUT_SHAKING_FORCE: return three(factor * (balance->outside - balance->inertia).force);
    case OUT_SHAKING_MOMENT: return three(factor * ground_moment(p, balance->outside - balance->inertia));
    case OUT_INERTIA_FORCE: return three((-factor) * balance->inertia.force);
    case OUT_KINETIC_ENERGY: return one(factor * kinetic_energy(p, w));
    case OUT_POTENTIAL_ENERGY: return one(factor * potential_energy(p, w, row_value));
    case OUT_LOAD_POWER: return one(factor * load_power(p, w, o.index, row_value));
    case OUT_BUSHING_FORCE:
    case OUT_BUSHING_MOMENT:
    case OUT_BUSHING_SHIFT:
    case OUT_BUSHING_TURN: return three(factor * output_bushing(p, w, o));
    case OUT_NORMAL_LOAD: return one(factor * w.rubbing.normal[o.index]);
    case OUT_FRICTION_FORCE:
    case OUT_FRICTION_MOMENT: return three(factor * output_friction(w, o.type, o.index));
    case OUT_FRICTION_POWER: return one(factor * (w.rubbing.force[o.index] * w.rubbing.speed[o.index]));
    case OUT_FRICTION_STATE: return one(w.rubbing.state[o.index]);
    case OUT_SELF_LOCKING: return one(w.rubbing.self_locking);
    case OUT_REST_SHARE: return one(rest_share(p, w));
    default: return three((-factor) * ground_moment(p, balance->inertia));  // OUT_INERTIA_MOMENT
  }
}

template <class Number, class RowValue>
inline void write_output(const Plan& p, const Workspace& w, const Balance* balance, const RowValue& row_value,
                         const OutputOf<Number>& o, const Writer& out) {
  // most columns by far are no more than read
  if (o.type == OUT_STATE || o.type == OUT_RATE || o.type == OUT_ACCELERATION) {
    const Pack* const from = o.type == OUT_STATE ? w.q : o.type == OUT_RATE ? w.rate : w.acceleration;
    return out.put(o.slot, Pack(o.factor) * from[o.index]);
  }
  Pack value[3];
  const int width = output_value(p, w, balance, row_value, o, value);
  for (int k = 0; k < width; ++k) out.put(o.slot + k, value[k]);
}

// A joint's force and moment, which are mostly asked for one after the other, from one wrench.
template <class Number>
MECHKIN_INLINE bool are_of_one_wrench(const OutputOf<Number>& force, const OutputOf<Number>& moment) {
  return force.type == OUT_JOINT_FORCE && moment.type == OUT_JOINT_MOMENT && force.index == moment.index;
}
template <class Number>
inline void write_wrench(const Plan& p, const Workspace& w, const OutputOf<Number>& force,
                         const OutputOf<Number>& moment, const Writer& out) {
  const JointPlace& j = p.place[force.index];
  const Wrench r = joint_wrench(p, w, j);
  out.put(force.slot, Pack(force.factor) * joint_force(p, w, j, r));
  out.put(moment.slot, Pack(moment.factor) * joint_moment(p, w, j, r));
}

}  // namespace
