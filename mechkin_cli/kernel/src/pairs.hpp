// The joint table: everything the kernel knows about a pair stands in its one entry.
//
// `parts` tells the pair as a chain of tree displacements from the first link to the second, `coordinates` the
// names of its freedoms in that order (- for one without a name). As a closing joint a pair has 6 - f
// equations between the frame A on the first link and B on the second, their derivatives, the wrenches it
// transmits, its coordinates, and the side condition that tells an assembly from a false root of the equations.
//
// Equations that are lengths come first, then angles.
#pragma once

#include "closing_equations.hpp"

namespace {

struct Pair {
  static constexpr int equations = 0, lengths = 0;
  static MECHKIN_INLINE Mask side(const Closure&) { return all_lanes(true); }
  static MECHKIN_INLINE void coordinate(const Closure&, const PairMotion&, int, Pack*) {}
};

struct Revolute : Pair {
  static constexpr char letter[] = "R", parts[] = "R", coordinates[] = "theta";
  static constexpr int equations = 5, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    ParallelAxes::residual(k, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    ParallelAxes::column(k, s, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    ParallelAxes::second(k, a, b, r + 3);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    ParallelAxes::third(k, a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += ParallelAxes::moment(k, l + 3);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) { about(k, p, out); }
};

struct Prismatic : Pair {
  static constexpr char letter[] = "P", parts[] = "P", coordinates[] = "s";
  static constexpr int equations = 5, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    PointOnAxis::residual(k, r);
    SameOrientation::residual(k, r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    PointOnAxis::column(k, s, r);
    SameOrientation::column(s, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    PointOnAxis::second(k, a, b, r);
    SameOrientation::second(a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    PointOnAxis::third(k, a, b, r);
    SameOrientation::third(a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = PointOnAxis::wrench(k, l);
    w.moment += SameOrientation::moment(l + 2);
    return w;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) {
    along(k.A.Z, p.a, k, p, out);
  }
};

// H closes no loop: its turn count would be lost. Its s is its theta times the pitch.
struct Helical : Pair {
  static constexpr char letter[] = "H", parts[] = "H", coordinates[] = "theta";
};

struct Cylindric : Pair {
  static constexpr char letter[] = "C", parts[] = "C", coordinates[] = "theta s";
  static constexpr int equations = 4, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    PointOnAxis::residual(k, r);
    ParallelAxes::residual(k, r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    PointOnAxis::column(k, s, r);
    ParallelAxes::column(k, s, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    PointOnAxis::second(k, a, b, r);
    ParallelAxes::second(k, a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    PointOnAxis::third(k, a, b, r);
    ParallelAxes::third(k, a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = PointOnAxis::wrench(k, l);
    w.moment += ParallelAxes::moment(k, l + 2);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom == 0) return about(k, p, out);
    along(k.A.Z, p.a, k, p, out);
  }
};

struct Spheric : Pair {
  static constexpr char letter[] = "S", parts[] = "S", coordinates[] = "- - -";
  static constexpr int equations = 3, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { CommonPoint::residual(k, r); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { CommonPoint::column(k, s, r); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return CommonPoint::wrench(k, l); }
};

// Sphere A.o of the first link on the plane square to z_B through B.o of the second.
struct SphereOnPlane : Pair {
  static constexpr char letter[] = "Sp", parts[] = "SPP", coordinates[] = "- - - - -";
  static constexpr int equations = 1, lengths = 1;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.B.Z, k.d); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { r[0] = dot(k.B.Z, s.at(k.A.o)); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.B.Z, b, k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.B.Z, b, k, a, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return force_at(k.A.o, l[0] * k.B.Z); }
};

// Sphere A.o of the first link in the groove along z_B through B.o of the second: R - R' = z_B s.
struct SphereInGroove : Pair {
  static constexpr char letter[] = "Sg", parts[] = "SP", coordinates[] = "- - - s";
  static constexpr int equations = 2, lengths = 2;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = dot(k.B.X, k.d), r[1] = dot(k.B.Y, k.d); }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 v = s.at(k.A.o);
    r[0] = dot(k.B.X, v), r[1] = dot(k.B.Y, v);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.B.X, b, k, a, b), r[1] = second_along(k.B.Y, b, k, a, b);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.B.X, b, k, a, b), r[1] = third_along(k.B.Y, b, k, a, b);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    return force_at(k.A.o, l[0] * k.B.X + l[1] * k.B.Y);
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int, Pack* out) {
    along(-k.B.Z, p.b, k, p, out);
  }
};

// Hooke joint; the parameter is the cosine of the angle between the axes.
struct Universal : Pair {
  static constexpr char letter[] = "U", parts[] = "RR", coordinates[] = "theta1 theta2";
  static constexpr int equations = 4, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    TwoTurns::residual(k, k.parameter, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    TwoTurns::column(k, s, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    TwoTurns::second(k, a, b, r + 3);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    TwoTurns::third(k, a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += TwoTurns::moment(k, l + 3);
    return w;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    TwoTurns::coordinate(k, k.parameter, p, freedom, out);
  }
};

// A ball of the second link whose pin z_B runs in a slot of the socket on the first, z_A the slot's normal: a Hooke
// joint by another name.
struct SlottedSphere : Universal {
  static constexpr char letter[] = "Ss";
};

// A ball of the second link in a cylinder of the first, its pin z_B in the slot along the cylinder, z_A the slot's
// normal. The parameter is the cosine of the angle between axis and pin at home, where the pin is -y_A.
struct SphereInSlottedCylinder : Pair {
  static constexpr char letter[] = "Sc", parts[] = "PRR", coordinates[] = "s theta1 theta2";
  static constexpr int equations = 3, lengths = 2;
  static MECHKIN_INLINE Pack sine(const Closure& k) { return sqrt(Pack(1.0) - k.parameter * k.parameter); }
  static MECHKIN_INLINE Vec3 axis(const Closure& k) { return sine(k) * k.A.X - k.parameter * k.A.Y; }
  // In the slot's plane, square to the axis.
  static MECHKIN_INLINE Vec3 across(const Closure& k) { return k.parameter * k.A.X + sine(k) * k.A.Y; }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(across(k), k.d), r[1] = dot(k.A.Z, k.d);
    TwoTurns::residual(k, Pack(0.0), r + 2);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    const Vec3 v = s.at(k.B.o);
    r[0] = dot(across(k), v), r[1] = dot(k.A.Z, v);
    TwoTurns::column(k, s, r + 2);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(across(k), a, k, a, b), r[1] = second_along(k.A.Z, a, k, a, b);
    TwoTurns::second(k, a, b, r + 2);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(across(k), a, k, a, b), r[1] = third_along(k.A.Z, a, k, a, b);
    TwoTurns::third(k, a, b, r + 2);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, l[0] * across(k) + l[1] * k.A.Z);
    w.moment += TwoTurns::moment(k, l + 2);
    return w;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom > 0) return TwoTurns::coordinate(k, Pack(0.0), p, freedom - 1, out);
    along(axis(k), p.a, k, p, out);
  }
};

// A cylinder of the first link, z_A its axis, on the plane of the second square to z_B, in line contact. The plane is
// taken through the axis: the radius shifts both and cancels. x_B across the axis at home, y_B along it.
struct CylinderOnPlane : Pair {
  static constexpr char letter[] = "Cp", parts[] = "RRPP", coordinates[] = "theta1 theta2 x y";
  static constexpr int equations = 2, lengths = 1;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    SphereOnPlane::residual(k, r);
    TwoTurns::residual(k, Pack(0.0), r + 1);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    SphereOnPlane::column(k, s, r);
    TwoTurns::column(k, s, r + 1);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    SphereOnPlane::second(k, a, b, r);
    TwoTurns::second(k, a, b, r + 1);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    SphereOnPlane::third(k, a, b, r);
    TwoTurns::third(k, a, b, r + 1);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = SphereOnPlane::wrench(k, l);
    w.moment += TwoTurns::moment(k, l + 1);
    return w;
  }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom < 2) return TwoTurns::coordinate(k, Pack(0.0), p, freedom, out);
    along(freedom == 2 ? k.B.X : k.B.Y, p.b, k, p, out);
  }
};

