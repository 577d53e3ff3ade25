// Slips of the joints that rub, in a motion: their directions, what they are by the chart's coordinates, and the memory
// for it (docs/friction.md, Motions).
//
// The slip of a joint has a component for each independent motion of its surfaces, a length by time: slides, and turns by
// the radius. A unit of friction along a component is a wrench whose power is that component. Where a single freedom moves
// all, every joint slips in one direction, and has one component.
#pragma once

#include "response/equations_of_motion.hpp"
#include "forces/friction.hpp"
#include "response/slip_components.hpp"

namespace {

// Rates by the chart, in parts of the largest of any link, up to which a joint is in a dead centre of its own and nothing
// that its friction does moves the mechanism.
constexpr double IMMOBILE = 1e-8;
// The same, and the slip and its derivative in parts of the rates and accelerations of the links, up to which loops forbid the
// slip and what is left of it is rounding.
constexpr double FORBIDDEN = 1e-11;

// Beside the workspace; m columns, the components of all frictions in order.
struct Slips {
  int columns;
  int* first;          // frictions + 1: of their columns
  Wrench *frame, *unit;  // columns: directions; those along which friction acts now
  Pack *row, *along;   // columns x directions: rates along frame and unit
  Pack* by;            // columns x charts: accelerations by units
  Pack *rate, *convective, *start;  // columns: slip; its derivative at u'' = 0; along `unit` at u'' without friction
  Mask *sticks, *mobile;  // columns
  Pack* inverse;       // columns x columns: - d(slip)'/d(unit)
  Pack* factor;        // of it, of what sticks: Cholesky's
  Mask* kept;          // columns: sticks, and independent of those before
  Pack *hold, *force;  // columns x (frictions + 1): what sticks, without friction and by units; columns: found
  Vec3 *base, *load;   // contacts; contacts x columns
};

inline long lay_out_slips(const Plan& p, char* at, Slips* s) {
  Room room = {at};
  s->columns = 0;
  s->first = room.take<int>(p.frictions + 1);
  for (int k = 0; k < p.frictions; ++k) {
    if (at) s->first[k] = s->columns;
    s->columns += slip_components(p, p.friction[k]);
  }
  if (at) s->first[p.frictions] = s->columns;
  const int m = s->columns, n = p.frictions, d = directions(p);
  s->frame = room.take<Wrench>(m), s->unit = room.take<Wrench>(m);
  s->row = room.take<Pack>(m * d), s->along = room.take<Pack>(m * d), s->by = room.take<Pack>(m * p.charts);
  s->rate = room.take<Pack>(m), s->convective = room.take<Pack>(m), s->start = room.take<Pack>(m);
  s->sticks = room.take<Mask>(m), s->mobile = room.take<Mask>(m), s->kept = room.take<Mask>(m);
  s->inverse = room.take<Pack>(m * m), s->factor = room.take<Pack>(m * m);
  s->hold = room.take<Pack>(m * (n + 1)), s->force = room.take<Pack>(m);
  s->base = room.take<Vec3>(p.contacts), s->load = room.take<Vec3>(p.contacts * m);
  return room.used;
}

MECHKIN_INLINE Wrench select(Mask m, const Wrench& a, const Wrench& b) {
  return {select(m, a.moment, b.moment), select(m, a.force, b.force)};
}
MECHKIN_INLINE Wrench couple(const Vec3& moment) { return {moment, zero3()}; }

// Directions of a kind of motion, `put` each: along the axis, two square to it that its link carries, or ground's axes.
template <class Put>
MECHKIN_INLINE void each_direction(const Workspace& w, const Friction& f, const Vec3& axis, int code, Put&& put) {
  if (code < 0) return;
  if (code == FREE_ALONG) return put(axis);
  const Pack one = 1.0, none = 0.0;
  if (code == FREE_ALL) {
    put({one, none, none}), put({none, one, none}), put({none, none, one});
    return;
  }
  // square to the axis and to the ground axis, of the link at its zero, that is the least along it
  const Vec3 a = constant(f.axis);
  const Mask x = (abs(a.x) <= abs(a.y)) & (abs(a.x) <= abs(a.z)), y = ~x & (abs(a.y) <= abs(a.z));
  const Vec3 least = {select(x, one, none), select(y, one, none), select(x | y, none, one)};
  Vec3 u = cross(a, least);
  u = (one / sqrt(dot(u, u))) * u;
  const Pack number[3] = {u.x, u.y, u.z};
  const Vec3 first = carried_vector(w, f.link, number);
  put(first), put(cross(axis, first));
}

MECHKIN_INLINE Twist direction_of(const Plan& p, const ReducedMotion& m, const JointPlace& j, int direction) {
  const Twist* const twist = m.twist + (long)direction * p.links;
  return (j.second < 0 ? zero_twist() : twist[j.second]) - (j.first < 0 ? zero_twist() : twist[j.first]);
}

// Where a single freedom moves the joint, its one direction: `speed` is by a unit of the freedom.
inline Wrench single_direction(const Plan& p, const ReducedMotion& m, const Rubbing& r, int k) {
  const Friction& f = p.friction[k];
  const Twist t = direction_of(p, m, p.place[f.place], 0);
  const Slip slip = slip_of(f, r.axis[k], t.angular, t.at(r.point[k]));
  const Mask moves = slip.speed > Pack(0.0);
  const Pack radius = f.radius, scale = select(moves, Pack(1.0) / select(moves, slip.speed, Pack(1.0)), Pack(0.0));
  Wrench unit = force_at(r.point[k], scale * slip.slide);
  unit.moment += (scale * radius * radius) * slip.turn;
  return unit;
}

inline void find_frame(const Plan& p, const Workspace& w, const ReducedMotion& m, const Slips& s, int k) {
  const Friction& f = p.friction[k];
  const Rubbing& r = w.rubbing;
  const Vec3 axis = r.axis[k], point = r.point[k];
  const Pack radius = f.radius;
  int c = s.first[k];
  if (has_signed_slip(f)) {
    const Pack size = f.screws ? sqrt(f.pitch * f.pitch + radius * radius) : f.turns < 0 ? Pack(1.0) : radius;
    const Wrench slide = force_at(point, axis);
    if (!f.screws)
      s.frame[c] = f.turns < 0 ? slide : couple(radius * axis);
    else
      s.frame[c] = (f.pitch / size) * slide + couple((radius * radius / size) * axis);
    return;
  }
  if (slip_components(p, f) == 1) {
    s.frame[c] = single_direction(p, m, r, k);
    return;
  }
  each_direction(w, f, axis, f.slides, [&](Vec3 e) { s.frame[c++] = force_at(point, e); });
  each_direction(w, f, axis, f.turns, [&](Vec3 e) { s.frame[c++] = couple(radius * e); });
}

// The derivative of a slip at u'' = 0, right where the joint does not slip: of slides by the accelerations of its point.
inline Pack convective_slip(const Workspace& w, const JointPlace& j, const Vec3& point, const Wrench& frame) {
  const Motion &a = motion_of(w, j.first), &b = motion_of(w, j.second);
  const Vec3 carried = cross(b.velocity.angular, b.velocity.at(point)) - cross(a.velocity.angular, a.velocity.at(point));
  return power(b.acceleration - a.acceleration, frame) + dot(carried, frame.force);
}

// Frames, rates and rows of all slips.
inline void find_slips(const Plan& p, const Workspace& w, const ReducedMotion& m, const Slips& s) {
  const int d = directions(p);
  Pack level = 0.0;
  for (int k = 0; k < p.links * p.charts; ++k) level = component_level(level, {m.twist[k].angular, m.twist[k].linear});
  const Pack rates = twist_level(p, w), seconds = acceleration_level(p, w) + rates * rates;
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    find_frame(p, w, m, s, k);
    const Pack lever = (f.slides < 0 ? Pack(0.0) : Pack(1.0)) + (f.turns < 0 ? Pack(0.0) : Pack(f.radius));
    for (int c = s.first[k]; c < s.first[k + 1]; ++c) {
      const Wrench frame = s.frame[c];
      Pack largest = 0.0;
      for (int i = 0; i < d; ++i) {
        const Pack entry = power(direction_of(p, m, j, i), frame);
        s.row[c * d + i] = entry;
        if (i < p.charts) largest = max(largest, abs(entry));
      }
      s.rate[c] = power(motion_of(w, j.second).velocity - motion_of(w, j.first).velocity, frame);
      s.convective[c] = convective_slip(w, j, w.rubbing.point[k], frame);
      s.mobile[c] = largest > Pack(IMMOBILE) * lever * level;
      // a joint in a dead centre of its own has a derivative
      const Pack rounding = Pack(FORBIDDEN) * lever;
      const Mask forbidden = (largest <= rounding * level) & (abs(s.rate[c]) <= rounding * rates) &
                             (abs(s.convective[c]) <= rounding * seconds);
      s.rate[c] = select(forbidden, Pack(0.0), s.rate[c]);
      s.convective[c] = select(forbidden, Pack(0.0), s.convective[c]);
      for (int i = 0; i < d; ++i) s.row[c * d + i] = select(forbidden, Pack(0.0), s.row[c * d + i]);
    }
  }
}

}  // namespace
