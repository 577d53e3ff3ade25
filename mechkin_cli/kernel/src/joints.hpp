// The joint table: everything the kernel knows about a joint type stands in its one entry.
//
// As a tree joint an entry gives the displacement of its frame (z: the axis) and its freedom screws,
// which are fixed in the parent link. As a closing joint it gives 6 - f closing equations between the
// frame A on the first link and B on the second, their derivatives, the wrenches it transmits and the
// side condition that tells a true assembly from a false root of the equations.
//
// Equations are lengths along A's axes (S and R: ground axes) and angles; d = B.o - A.o. The Jacobian
// of an equation is the product of its wrench with the relative twist of B against A, exact where the
// joint is closed.
#pragma once

#include "elementary.hpp"
#include "plan.hpp"
#include "vector.hpp"

namespace {

// Frames of a closing joint in ground axes.
struct Closure {
  Pose A, B;
  Vec3 d;
};

MECHKIN_INLINE Pose placed(const Frame& f, const Pose* link) {
  if (!link) return {constant(f.x), constant(f.y), constant(f.z), constant(f.o)};
  return {link->vector(f.x), link->vector(f.y), link->vector(f.z), link->point(f.o)};
}

MECHKIN_INLINE void turn_about_z(Pose& p, Pack angle) {
  Pack s, c;
  sincos(angle, s, c);
  const Vec3 x = p.X;
  p.X = c * x + s * p.Y;
  p.Y = c * p.Y - s * x;
}
MECHKIN_INLINE Twist turning(const Pose& p) { return {p.Z, cross(p.o, p.Z)}; }
MECHKIN_INLINE Twist sliding(const Pose& p) { return {zero3(), p.Z}; }

// The two equations x_A.z_B = y_A.z_B = 0 that make axes parallel, with z_A.z_B > 0 beside them.
struct ParallelAxes {
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.X, k.B.Z);
    r[1] = dot(k.A.Y, k.B.Z);
  }
  static MECHKIN_INLINE void column(const Closure& k, Vec3 relative_omega, Pack* r) {
    const Vec3 n = cross(k.B.Z, relative_omega);  // omega.(z_B x x_A) = -x_A.(z_B x omega)
    r[0] = -dot(k.A.X, n);
    r[1] = -dot(k.A.Y, n);
  }
  static MECHKIN_INLINE Vec3 moment(const Closure& k, const Pack* l) {
    return cross(k.B.Z, l[0] * k.A.X + l[1] * k.A.Y);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 z1 = b.rate(k.B.Z), z2 = b.second_rate(k.B.Z);
    r[0] = dot(a.second_rate(k.A.X), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.X), z1) + dot(k.A.X, z2);
    r[1] = dot(a.second_rate(k.A.Y), k.B.Z) + Pack(2.0) * dot(a.rate(k.A.Y), z1) + dot(k.A.Y, z2);
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return dot(k.A.Z, k.B.Z) > Pack(0.0); }
};

// Second derivative of axis.d for an axis carried by link a.
MECHKIN_INLINE Pack second_along(Vec3 axis, const Closure& k, const Motion& a, const Motion& b) {
  const Vec3 d1 = b.velocity.at(k.B.o) - a.velocity.at(k.A.o);
  const Vec3 d2 = b.point_acceleration(k.B.o) - a.point_acceleration(k.A.o);
  return dot(axis, d2) + Pack(2.0) * dot(a.rate(axis), d1) + dot(a.second_rate(axis), k.d);
}