// Plane on plane: z the normal, x and y in the plane, theta about the normal.
struct Planar : Pair {
  static constexpr char letter[] = "E", parts[] = "PPR", coordinates[] = "x y theta";
  static constexpr int equations = 3, lengths = 1;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    r[0] = dot(k.A.Z, k.d);
    ParallelAxes::residual(k, r + 1);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    r[0] = dot(k.A.Z, s.at(k.B.o));
    ParallelAxes::column(k, s, r + 1);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    r[0] = second_along(k.A.Z, a, k, a, b);
    ParallelAxes::second(k, a, b, r + 1);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    r[0] = third_along(k.A.Z, a, k, a, b);
    ParallelAxes::third(k, a, b, r + 1);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = force_at(k.B.o, l[0] * k.A.Z);
    w.moment += ParallelAxes::moment(k, l + 1);
    return w;
  }
  static MECHKIN_INLINE Mask side(const Closure& k) { return ParallelAxes::side(k); }
  static MECHKIN_INLINE void coordinate(const Closure& k, const PairMotion& p, int freedom, Pack* out) {
    if (freedom == 2) return about(k, p, out);
    along(freedom == 0 ? k.A.X : k.A.Y, p.a, k, p, out);
  }
};

struct Weld : Pair {
  static constexpr char letter[] = "W", parts[] = "W", coordinates[] = "";
  static constexpr int equations = 6, lengths = 3;
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) {
    CommonPoint::residual(k, r);
    SameOrientation::residual(k, r + 3);
  }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) {
    CommonPoint::column(k, s, r);
    SameOrientation::column(s, r + 3);
  }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    CommonPoint::second(k, a, b, r);
    SameOrientation::second(a, b, r + 3);
  }
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    CommonPoint::third(k, a, b, r);
    SameOrientation::third(a, b, r + 3);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) {
    Wrench w = CommonPoint::wrench(k, l);
    w.moment += SameOrientation::moment(l + 3);
    return w;
  }
};

