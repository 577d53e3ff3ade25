// Reactions by transposition (virtual power with the screws of the motion; design section 4.11).
//
// Every link needs the wrench (inertia - applied loads) from its joints. Summed over subtrees and
// projected on the screws of the unknown freedoms, it gives the wrenches of the closing joints from the
// transposed Jacobian; with these taken into the sums, `carried[k]` is what tree joint k transmits, and its
// product with an input's screw is the effort of the drive.
#pragma once

#include "motion.hpp"

namespace {

struct Powers {
  Pack sum, size;
  MECHKIN_INLINE void add(Pack x) { sum += x, size += abs(x); }
};

// Forces on links as they are met: on the link's balance, on the ledger of powers, and, where they come
// from outside, on the sum that tells the shaking wrench.
struct Balance {
  const Plan& p;
  Workspace& w;
  Powers powers;
  Wrench inertia, outside;
  bool moving;

  MECHKIN_INLINE void apply(int link, Wrench load) {
    if (link < 0) return;
    w.carried[link] -= load;
    if (moving) powers.add(power(w.motion[link].velocity, load));
  }
  MECHKIN_INLINE void apply_outside(int link, Wrench load) {
    apply(link, load);
    if (link >= 0) outside += load;
  }
};

// Wrench that accelerates link k: about the kernel's origin, gravity not included.
inline Wrench inertia_wrench(const LinkInertia& m, const Pose& pose, const Motion& motion) {
  const Vec3 centre = pose.point(m.centre);
  const Vec3 force = Pack(m.mass) * motion.point_acceleration(centre);
  const Vec3 omega = pose.components(motion.velocity.angular);
  const Vec3 alpha = pose.components(motion.acceleration.angular);
  const double* t = m.tensor;
  const auto tensor = [&](Vec3 a) -> Vec3 {
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
  for (int k = 0; k < p.links; ++k) {
    w.carried[k] = zero_wrench();
    const LinkInertia& m = p.inertia[k];
    if (!m.present) continue;
    balance.apply_outside(k, force_at(w.pose[k].point(m.centre), Pack(m.mass) * g));
    if (!accelerating) continue;
    const Wrench needed = inertia_wrench(m, w.pose[k], w.motion[k]);
    w.carried[k] += needed;
    balance.inertia += needed;
    balance.powers.add(-power(w.motion[k].velocity, needed));
  }
}

// A joint as its loads and results see it, in ground axes.
struct JointView {
  const JointPlace* place;
  Vec3 point, axis;
};
MECHKIN_INLINE JointView view_joint(const Plan& p, const Workspace& w, int reference) {
  const JointPlace& place = reference >= 0 ? p.tree_places[reference] : p.closing_places[-1 - reference];
  if (place.second < 0) return {&place, constant(place.point), constant(place.axis)};
  const Pose& pose = w.pose[place.second];
  return {&place, pose.point(place.point), pose.vector(place.axis)};
}

// Angle and slide of a closing joint and their derivatives.
struct ClosingCoordinate {
  Pack theta[3], s[3];
};
inline ClosingCoordinate closing_coordinate(const Plan& p, const Workspace& w, int c, int order) {
  const ClosingJoint& j = p.closing[c];
  const Closure& k = w.closure[c];
  ClosingCoordinate r;
  r.theta[0] = atan2(dot(k.A.Y, k.B.X), dot(k.A.X, k.B.X));
  r.s[0] = dot(k.A.Z, k.d);
  if (order < 1) return r;
  const Motion a = motion_of(w, j.first), b = motion_of(w, j.second);
  const Vec3 d1 = b.velocity.at(k.B.o) - a.velocity.at(k.A.o);
  r.theta[1] = dot(k.A.Z, b.velocity.angular - a.velocity.angular);
  r.s[1] = dot(k.A.Z, d1) + dot(a.rate(k.A.Z), k.d);
  if (order < 2) return r;
  r.theta[2] = dot(k.A.Z, b.acceleration.angular - a.acceleration.angular) +
               dot(a.rate(k.A.Z), b.velocity.angular - a.velocity.angular);
  r.s[2] = second_along(k.A.Z, k, a, b);
  return r;
}

// Value and rate of the coordinate that a joint's spring or damper works on.
inline void joint_coordinate(const Plan& p, const Workspace& w, int reference, bool slide, bool moving,
                             Pack* value, Pack* rate) {
  *rate = 0.0;
  if (reference < 0) {
    const ClosingCoordinate k = closing_coordinate(p, w, -1 - reference, moving ? 1 : 0);
    *value = slide ? k.s[0] : k.theta[0];
    if (moving) *rate = slide ? k.s[1] : k.theta[1];
    return;
  }
  const TreeJoint& j = p.joints[reference];
  const Pack scale = slide && j.type == JOINT_H ? Pack(j.pitch) : Pack(1.0);
  const int offset = slide && j.type == JOINT_C ? 1 : 0;
  *value = scale * w.q[j.state + offset];
  if (moving) *rate = scale * w.rate[j.column + offset];
}

inline void apply_along_joint(Balance& balance, int reference, bool slide, Pack value) {
  const JointView j = view_joint(balance.p, balance.w, reference);
  const Wrench load = slide ? force_at(j.point, value * j.axis) : Wrench{value * j.axis, zero3()};
  balance.apply(j.place->second, load);
  balance.apply(j.place->first, Pack(-1.0) * load);
}

// Tension of a spring or damper between two points acts on both along their line.
inline void apply_between_points(Balance& balance, const Load& l) {
  const Workspace& w = balance.w;
  const auto point = [&](int link, const double* at) { return link < 0 ? constant(at) : w.pose[link].point(at); };
  const Vec3 p = point(l.link, l.point), q = point(l.other, l.other_point), d = q - p;
  const Pack length = sqrt(dot(d, d));
  // where the ends meet the line is lost: no force if there is no tension, else no number
  const Mask apart = length > Pack(0.0);
  const Vec3 along = select(apart, Pack(1.0) / select(apart, length, Pack(1.0)), Pack(0.0)) * d;
  Pack tension;
  if (l.type == LOAD_SPRING) {
    tension = Pack(l.vector[0]) * (length - Pack(l.vector[1])) + Pack(l.vector[2]);
  } else {
    if (!balance.moving) return;
    const Vec3 rate = motion_of(w, l.other).velocity.at(q) - motion_of(w, l.link).velocity.at(p);
    tension = Pack(l.vector[0]) * dot(along, rate);
  }
  const Vec3 pull = select(apart | (tension == Pack(0.0)), tension, Pack(__builtin_nan(""))) * along;
  balance.apply(l.link, force_at(p, pull));
  balance.apply(l.other, Pack(-1.0) * force_at(p, pull));
}

inline void apply_load(Balance& balance, const Load& l) {
  const Plan& p = balance.p;
  const Workspace& w = balance.w;
  Pack value, rate;
  switch (l.type) {
    case LOAD_FORCE_GROUND:
    case LOAD_FORCE_LINK: {
      const Pose& pose = w.pose[l.link];
      const Vec3 force = l.type == LOAD_FORCE_LINK ? pose.vector(l.vector) : constant(l.vector);
      return balance.apply_outside(l.link, force_at(pose.point(l.point), force));
    }
    case LOAD_TORQUE_GROUND: return balance.apply_outside(l.link, {constant(l.vector), zero3()});
    case LOAD_TORQUE_LINK: return balance.apply_outside(l.link, {w.pose[l.link].vector(l.vector), zero3()});
    case LOAD_JOINT_TORQUE: return apply_along_joint(balance, l.link, false, Pack(l.vector[0]));
    case LOAD_JOINT_FORCE: return apply_along_joint(balance, l.link, true, Pack(l.vector[0]));
    case LOAD_SPRING:
    case LOAD_DAMPER: return apply_between_points(balance, l);
    case LOAD_JOINT_SPRING_THETA:
    case LOAD_JOINT_SPRING_S: {
      const bool slide = l.type == LOAD_JOINT_SPRING_S;
      joint_coordinate(p, w, l.link, slide, balance.moving, &value, &rate);
      return apply_along_joint(balance, l.link, slide,
                               -(Pack(l.vector[0]) * (value - Pack(l.vector[1])) + Pack(l.vector[2])));
    }
    case LOAD_JOINT_DAMPER_THETA:
    case LOAD_JOINT_DAMPER_S: {
      if (!balance.moving) return;
      const bool slide = l.type == LOAD_JOINT_DAMPER_S;
      joint_coordinate(p, w, l.link, slide, true, &value, &rate);
      return apply_along_joint(balance, l.link, slide, -(Pack(l.vector[0]) * rate));
    }
  }
}

// Closing wrenches block by block, last first: the unknowns of a block appear only in its own equations
// and in those of later blocks, whose wrenches are in the sums already.
inline void closing_wrenches(const Plan& p, Workspace& w) {
  for (int index = p.blocks - 1; index >= 0; --index) {
    const Block& b = p.block[index];
    const BlockPlaces at = places_of(p, w, index);
    for (int u = 0; u < b.size; ++u) {
      const int column = p.unknown[b.column_begin + u];
      at.multiplier[u] = power(w.screw[column], w.carried[p.column_joint[column]]);
    }
    solve_transposed({at.jacobian, at.swap, b.size}, at.multiplier);
    for (int c = b.closing_begin; c < b.closing_end; ++c) {
      const ClosingJoint& j = p.closing[c];
      with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
        w.reaction[c] = entry.wrench(w.closure[c], at.multiplier + j.row);
      });
      for (int l = j.loop_begin; l < j.loop_end; ++l)
        w.carried[p.loop[l].joint] -= Pack(p.loop[l].sign) * w.reaction[c];
    }
  }
}