struct Revolute {
  static constexpr char letter[] = "R";
  static constexpr int freedoms = 1, states = 1, equations = 5, lengths = 3;
  static constexpr int slides = 0;
  static constexpr bool theta = true, s = false;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Pack* q) { turn_about_z(p, q[0]); }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, Twist* s) {
    s[0] = turning(p);
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = k.d.x, r[1] = k.d.y, r[2] = k.d.z;
    ParallelAxes::residual(k, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Vec3 omega, Vec3 at_b, Pack* r) {
    r[0] = at_b.x, r[1] = at_b.y, r[2] = at_b.z;
    ParallelAxes::column(k, omega, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 d2 = b.point_acceleration(k.B.o) - a.point_acceleration(k.A.o);
    r[0] = d2.x, r[1] = d2.y, r[2] = d2.z;
    ParallelAxes::second(k, a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, {l[0], l[1], l[2]});
    w.moment += ParallelAxes::moment(k, l + 3);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
};

struct Prismatic {
  static constexpr char letter[] = "P";
  static constexpr int freedoms = 1, states = 1, equations = 5, lengths = 2;
  static constexpr int slides = 1;
  static constexpr bool theta = false, s = true;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Pack* q) { p.o += q[0] * p.Z; }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, Twist* s) {
    s[0] = sliding(p);
  }
  // The rotation that carries A onto B, as a rotation vector in ground axes. Its skew part alone
  // would vanish at half a turn as well and give false assemblies.
  static MECHKIN_INLINE Vec3 rotation_error(const Closure& k) {
    const Vec3 skew = Pack(0.5) * (cross(k.A.X, k.B.X) + cross(k.A.Y, k.B.Y) + cross(k.A.Z, k.B.Z));
    const Pack c = Pack(0.5) * (dot(k.A.X, k.B.X) + dot(k.A.Y, k.B.Y) + dot(k.A.Z, k.B.Z) - Pack(1.0));
    const Pack s = sqrt(dot(skew, skew));
    const Pack angle = atan2(s, c);
    // at exactly half a turn the axis is lost; any axis keeps the residual at pi
    const Mask tiny = s < Pack(1e-150);
    const Vec3 lost = {select(c < Pack(0.0), angle, Pack(0.0)), Pack(0.0), Pack(0.0)};
    return select(tiny, lost, (angle / select(tiny, Pack(1.0), s)) * skew);
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.X, k.d), r[1] = dot(k.A.Y, k.d);
    const Vec3 e = rotation_error(k);
    r[2] = e.x, r[3] = e.y, r[4] = e.z;
  }
  static MECHKIN_INLINE void column(const Closure& k, Vec3 omega, Vec3 at_b, Pack* r) {
    r[0] = dot(k.A.X, at_b), r[1] = dot(k.A.Y, at_b);
    r[2] = omega.x, r[3] = omega.y, r[4] = omega.z;
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.A.X, k, a, b), r[1] = second_along(k.A.Y, k, a, b);
    const Vec3 e = b.acceleration.angular - a.acceleration.angular;
    r[2] = e.x, r[3] = e.y, r[4] = e.z;
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, l[0] * k.A.X + l[1] * k.A.Y);
    w.moment += {l[2], l[3], l[4]};
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure&) { return all_lanes(true); }
};

// H closes no loop: its turn count would be lost.
struct Helical {
  static constexpr char letter[] = "H";
  static constexpr int freedoms = 1, states = 1, equations = 0, lengths = 0;
  static constexpr int slides = 0;
  static constexpr bool theta = true, s = true;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint& j, const Pack* q) {
    turn_about_z(p, q[0]);
    p.o += (Pack(j.pitch) * q[0]) * p.Z;
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint& j, const Pose*, Twist* s) {
    s[0] = turning(p);
    s[0].linear += Pack(j.pitch) * p.Z;
  }
};

struct Cylindric {
  static constexpr char letter[] = "C";
  static constexpr int freedoms = 2, states = 2, equations = 4, lengths = 2;
  static constexpr int slides = 2;
  static constexpr bool theta = true, s = true;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Pack* q) {
    turn_about_z(p, q[0]);
    p.o += q[1] * p.Z;
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, Twist* s) {
    s[0] = turning(p);
    s[1] = sliding(p);
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.X, k.d), r[1] = dot(k.A.Y, k.d);
    ParallelAxes::residual(k, r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Vec3 omega, Vec3 at_b, Pack* r) {
    r[0] = dot(k.A.X, at_b), r[1] = dot(k.A.Y, at_b);
    ParallelAxes::column(k, omega, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.A.X, k, a, b), r[1] = second_along(k.A.Y, k, a, b);
    ParallelAxes::second(k, a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, l[0] * k.A.X + l[1] * k.A.Y);
    w.moment += ParallelAxes::moment(k, l + 2);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
};