// Two points at a given distance: |d| = length. Not a pair of its own, but two spheres with a leg between them.
struct Distance : Pair {
  static constexpr char letter[] = "", parts[] = "", coordinates[] = "";
  static constexpr int equations = 1, lengths = 1;
  static MECHKIN_INLINE Pack length(const Closure& k) { return sqrt(dot(k.d, k.d)); }
  static MECHKIN_INLINE Vec3 line(const Closure& k) { return (Pack(1.0) / length(k)) * k.d; }
  static MECHKIN_INLINE void residual(const Closure& k, Pack* r) { r[0] = length(k) - k.parameter; }
  static MECHKIN_INLINE void column(const Closure& k, Twist s, Pack* r) { r[0] = dot(line(k), s.at(k.B.o)); }
  static MECHKIN_INLINE void second(const Closure& k, const Motion& a, const Motion& b, Pack* r) {
    const Vec3 e = line(k), d1 = first_of_d(k, a, b);
    const Pack along = dot(e, d1);
    r[0] = dot(e, second_of_d(k, a, b)) + (dot(d1, d1) - along * along) / length(k);
  }
  // |d| |d|''' = 3 d'.d'' + d.d''' - 3 |d|' |d|''
  static MECHKIN_INLINE void third(const Closure& k, const MotionToJerk& a, const MotionToJerk& b, Pack* r) {
    const Vec3 d1 = first_of_d(k, a, b), d2 = second_of_d(k, a, b);
    Pack bend = 0.0;
    second(k, a, b, &bend);
    r[0] = (Pack(3.0) * dot(d1, d2) + dot(k.d, third_of_d(k, a, b)) - Pack(3.0) * dot(line(k), d1) * bend) / length(k);
  }
  static MECHKIN_INLINE Wrench wrench(const Closure& k, const Pack* l) { return force_at(k.B.o, l[0] * line(k)); }
};

// Calls f with the entry of a pair that closes loops.
template <class F>
MECHKIN_INLINE void with_closing_joint(int type, F&& f) {
  switch (type) {
    case PAIR_R: return f(Revolute{});
    case PAIR_P: return f(Prismatic{});
    case PAIR_C: return f(Cylindric{});
    case PAIR_S: return f(Spheric{});
    case PAIR_SP: return f(SphereOnPlane{});
    case PAIR_SG: return f(SphereInGroove{});
    case PAIR_U:
    case PAIR_SS: return f(Universal{});
    case PAIR_E: return f(Planar{});
    case PAIR_W: return f(Weld{});
    case PAIR_SC: return f(SphereInSlottedCylinder{});
    case PAIR_CP: return f(CylinderOnPlane{});
    case PAIR_LEG: return f(Distance{});
  }
}

}  // namespace
