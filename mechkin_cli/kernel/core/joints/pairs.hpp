// The joint table's closing pairs: each is its letter, the elementary conditions that it keeps between the frame A on the
// first link and B on the second, lengths before directions, and its coordinates in the order of its freedoms
// (mechanism/pairs.py). A new pair is one entry here and its name in the list below.
#pragma once

#include "joints/composition.hpp"
#include "joints/relations.hpp"

#if MECHKIN_ENCLOSES
#include "joints/relative_conditions.hpp"
#else
#include "joints/ground_conditions.hpp"
#endif

namespace {

struct Revolute : Pair<Conditions<CommonPoint, ParallelAxes>, Coordinates<About>> {
  static constexpr char letter[] = "R";
};

struct Prismatic : Pair<Conditions<InPlane<AX>, InPlane<AY>, SameOrientation>, Coordinates<Along<AZ>>> {
  static constexpr char letter[] = "P";
};

struct Cylindric : Pair<Conditions<InPlane<AX>, InPlane<AY>, ParallelAxes>, Coordinates<About, Along<AZ>>> {
  static constexpr char letter[] = "C";
};

struct Spheric : Pair<Conditions<CommonPoint>, Coordinates<>> {
  static constexpr char letter[] = "S";
};

// Sphere A.o of the first link on the plane square to z_B through B.o of the second.
struct SphereOnPlane : Pair<Conditions<InPlane<BZ>>, Coordinates<>> {
  static constexpr char letter[] = "Sp";
};

// Sphere A.o of the first link in the groove along z_B through B.o of the second: R - R' = z_B s.
struct SphereInGroove : Pair<Conditions<InPlane<BX>, InPlane<BY>>,
                             Coordinates<Nameless, Nameless, Nameless, Along<Reverse<BZ>>>> {
  static constexpr char letter[] = "Sg";
};

// Hooke joint; the parameter is the cosine of the angle between the axes. With square axes: a ball of the second link
// whose pin z_B runs in a slot of the socket on the first, z_A the slot's normal.
struct Universal : Pair<Conditions<CommonPoint, KeptAngle<Parameter>>,
                        Coordinates<FirstTurn<Parameter>, SecondTurn<Parameter>>> {
  static constexpr char letter[] = "U";
};

// Plane on plane: z the normal, x and y in the plane, theta about the normal.
struct Planar : Pair<Conditions<InPlane<AZ>, ParallelAxes>, Coordinates<Along<AX>, Along<AY>, About>> {
  static constexpr char letter[] = "E";
};

struct Weld : Pair<Conditions<CommonPoint, SameOrientation>, Coordinates<>> {
  static constexpr char letter[] = "W";
};

// A ball of the second link in a cylinder of the first, its pin z_B in the slot along the cylinder, z_A the slot's
// normal. The parameter is the cosine of the angle between axis and pin at home, where the pin is -y_A.
struct SphereInSlottedCylinder : Pair<Conditions<InPlane<AcrossCylinder>, InPlane<AZ>, KeptAngle<Square>>,
                                      Coordinates<Along<AlongCylinder>, FirstTurn<Square>, SecondTurn<Square>>> {
  static constexpr char letter[] = "Sc";
};

// A cylinder of the first link, z_A its axis, on the plane of the second square to z_B, in line contact. The plane is
// taken through the axis: the radius shifts both and cancels. x_B across the axis at home, y_B along it.
struct CylinderOnPlane : Pair<Conditions<InPlane<BZ>, KeptAngle<Square>>,
                              Coordinates<FirstTurn<Square>, SecondTurn<Square>, Along<BX>, Along<BY>>> {
  static constexpr char letter[] = "Cp";
};

// The pairs of links that stay in the plane x y of the ground, by which two numbers tell every point: what the plane holds
// is no equation of theirs. A revolute pair is then a sphere in a groove along z.
struct RevoluteInPlane : Pair<Conditions<CommonPointInPlane>, Coordinates<About>> {
  static constexpr char letter[] = "R2";
};

// z along the axis, x the plane's normal.
struct PrismaticInPlane : Pair<Conditions<InPlane<AY>, SameHeading>, Coordinates<Along<AZ>>> {
  static constexpr char letter[] = "P2";
};

// A pin of the first link in a slot of the second along x_B, z the plane's normal.
struct PinInSlot : Pair<Conditions<InPlane<BY>>, Coordinates<About, Along<Reverse<BX>>>> {
  static constexpr char letter[] = "Ps2";
};

struct WeldInPlane : Pair<Conditions<CommonPointInPlane, SameHeading>, Coordinates<>> {
  static constexpr char letter[] = "W2";
};

// Two points at a distance: no pair of the file format.
struct PointsApart : Pair<Conditions<Distance>, Coordinates<>> {
  static constexpr char letter[] = "";
};

// The code of a pair is its place; the first ones stand in PairCode.
using Pairs = Entries<PointsApart, Relation<0>, Relation<1>, Revolute, Prismatic, Cylindric, Spheric, SphereOnPlane, SphereInGroove, Universal, Planar,
                      Weld, SphereInSlottedCylinder, CylinderOnPlane, RevoluteInPlane, PrismaticInPlane, PinInSlot,
                      WeldInPlane>;

// Calls f with the entry of what closes a loop.
template <class F>
MECHKIN_INLINE void with_closing_joint(int type, F&& f) {
  Pairs::call(type, f);
}

}  // namespace
