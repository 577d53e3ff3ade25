// The equations of motion of many freedoms: M and r by the columns of the tree, whose links are lumped with all that the
// tree hangs on them (composite bodies; Featherstone, Rigid Body Dynamics Algorithms, 2008, 6.2), and then by the
// directions, T (columns x directions):
//
//     M = T^T H T,   H_ab = S_a . I_b S_b,   r = T^T f,   f_b = S_b . (sum of forces on the composite body)
//
// with S_b the screw of column b and I_b the inertia of the composite body that it moves, a on the way from b to ground. A link's
// twist by each direction is needed nowhere, and most of T is zero in trees without loops, so that a stage takes the square of
// the freedoms and one factorisation.
#pragma once

#include "plan/room.hpp"
#include "rows/motion.hpp"

namespace {

// Up to here links are summed one by one, which takes less.
constexpr int FEW_FREEDOMS = 6;

// Momentum of a link that moves with a twist: m v and I omega about the kernel's origin.
inline Wrench momentum(const LinkInertia& m, const Pose& pose, const Twist& twist) {
  const Vec3 centre = pose.point(m.centre), omega = pose.components(twist.angular);
  const auto* t = m.tensor;
  const Vec3 spin = {Pack(t[0]) * omega.x + Pack(t[3]) * omega.y + Pack(t[4]) * omega.z,
                     Pack(t[3]) * omega.x + Pack(t[1]) * omega.y + Pack(t[5]) * omega.z,
                     Pack(t[4]) * omega.x + Pack(t[5]) * omega.y + Pack(t[2]) * omega.z};
  Wrench r = force_at(centre, Pack(m.mass) * twist.at(centre));
  r.moment += pose.vector(spin);
  return r;
}

// Mass, mass centre and inertia about it in ground axes: sums about the origin would lose what is small beside its distance.
struct CompositeBody {
  Pack mass;
  Vec3 centre, x, y, z;  // the tensor's columns
};

inline CompositeBody body_of(const LinkInertia& m, const Pose& pose) {
  const auto* t = m.tensor;
  const Vec3 x = {Pack(t[0]), Pack(t[3]), Pack(t[4])}, y = {Pack(t[3]), Pack(t[1]), Pack(t[5])},
             z = {Pack(t[4]), Pack(t[5]), Pack(t[2])};
  // R I R^T: columns of R I, then those of R^T mixed by them
  const Vec3 a = pose.vector(x), b = pose.vector(y), c = pose.vector(z);
  const auto mix = [&](Pack u, Pack v, Pack w) __attribute__((always_inline)) { return u * a + v * b + w * c; };
  return {Pack(m.mass), pose.point(m.centre), mix(pose.X.x, pose.Y.x, pose.Z.x), mix(pose.X.y, pose.Y.y, pose.Z.y),
          mix(pose.X.z, pose.Y.z, pose.Z.z)};
}

// Both as one body: about the common centre two masses have that of m1 m2 / (m1 + m2) at their distance.
inline void add_body(CompositeBody& to, const CompositeBody& b) {
  const Pack mass = to.mass + b.mass;
  const Mask heavy = mass > Pack(0.0);
  const Pack part = select(heavy, b.mass / select(heavy, mass, Pack(1.0)), Pack(0.0));
  const Vec3 d = b.centre - to.centre, far = (to.mass * part) * d;
  const Pack square = dot(far, d);
  to.centre += part * d, to.mass = mass;
  to.x += b.x - d.x * far, to.y += b.y - d.y * far, to.z += b.z - d.z * far;
  to.x.x += square, to.y.y += square, to.z.z += square;
}

inline Wrench momentum(const CompositeBody& b, const Twist& twist) {
  const Vec3& o = twist.angular;
  Wrench r = force_at(b.centre, b.mass * twist.at(b.centre));
  r.moment += o.x * b.x + o.y * b.y + o.z * b.z;
  return r;
}

// What that is computed in.
struct Composites {
  CompositeBody* body;  // links
  bool* has_body;       // links
  Wrench* force;        // links: on the composite body
  Pack* direction;      // columns x directions: T
  int *begin, *end;     // columns: the directions that move them
  Pack* half;           // columns x directions: H with half its diagonal and zeros above it, transposed, times T
  Pack* sum;            // directions x directions
};

// Whether the equations of motion are found in this way. Friction reads twists of links by each direction; a hung body
// has two parents.
inline bool has_composites(const Plan& p) { return p.charts > FEW_FREEDOMS && !p.frictions && !p.hung_bodies; }

inline Composites lay_out_composites(const Plan& p, int directions, Room& room) {
  const int use = has_composites(p);
  return {room.take<CompositeBody>(use * p.links), room.take<bool>(use * p.links), room.take<Wrench>(use * p.links),
          room.take<Pack>(use * p.columns * directions), room.take<int>(use * p.columns), room.take<int>(use * p.columns),
          room.take<Pack>(use * p.columns * directions), room.take<Pack>(use * directions * directions)};
}

inline void find_bodies(const Plan& p, const Workspace& w, const Composites& at) {
  for (int k = 0; k < p.links; ++k)
    if ((at.has_body[k] = p.inertia[k].present)) at.body[k] = body_of(p.inertia[k], w.pose[k]);
  for (int k = p.links - 1; k >= 0; --k) {
    const int parent = p.joints[k].parent;
    if (parent < 0 || !at.has_body[k]) continue;
    at.has_body[parent] ? add_body(at.body[parent], at.body[k]) : void(at.body[parent] = at.body[k]);
    at.has_body[parent] = true;
  }
}

// T from `tangent` (directions x columns).
inline void take_directions(const Plan& p, const Composites& at, const Pack* tangent, int directions) {
  for (int c = 0; c < p.columns; ++c) {
    at.begin[c] = directions, at.end[c] = 0;
    for (int d = 0; d < directions; ++d) {
      const Pack x = tangent[d * p.columns + c];
      at.direction[c * directions + d] = x;
      if (all(x == Pack(0.0))) continue;
      if (at.begin[c] > d) at.begin[c] = d;
      at.end[c] = d + 1;
    }
  }
}

// M (directions x charts).
inline void reduce_bodies(const Plan& p, const Workspace& w, const Composites& at, int directions, Pack* inertia) {
  for (int e = 0; e < p.columns * directions; ++e) at.half[e] = 0.0;
  for (int e = 0; e < directions * directions; ++e) at.sum[e] = 0.0;
  for (int k = 0; k < p.links; ++k) {
    if (!at.has_body[k]) continue;
    const int first = p.joints[k].column, freedoms = freedoms_of(p.joints[k].type);
    for (int c = first; c < first + freedoms; ++c) {
      const Wrench by = momentum(at.body[k], w.screw[c]);
      const Pack* const moved = at.direction + c * directions;
      const auto add = [&](int a, Pack entry) __attribute__((always_inline)) {
        Pack* const to = at.half + a * directions;
        for (int d = at.begin[c]; d < at.end[c]; ++d) to[d] += entry * moved[d];
      };
      for (int a = first; a < c; ++a) add(a, power(w.screw[a], by));
      add(c, Pack(0.5) * power(w.screw[c], by));
      for (int on = p.joints[k].parent; on >= 0; on = p.joints[on].parent) {
        const TreeJoint& j = p.joints[on];
        for (int a = j.column; a < j.column + freedoms_of(j.type); ++a) add(a, power(w.screw[a], by));
      }
    }
  }
  for (int c = 0; c < p.columns; ++c)
    for (int i = at.begin[c]; i < at.end[c]; ++i) {
      const Pack factor = at.direction[c * directions + i];
      const Pack* const from = at.half + c * directions;
      Pack* const to = at.sum + i * directions;
      for (int j = 0; j < directions; ++j) to[j] += factor * from[j];
    }
  for (int i = 0; i < directions; ++i)
    for (int j = 0; j < p.charts; ++j) inertia[i * p.charts + j] = at.sum[i * directions + j] + at.sum[j * directions + i];
}

// r (directions) of what the links carry.
inline void reduce_carried(const Plan& p, const Workspace& w, const Composites& at, int directions, Pack* force) {
  for (int k = 0; k < p.links; ++k) at.force[k] = w.carried[k];
  for (int k = p.links - 1; k >= 0; --k)
    if (p.joints[k].parent >= 0) at.force[p.joints[k].parent] += at.force[k];
  for (int d = 0; d < directions; ++d) force[d] = 0.0;
  for (int k = 0; k < p.links; ++k) {
    const int first = p.joints[k].column;
    for (int c = first; c < first + freedoms_of(p.joints[k].type); ++c) {
      const Pack along = power(w.screw[c], at.force[k]);
      for (int d = at.begin[c]; d < at.end[c]; ++d) force[d] += along * at.direction[c * directions + d];
    }
  }
}

}  // namespace
