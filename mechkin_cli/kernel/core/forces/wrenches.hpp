// Wrenches on the links: of inertia, of loads, of what joints transmit, at the states and rates as they are.
#pragma once

#include "arithmetic/lost_direction.hpp"
#include "forces/bushings.hpp"

namespace {

// Forces on links as they are met: on the link's balance and, where they come from outside, on the sum that tells the
// shaking wrench.
struct Balance {
  const Plan& p;
  Workspace& w;
  Wrench inertia, outside;
  bool moving;
  Pack level;  // of the joints' wrenches, where it is wanted

  MECHKIN_INLINE void apply(int link, const Wrench& load) {
    if (link < 0) return;
    w.carried[link] -= load;
  }
  MECHKIN_INLINE void apply_outside(int link, const Wrench& load) {
    apply(link, load);
    if (link >= 0) outside += load;
  }
};

// Wrench that accelerates a link whose mass centre is at `centre`: about the kernel's origin, gravity not included.
inline Wrench inertia_wrench(const LinkInertia& m, const Pose& pose, const Vec3& centre, const Motion& motion) {
  const Vec3 force = Pack(m.mass) * motion.point_acceleration(centre);
  const Vec3 omega = pose.components(motion.velocity.angular);
  const Vec3 alpha = pose.components(motion.acceleration.angular);
  const auto* t = m.tensor;
  const auto tensor = [&](const Vec3& a) -> Vec3 {
    return {Pack(t[0]) * a.x + Pack(t[3]) * a.y + Pack(t[4]) * a.z,
            Pack(t[3]) * a.x + Pack(t[1]) * a.y + Pack(t[5]) * a.z,
            Pack(t[4]) * a.x + Pack(t[5]) * a.y + Pack(t[2]) * a.z};
  };
  const Vec3 couple = tensor(alpha) + cross(omega, tensor(omega));
  Wrench r = force_at(centre, force);
  r.moment += couple.x * pose.X + couple.y * pose.Y + couple.z * pose.Z;
  return r;
}

inline void apply_inertia(Balance& balance, bool accelerating) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  const Vec3 g = constant(p.gravity);
  Wrench inertia = balance.inertia, outside = balance.outside;
  for (int k = 0; k < p.links; ++k) {
    Wrench carried = zero_wrench();
    const LinkInertia& m = p.inertia[k];
    if (m.present) {
      const Vec3 centre = w.pose[k].point(m.centre);
      const Wrench weight = force_at(centre, Pack(m.mass) * g);
      carried -= weight, outside += weight;
      if (accelerating) {
        const Wrench needed = inertia_wrench(m, w.pose[k], centre, w.motion[k]);
        carried += needed, inertia += needed;
      }
    }
    w.carried[k] = carried;
  }
  balance.inertia = inertia, balance.outside = outside;
}

// The force of work one per unit of a parameter of a course and of none by another one, on the joint's second link: in the
// plane of the slopes, of their dual basis.
inline Vec3 along_course(const Plan& p, const Workspace& w, const CoordinateAxis& c) {
  const TreeJoint& t = p.joints[c.carrier];
  const Vec3* const slope = w.course[c.carrier].slope;
  Vec3 own = slope[c.freedom];
  if (p.functions.function[t.function].arguments > 1) {
    const Vec3 other = slope[1 - c.freedom];
    own -= (dot(own, other) / dot(other, other)) * other;
  }
  return w.pose[c.carrier].vector((Pack(p.place[c.place].sign) / dot(own, own)) * own);
}

// The wrench `value` along a coordinate, on the joint's second link.
inline Wrench along_coordinate(const Plan& p, const Workspace& w, int axis, Pack value) {
  const CoordinateAxis& c = p.axis[axis];
  if (c.carrier >= 0) {
    const JointPlace& j = p.place[c.place];
    return force_at(carried_point(w, j.point_on, j.point), value * along_course(p, w, c));
  }
  const Vec3 direction = carried_vector(w, c.link[0], c.vector[0]) + carried_vector(w, c.link[1], c.vector[1]);
  if (!c.slide) return {value * direction, zero3()};
  const JointPlace& j = p.place[c.place];
  return force_at(carried_point(w, j.point_on, j.point), value * direction);
}

// A coordinate of a closing joint and its derivatives, those from `from` to `order`.
inline void closing_coordinate(const Plan& p, const Workspace& w, int c, int freedom, int from, int order, Pack* out) {
  const ClosingJoint& j = p.closing[c];
  const auto motion_at = [&](int link) -> LinkMotion { return {w.motion[link], w.link_jerk[link]}; };
  const PairMotion motion = {motion_at(j.first), motion_at(j.second), from, order};
  with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    entry.coordinate(closure_with(p, w, c, entry.axes_of(freedom)), motion, freedom, out);
  });
}