// Applies everything, solves for the closing wrenches and the efforts; returns the ledger.
inline Balance balance_forces(const Plan& p, Workspace& w, bool moving, bool accelerating) {
  const Pack zero = 0.0;
  Balance balance = {p, w, {zero, zero}, zero_wrench(), zero_wrench(), moving};
  apply_inertia(balance, accelerating);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l]);
  for (int k = p.links - 1; k >= 0; --k)
    if (p.joints[k].parent >= 0) w.carried[p.joints[k].parent] += w.carried[k];
  closing_wrenches(p, w);
  for (int i = 0; i < p.inputs; ++i) {
    const int column = p.input_column[i];
    w.effort[i] = power(w.screw[column], w.carried[p.column_joint[column]]);
    if (moving) balance.powers.add(w.effort[i] * w.rate[column]);
  }
  return balance;
}

// Constraint wrench that a joint's first link exerts on the second, without drives and joint loads.
inline Wrench joint_wrench(const Workspace& w, int reference, const JointView& j) {
  const Wrench carried = reference >= 0 ? w.carried[reference] : w.reaction[-1 - reference];
  Wrench r = Pack(j.place->sign) * carried;
  if (j.place->effort_theta >= 0) r.moment -= w.effort[j.place->effort_theta] * j.axis;
  if (j.place->effort_s >= 0)
    r -= force_at(j.point, (Pack(j.place->force_per_effort) * w.effort[j.place->effort_s]) * j.axis);
  return r;
}

}  // namespace
