// Energies and powers of a row, each part by itself: from masses, places and velocities, from what the loads are and the
// velocities where they act, and from efforts and rates of the drives. The balance of powers shares no sum with the
// balance of forces, and so tells whether that one took every load as it is.
//
//     d(kinetic energy)/dt = powers of gravity, springs, dampers, forces and torques + efforts by rates
#pragma once

#include "forces/wrenches.hpp"

namespace {

// The sum of the powers' parts, and the sum of their magnitudes.
struct Powers {
  Pack sum, size;
  MECHKIN_INLINE void add(Pack x) { sum += x, size += abs(x); }
  // a.b component by component: what cancels within it is no rounding of the balance
  MECHKIN_INLINE void add(const Vec3& a, const Vec3& b) { add(a.x * b.x), add(a.y * b.y), add(a.z * b.z); }
};

// I a, a in the link's axes.
inline Vec3 times_tensor(const LinkInertia& m, const Vec3& a) {
  const auto* t = m.tensor;
  return {Pack(t[0]) * a.x + Pack(t[3]) * a.y + Pack(t[4]) * a.z, Pack(t[3]) * a.x + Pack(t[1]) * a.y + Pack(t[5]) * a.z,
          Pack(t[4]) * a.x + Pack(t[5]) * a.y + Pack(t[2]) * a.z};
}

// sum of m v.v/2 + omega.I omega/2.
inline Pack kinetic_energy(const Plan& p, const Workspace& w) {
  Pack twice = 0.0;
  for (int k = 0; k < p.links; ++k) {
    const LinkInertia& m = p.inertia[k];
    if (!m.present) continue;
    const Twist& moves = w.motion[k].velocity;
    const Vec3 v = moves.at(w.pose[k].point(m.centre)), omega = w.pose[k].components(moves.angular);
    twice += Pack(m.mass) * dot(v, v) + dot(omega, times_tensor(m, omega));
  }
  return Pack(0.5) * twice;
}

// Of a spring stretched by x beyond its free length or angle: k x^2/2 + preload x.
MECHKIN_INLINE Pack spring_energy(const Load& l, Pack stretch) {
  return (Pack(0.5) * Pack(l.vector[0]) * stretch + Pack(l.vector[2])) * stretch;
}

// Of gravity, zero at the ground's origin, and of springs, zero where they have their free length or angle.
template <class RowValue>
inline Pack potential_energy(const Plan& p, const Workspace& w, const RowValue& row_value) {
  Pack energy = 0.0, value, rate;
  const Vec3 g = constant(p.gravity), origin = (Pack(1.0) / Pack(p.length)) * constant(p.origin);
  for (int k = 0; k < p.links; ++k) {
    const LinkInertia& m = p.inertia[k];
    if (m.present) energy -= Pack(m.mass) * dot(g, w.pose[k].point(m.centre) + origin);
  }
  for (int i = 0; i < p.loads; ++i) {
    const Load& l = p.load[i];
    if (l.type == LOAD_SPRING) {
      const Vec3 d = carried_point(w, l.other, l.other_point) - carried_point(w, l.link, l.point);
      energy += spring_energy(l, sqrt(dot(d, d)) - Pack(l.vector[1]));
    } else if (l.type == LOAD_COORDINATE_SPRING) {
      joint_coordinate(p, w, l, false, &value, &rate);
      energy += spring_energy(l, row_value.turned(l.turn, l.other < 0, value) - Pack(l.vector[1]));
    } else if (l.type == LOAD_BUSHING) {
      energy += bushing_energy(p, w, l);
    }
  }
  return energy;
}

inline void add_gravity_power(Powers& powers, const Plan& p, const Workspace& w, int link) {
  const LinkInertia& m = p.inertia[link];
  powers.add(Pack(m.mass) * constant(p.gravity), w.motion[link].velocity.at(w.pose[link].point(m.centre)));
}

// d/dt (m v.v/2 + omega.I omega/2) = m v.v' + omega.I omega', about the mass centre in the link's axes.
inline void add_kinetic_power(Powers& powers, const LinkInertia& m, const Pose& pose, const Motion& motion) {
  const Vec3 centre = pose.point(m.centre);
  powers.add(-Pack(m.mass) * motion.velocity.at(centre), motion.point_acceleration(centre));
  const Vec3 omega = pose.components(motion.velocity.angular), alpha = pose.components(motion.acceleration.angular);
  powers.add(-omega, times_tensor(m, alpha));
}

// The power that a spring or damper between two points puts in: its tension by the rate at which they come nearer.
inline void add_power_between_points(Powers& powers, const Workspace& w, const Load& l) {
  const Vec3 a = carried_point(w, l.link, l.point), b = carried_point(w, l.other, l.other_point), d = b - a;
  const Vec3 apart = motion_of(w, l.other).velocity.at(b) - motion_of(w, l.link).velocity.at(a);
  const Pack length = sqrt(dot(d, d));
  const Vec3 along = inverse_or_zero(length) * d;
  const Pack tension = l.type == LOAD_SPRING ? Pack(l.vector[0]) * (length - Pack(l.vector[1])) + Pack(l.vector[2])
                                             : Pack(l.vector[0]) * dot(along, apart);
  powers.add(-tension * along, apart);
}

// Of a bushing: its forces by the rates of its deflection, or by the velocities that a damper goes by.
inline void add_bushing_power(Powers& powers, const Plan& p, const Workspace& w, const Load& l) {
  const Bushing& b = p.bushing[l.freedom];
  const Deflection d = deflection(p, w, l);
  const Six moves = deflection_velocity(w, l, d);
  const bool damps = l.type == LOAD_BUSHING_DAMPER;
  const Six by = times_matrix(b, damps ? moves : stretch(b, d));
  powers.add(-by.slides, moves.slides);
  powers.add(-by.turns, damps ? moves.turns : d.turn_rate(moves.turns));
}

template <class RowValue>
inline void add_load_power(Powers& powers, const Plan& p, const Workspace& w, const Load& l,
                           const RowValue& row_value) {
  Pack value, rate;
  switch (l.type) {
    case LOAD_FORCE_GROUND:
    case LOAD_FORCE_LINK: {
      const Vec3 velocity = w.motion[l.link].velocity.at(w.pose[l.link].point(l.point));
      const Vec3 force = load_vector(w, l);
      return powers.add(force, l.type == LOAD_FORCE_LINK ? w.pose[l.link].components(velocity) : velocity);
    }
    case LOAD_TORQUE_GROUND: return powers.add(load_vector(w, l), w.motion[l.link].velocity.angular);
    case LOAD_TORQUE_LINK:
      return powers.add(load_vector(w, l), w.pose[l.link].components(w.motion[l.link].velocity.angular));
    case LOAD_SPRING:
    case LOAD_DAMPER: return add_power_between_points(powers, w, l);
    case LOAD_COORDINATE:
      joint_coordinate(p, w, l, true, &value, &rate);
      return powers.add((l.varying < 0 ? Pack(l.vector[0]) : w.load[l.varying]) * rate);
    case LOAD_COORDINATE_SPRING:
      joint_coordinate(p, w, l, true, &value, &rate);
      value = row_value.turned(l.turn, l.other < 0, value);
      return powers.add(-(Pack(l.vector[0]) * (value - Pack(l.vector[1])) + Pack(l.vector[2])) * rate);
    case LOAD_COORDINATE_DAMPER:
      joint_coordinate(p, w, l, true, &value, &rate);
      return powers.add(-(Pack(l.vector[0]) * rate) * rate);
    case LOAD_BUSHING:
    case LOAD_BUSHING_DAMPER: return add_bushing_power(powers, p, w, l);
  }
}

// Power that load `index` puts in, that of gravity with -1.
template <class RowValue>
inline Pack load_power(const Plan& p, const Workspace& w, int index, const RowValue& row_value) {
  Powers powers = {Pack(0.0), Pack(0.0)};
  if (index >= 0)
    add_load_power(powers, p, w, p.load[index], row_value);
  else
    for (int k = 0; k < p.links; ++k)
      if (p.inertia[k].present) add_gravity_power(powers, p, w, k);
  return powers.sum;
}

}  // namespace