// Value and rate of the coordinate along an axis, a freedom of the joint that `reference` tells as JointPlace does.
inline void joint_coordinate(const Plan& p, const Workspace& w, int axis, int reference, int freedom, bool moving,
                             Pack* value, Pack* rate) {
  *rate = 0.0;
  if (reference < 0) {
    Pack k[4];
    closing_coordinate(p, w, -1 - reference, freedom, 0, moving ? 1 : 0, k);
    *value = k[0];
    if (moving) *rate = k[1];
    return;
  }
  const TreeJoint& j = p.joints[reference];
  const Pack scale = j.type == TREE_H && p.axis[axis].slide ? Pack(j.pitch) : Pack(1.0);
  *value = scale * w.q[j.state + freedom];
  if (moving) *rate = scale * w.rate[j.column + freedom];
}

// Of the coordinate that a spring or damper works on.
inline void joint_coordinate(const Plan& p, const Workspace& w, const Load& l, bool moving, Pack* value, Pack* rate) {
  joint_coordinate(p, w, l.link, l.other, l.freedom, moving, value, rate);
}

inline void apply_along_coordinate(Balance& balance, int axis, Pack value) {
  const Plan& p = balance.p;
  const JointPlace& j = p.place[p.axis[axis].place];
  const Wrench load = along_coordinate(p, balance.w, axis, value);
  balance.apply(j.second, load);
  balance.apply(j.first, Pack(-1.0) * load);
}

// Tension of a spring or damper between two points acts on both along their line.
inline void apply_between_points(Balance& balance, const Load& l) {
  const Workspace& w = balance.w;
  const Vec3 p = carried_point(w, l.link, l.point), q = carried_point(w, l.other, l.other_point), d = q - p;
  const Pack length = sqrt(dot(d, d));
  const Vec3 along = inverse_or_zero(length) * d;
  Pack tension;
  if (l.type == LOAD_SPRING) {
    tension = Pack(l.vector[0]) * (length - Pack(l.vector[1])) + Pack(l.vector[2]);
  } else {
    if (!balance.moving) return;
    const Vec3 rate = motion_of(w, l.other).velocity.at(q) - motion_of(w, l.link).velocity.at(p);
    tension = Pack(l.vector[0]) * dot(along, rate);
  }
  const Vec3 pull = known_tension(length, tension) * along;
  balance.apply(l.link, force_at(p, pull));
  balance.apply(l.other, Pack(-1.0) * force_at(p, pull));
}

inline void apply_bushing(Balance& balance, const Load& l) {
  if (l.type == LOAD_BUSHING_DAMPER && !balance.moving) return;
  const Wrench on_second = bushing_wrench(balance.p, balance.w, l);
  balance.apply(l.other, on_second);
  balance.apply(l.link, Pack(-1.0) * on_second);
}

MECHKIN_INLINE Vec3 load_vector(const Workspace& w, const Load& l) {
  if (l.varying < 0) return constant(l.vector);
  return {w.load[l.varying], w.load[l.varying + 1], w.load[l.varying + 2]};
}

// `row_value` gives angles with their whole turns.
template <class RowValue>
inline void apply_load(Balance& balance, const Load& l, const RowValue& row_value) {
  const Plan& p = balance.p;
  const Workspace& w = balance.w;
  Pack value, rate;
  switch (l.type) {
    case LOAD_FORCE_GROUND:
    case LOAD_FORCE_LINK: {
      const Pose& pose = w.pose[l.link];
      const Vec3 given = load_vector(w, l);
      const Vec3 force = l.type == LOAD_FORCE_LINK ? pose.vector(given) : given;
      return balance.apply_outside(l.link, force_at(pose.point(l.point), force));
    }
    case LOAD_TORQUE_GROUND: return balance.apply_outside(l.link, {load_vector(w, l), zero3()});
    case LOAD_TORQUE_LINK:
      return balance.apply_outside(l.link, {w.pose[l.link].vector(load_vector(w, l)), zero3()});
    case LOAD_COORDINATE:
      return apply_along_coordinate(balance, l.link, l.varying < 0 ? Pack(l.vector[0]) : w.load[l.varying]);
    case LOAD_SPRING:
    case LOAD_DAMPER: return apply_between_points(balance, l);
    case LOAD_COORDINATE_SPRING:
      joint_coordinate(p, w, l, balance.moving, &value, &rate);
      value = row_value.turned(l.turn, l.other < 0, value);
      return apply_along_coordinate(balance, l.link,
                                    -(Pack(l.vector[0]) * (value - Pack(l.vector[1])) + Pack(l.vector[2])));
    case LOAD_COORDINATE_DAMPER:
      if (!balance.moving) return;
      joint_coordinate(p, w, l, true, &value, &rate);
      return apply_along_coordinate(balance, l.link, -(Pack(l.vector[0]) * rate));
    case LOAD_BUSHING:
    case LOAD_BUSHING_DAMPER: return apply_bushing(balance, l);
  }
}

