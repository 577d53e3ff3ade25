// Displacements that carry links in the tree: R, P, H, C, S, W, G, A. Every other pair is a chain of these; L is no
// displacement, two points place the hung body (hung_bodies.hpp).
//
// An entry gives the displacement of its frame (z: the axis) and its freedom screws, which are fixed in the parent link
// but for those along curves and over surfaces, whose course is known before;
// how its state moves by increments of its columns: advance.hpp.
#pragma once

#include "arithmetic/elementary.hpp"
#include "plan/plan.hpp"
#include "arithmetic/vector.hpp"

namespace {

// Where a curve or a surface leads to, with its derivatives by one or two parameters u, v: by u, v; uu, uv, vv; uuu, uuv,
// uvv, vvv; along the axes of the frame, in length units.
struct Course {
  Vec3 place, slope[2], bend[3], third[4];
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

struct Turn {
  static constexpr int freedoms = 1, states = 1, slides = 0;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Course*, const Pack* q) { turn_about_z(p, q[0]); }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, const Course*, Twist* s) {
    s[0] = turning(p);
  }
};

struct Slide {
  static constexpr int freedoms = 1, states = 1, slides = 1;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Course*, const Pack* q) { p.o += q[0] * p.Z; }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, const Course*, Twist* s) {
    s[0] = sliding(p);
  }
};

struct Screw {
  static constexpr int freedoms = 1, states = 1, slides = 0;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint& j, const Course*, const Pack* q) {
    turn_about_z(p, q[0]);
    p.o += (Pack(j.pitch) * q[0]) * p.Z;
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint& j, const Pose*, const Course*, Twist* s) {
    s[0] = turning(p);
    s[0].linear += Pack(j.pitch) * p.Z;
  }
};

struct TurnAndSlide {
  static constexpr int freedoms = 2, states = 2, slides = 2;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Course*, const Pack* q) {
    turn_about_z(p, q[0]);
    p.o += q[1] * p.Z;
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, const Course*, Twist* s) {
    s[0] = turning(p);
    s[1] = sliding(p);
  }
};

// State: unit quaternion of the child against the joint's frame in the parent. Columns: rotation
// about that frame's axes, so that the screws are fixed in the parent.
struct Orientation {
  static constexpr int freedoms = 3, states = 4, slides = 0;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Course*, const Pack* q) {
    const Pack w = q[0], x = q[1], y = q[2], z = q[3], one = 1.0;
#if MECHKIN_ENCLOSES  // over a box of quaternions not all have length one
    const Pack two = Pack(2.0) / (w * w + x * x + y * y + z * z);
#else
    const Pack two = 2.0;
#endif
    const Vec3 X = p.X, Y = p.Y, Z = p.Z;
    p.X = (one - two * (y * y + z * z)) * X + (two * (x * y + w * z)) * Y + (two * (x * z - w * y)) * Z;
    p.Y = (two * (x * y - w * z)) * X + (one - two * (x * x + z * z)) * Y + (two * (y * z + w * x)) * Z;
    p.Z = cross(p.X, p.Y);
  }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint& j, const Pose* parent, const Course*, Twist* s) {
    const Pose f = placed(j.at, parent);
    s[0] = {f.X, cross(p.o, f.X)};
    s[1] = {f.Y, cross(p.o, f.Y)};
    s[2] = {f.Z, cross(p.o, f.Z)};
  }
};

// Along a curve, or over a surface, without turning.
template <int PARAMETERS>
struct Carriage {
  static constexpr int freedoms = PARAMETERS, states = PARAMETERS, slides = 0;
  static MECHKIN_INLINE void place(Pose& p, const TreeJoint&, const Course* c, const Pack*) { p.o += p.vector(c->place); }
  static MECHKIN_INLINE void screws(const Pose& p, const TreeJoint&, const Pose*, const Course* c, Twist* s) {
    for (int i = 0; i < PARAMETERS; ++i) s[i] = {zero3(), p.vector(c->slope[i])};
  }
};

struct Fixed {
  static constexpr int freedoms = 0, states = 0, slides = 0;
  static MECHKIN_INLINE void place(Pose&, const TreeJoint&, const Course*, const Pack*) {}
  static MECHKIN_INLINE void screws(const Pose&, const TreeJoint&, const Pose*, const Course*, Twist*) {}
};

// Calls f with the entry of a tree joint.
template <class F>
MECHKIN_INLINE void with_tree_joint(int type, F&& f) {
  switch (type) {
    case TREE_R: return f(Turn{});
    case TREE_P: return f(Slide{});
    case TREE_H: return f(Screw{});
    case TREE_C: return f(TurnAndSlide{});
    case TREE_S: return f(Orientation{});
    case TREE_W:
    case TREE_L: return f(Fixed{});
    case TREE_G: return f(Carriage<1>{});
    case TREE_A: return f(Carriage<2>{});
  }
}
MECHKIN_INLINE int freedoms_of(int type) {
  int freedoms = 0;
  with_tree_joint(type, [&](auto entry) { freedoms = entry.freedoms; });
  return freedoms;
}

}  // namespace