// State: unit quaternion of the child against the joint's frame in the parent. Columns: rotation
// about that frame's axes, so that the screws are fixed in the parent.
struct Spheric {
  static constexpr char letter[] = "S";
  static constexpr int freedoms = 3, states = 4, equations = 3, lengths = 3;
  static constexpr int slides = 0;
  static constexpr bool theta = false, s = false;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Pack* q) {
    const Pack w = q[0], x = q[1], y = q[2], z = q[3], two = 2.0, one = 1.0;
    const Vec3 X = p.X, Y = p.Y, Z = p.Z;
    p.X = (one - two * (y * y + z * z)) * X + (two * (x * y + w * z)) * Y + (two * (x * z - w * y)) * Z;
    p.Y = (two * (x * y - w * z)) * X + (one - two * (x * x + z * z)) * Y + (two * (y * z + w * x)) * Z;
    p.Z = cross(p.X, p.Y);
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint& j, const Pose* parent, Twist* s) {
    const Pose f = placed(j.at, parent);
    s[0] = {f.X, cross(p.o, f.X)};
    s[1] = {f.Y, cross(p.o, f.Y)};
    s[2] = {f.Z, cross(p.o, f.Z)};
  }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = k.d.x, r[1] = k.d.y, r[2] = k.d.z;
  }
  static MECHKIN_INLINE void column(const Closure&, Vec3, Vec3 at_b, Pack* r) {
    r[0] = at_b.x, r[1] = at_b.y, r[2] = at_b.z;
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 d2 = b.point_acceleration(k.B.o) - a.point_acceleration(k.A.o);
    r[0] = d2.x, r[1] = d2.y, r[2] = d2.z;
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    return force_at(k.B.o, {l[0], l[1], l[2]});
  }
  static MECHKIN_INLINE Mask side(const Closure&) { return all_lanes(true); }
};

// Calls f with the entry of a tree joint.
template <class F>
MECHKIN_INLINE void with_tree_joint(int type, F&& f) {
  switch (type) {
    case JOINT_R: return f(Revolute{});
    case JOINT_P: return f(Prismatic{});
    case JOINT_H: return f(Helical{});
    case JOINT_C: return f(Cylindric{});
    case JOINT_S: return f(Spheric{});
  }
}
// Calls f with the entry of a closing joint.
template <class F>
MECHKIN_INLINE void with_closing_joint(int type, F&& f) {
  switch (type) {
    case JOINT_R: return f(Revolute{});
    case JOINT_P: return f(Prismatic{});
    case JOINT_C: return f(Cylindric{});
    case JOINT_S: return f(Spheric{});
  }
}

// Moves a joint's state by increments of its columns.
template <class Joint>
MECHKIN_INLINE void advance(Joint, Pack* q, const Pack* delta, Mask moving) {
  for (int i = 0; i < Joint::freedoms; ++i) q[i] = select(moving, q[i] + delta[i], q[i]);
}
MECHKIN_INLINE void advance(Spheric, Pack* q, const Pack* delta, Mask moving) {
  const Vec3 half = Pack(0.5) * Vec3{delta[0], delta[1], delta[2]};
  const Pack angle = sqrt(dot(half, half));
  Pack s, c;
  sincos(angle, s, c);
  const Mask tiny = angle < Pack(1e-150);
  const Pack f = select(tiny, Pack(1.0), s / select(tiny, Pack(1.0), angle));
  const Quaternion turned = normalised(product({c, f * half.x, f * half.y, f * half.z}, {q[0], q[1], q[2], q[3]}));
  q[0] = select(moving, turned.w, q[0]);
  q[1] = select(moving, turned.x, q[1]);
  q[2] = select(moving, turned.y, q[2]);
  q[3] = select(moving, turned.z, q[3]);
}

}  // namespace