// What a hung body needs as a whole comes from its ends: across its line from the balance of moments about them, along its
// line all from the start, but for the tension that the closing equation's multiplier adds to both. A moment about the
// line is no end's to give: it is what would hold the body from spinning.
inline void hang_on_ends(const Plan& p, Workspace& w, int body) {
  const TreeJoint& j = p.joints[body];
  const HungBody& hung = p.hung[j.hung];
  const Wrench needed = w.carried[body];
  const Vec3 A = w.pose[body].o, B = carried_point(w, hung.second, hung.point), d = B - A;
  const Pack square = dot(d, d);
  const Vec3 moment = needed.moment - cross(A, needed.force);
  const Vec3 across = (Pack(1.0) / square) * cross(moment, d);
  w.across[j.hung] = across;
  w.holding[j.hung] = dot(moment, d) / sqrt(square);
  const Wrench at_start = force_at(A, needed.force - across), at_end = force_at(B, across);
  w.carried[body] = at_start;
  if (hung.rod >= 0) w.carried[hung.rod] -= at_end;
  if (hung.first >= 0) w.carried[hung.first] += at_start;
  if (hung.second >= 0) w.carried[hung.second] += at_end;
}

// The tension into the wrenches of the body's two spheres; the rod has it from the loop.
inline void stretch_hung_bodies(const Plan& p, Workspace& w) {
  for (int l = 0; l < p.hung_bodies; ++l) {
    const HungBody& hung = p.hung[l];
    w.carried[hung.body] += w.reaction[hung.closing];
    w.reaction[hung.closing] -= force_at(carried_point(w, hung.second, hung.point), w.across[l]);
  }
}

// What each link needs of its joints (w.carried), summed over what the tree hangs on it.
inline void sum_over_tree(const Plan& p, Workspace& w) {
  for (int k = p.links - 1; k >= 0; --k)
    if (p.joints[k].type == TREE_L)
      hang_on_ends(p, w, k);
    else if (p.joints[k].parent >= 0)
      w.carried[p.joints[k].parent] += w.carried[k];
}

// The generalised efforts that the closing wrenches of a block balance, one for each of its unknowns.
inline void unknown_efforts(const Plan& p, const Workspace& w, int index, Pack* effort) {
  const Block& b = p.block[index];
  for (int u = 0; u < b.size; ++u) {
    const int column = p.unknown[b.column_begin + u];
    effort[u] = power(w.screw[column], w.carried[p.column_joint[column]]);
  }
}

// What a relation that acts by forces exerts by the one in a frame: teeth push along the flank that bears, and always apart,
// by the magnitude `size` of the multiplier.
inline Vec3 force_by(const Workspace& w, const ClosingJoint& j, const Frame& f, Pack multiplier, Pack size) {
  return multiplier * carried_vector(w, j.first, f.x) + size * carried_vector(w, j.first, f.y);
}
inline Wrench wrench_by(const Workspace& w, const ClosingJoint& j, Pack multiplier, Pack size) {
  const auto by = [&](const Frame& f) { return force_at(carried_point(w, j.first, f.o), force_by(w, j, f, multiplier, size)); };
  Wrench r = by(j.on_first);
  if (j.is_pair_of_forces) r += by(j.on_second);
  return r;
}
inline Vec3 mesh_force(const Workspace& w, const ClosingJoint& j, Pack multiplier) {
  return force_by(w, j, j.on_first, multiplier, abs(multiplier));
}
// What it pushes apart with by a unit of that magnitude, as a force on the second link.
inline Wrench push_of(const Plan& p, const Workspace& w, const JointPlace& place) {
  return wrench_by(w, p.closing[-1 - place.reference], Pack(0.0), Pack(1.0));
}
inline void transmit_by_force(const Plan& p, Workspace& w, int c, Pack multiplier) {
  const ClosingJoint& j = p.closing[c];
  const Wrench r = wrench_by(w, j, multiplier, j.is_pushed ? Pack(0.0) : abs(multiplier));
  for (int l = j.path_begin; l < j.path_end; ++l) w.carried[p.loop[l].joint] -= Pack(p.loop[l].sign) * r;
}

inline bool is_on_way(const Plan& p, const ClosingJoint& j, int joint) {
  for (int l = j.path_begin; l < j.path_end; ++l)
    if (p.loop[l].joint == joint) return true;
  return false;
}

// A relation acts along its coordinates, on each joint's second link and opposite on its first, but for those that the way
// of its force passes. Its multiplier stands where a closing joint's wrench does.
inline void transmit(const Plan& p, Workspace& w, int c, Pack multiplier) {
  const ClosingJoint& j = p.closing[c];
  w.reaction[c] = {zero3(), {multiplier, Pack(0.0), Pack(0.0)}};
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const LoopEntry& e = p.loop[l];
    if (is_on_way(p, j, e.joint)) continue;
    const Term& t = p.term[e.term];
    w.carried[e.joint] -= Pack(e.sign) * along_coordinate(p, w, t.axis, term_slope(p, w.curve, e.term) * multiplier);
  }
  if (j.path_end) transmit_by_force(p, w, c, multiplier);
}

// The wrenches of a block's closing joints from the multipliers of its equations, and into the sums.
inline void take_closing_wrenches(const Plan& p, Workspace& w, int index, const Pack* multiplier) {
  const Block& b = p.block[index];
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    if (is_relation(j.type)) {
      transmit(p, w, c, multiplier[j.row]);
      continue;
    }
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      if constexpr (!entry.is_relation) w.reaction[c] = entry.wrench(w.closure[c], multiplier + j.row);
    });
    for (int l = j.loop_begin; l < j.loop_end; ++l)
      w.carried[p.loop[l].joint] -= Pack(p.loop[l].sign) * w.reaction[c];
  }
}

// Efforts of the inputs, once the tree's joints carry what they transmit.
inline void input_efforts(const Plan& p, Workspace& w) {
  for (int i = 0; i < p.inputs; ++i) {
    const int column = p.input_column[i];
    w.effort[i] = power(w.screw[column], w.carried[p.column_joint[column]]);
  }
}

// Wrench that a joint's first link exerts on the second, without joint loads.
MECHKIN_INLINE Wrench transmitted_wrench(const Workspace& w, const JointPlace& j) {
  return Pack(j.sign) * (j.reference < 0 ? w.reaction[-1 - j.reference] : w.carried[j.reference]);
}
// The same by its constraints, without drives.
inline Wrench joint_wrench(const Plan& p, const Workspace& w, const JointPlace& j) {
  Wrench r = transmitted_wrench(w, j);
  for (int d = j.drive_begin; d < j.drive_end; ++d) {
    const Drive& drive = p.drive[d];
    r -= along_coordinate(p, w, drive.axis, Pack(drive.scale) * w.effort[drive.input]);
  }
  return r;
}

// Without what acts along free motions from the `first` on; of two directions the second is taken square to the first.
inline Vec3 take_free_out(const Plan& p, const Workspace& w, const JointPlace& j, int first, Vec3 a) {
  const int slide = p.free[first].slide;
  Vec3 before = zero3();
  for (int f = first; f < j.free_end; ++f) {
    const FreeMotion& free = p.free[f];
    if (free.slide != slide) continue;
    if (free.code == FREE_ALL) return zero3();
    Vec3 u = carried_vector(w, free.link, free.vector);
    if (free.code == FREE_SQUARE) return dot(u, a) * u;
    if (f > first) u = u - dot(before, u) * before;
    a = a - (dot(u, a) * inverse_or_zero(dot(u, u))) * u;
    before = u;
  }
  return a;
}
// What a force, or a moment about its point, of a joint keeps where it leaves motions free: what is zero by the kind of
// joint is zero, and no rounding.
MECHKIN_INLINE Vec3 without_free(const Plan& p, const Workspace& w, const JointPlace& j, bool slide, const Vec3& a) {
  for (int f = j.free_begin; f < j.free_end; ++f)
    if ((p.free[f].slide != 0) == slide) return take_free_out(p, w, j, f, a);
  return a;
}
// Whether nothing is kept.
MECHKIN_INLINE bool is_free_of_moments(const Plan& p, const JointPlace& j) {
  for (int f = j.free_begin; f < j.free_end; ++f)
    if (!p.free[f].slide && p.free[f].code == FREE_ALL) return true;
  return false;
}

}  // namespace
