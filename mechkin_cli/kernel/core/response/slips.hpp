// Slips of the joints that rub, in a motion: their directions, what they are by the chart's coordinates, and the memory
// for it (docs/friction.md, Motions).
//
// The slip of a joint has a component for each independent motion of its surfaces, a length by time: slides, and turns by
// the radius. A unit of friction along a component is a wrench whose power is that component. Where a single freedom moves
// all, every joint slips in one direction, and has one component.
#pragma once

#include "response/equations_of_motion.hpp"
#include "arithmetic/vector_choice.hpp"
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

// How the joints slip, arrays of a stage, frictions unless said.
struct SlipsGiven {
  const Pack* sense;   // 0 sticks; else slips: 1 or -1 along its one direction, 1 of several
  const Pack* quiet;   // not 0: with the coefficient of rest
  const Pack* aim;     // columns: the direction of a slip that is about to begin, or has
  const Pack* armed;   // frictions: not 0 where a slip of several directions has begun
  const Pack* span;    // frictions: independent directions in which the mechanism lets a joint slip; 0 not known
  const Pack* way;     // 2 x columns: of a joint with fewer directions than components the first two at the origin, in components
};

// What comes of it.
struct SlipsFound {
  Pack *rate, *second, *force;  // columns: slips, their derivatives, friction against them
  Pack* row;                    // columns x charts: rates by those of the chart
  Pack *limit, *loose, *state;  // frictions: what it can hold; 1 where a force that sticks is not unique; FrictionState
  Pack* answer;                 // frictions: slips' derivatives by a unit of their own friction, the largest
  Pack *span, *way;             // frictions: independent directions here; 2 x columns: as given, here
  Pack* level;                  // 1: the largest wrench without friction
  Pack* told;                   // frictions x TOLD_NUMBERS: see FrictionTold
  Pack* system;                 // SlipSystem, or null where nothing asks
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

// Directions of a kind of motion, `put` each: along the axis, two square to it that its link carries, or of which the first goes
// along a line of the surface, or ground's axes.
template <class Put>
MECHKIN_INLINE void each_direction(const Plan& p, const Workspace& w, const Friction& f, const Vec3& axis, int code, Put&& put) {
  if (code < 0) return;
  if (code == FREE_ALONG) return put(axis);
  const Pack one = 1.0, none = 0.0;
  if (code == FREE_ALL) {
    put({one, none, none}), put({none, one, none}), put({none, none, one});
    return;
  }
  if (f.course >= 0) {
    const Vec3 along = of_length_one(w.screw[p.joints[f.course].column].linear);
    put(along), put(cross(axis, along));
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
  if (f.pushes) {
    s.frame[c] = Pack(-1.0) * push_of(p, w, p.place[f.place]);
    return;
  }
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
  each_direction(p, w, f, axis, f.slides, [&](Vec3 e) { s.frame[c++] = force_at(point, e); });
  each_direction(p, w, f, axis, f.turns, [&](Vec3 e) { s.frame[c++] = couple(radius * e); });
}

// The independent directions in which the mechanism lets a joint slip, in its components: Gram-Schmidt, the fastest first.
// Where there are no more, they are zero.
struct SlipSpan {
  Vec3 direction[3];
  Mask found[3];
};
inline SlipSpan slip_span(const Slips& s, int begin, int count, int directions, Pack least) {
  SlipSpan span;
  for (int j = 0; j < 3; ++j) {
    Pack most = least * least;
    Vec3 fastest = zero3();
    for (int i = 0; i < directions; ++i) {
      const Pack* const row = s.row + begin * directions + i;
      Vec3 v = {row[0], row[directions], count > 2 ? row[2 * directions] : Pack(0.0)};
      for (int pass = 0; pass < 2; ++pass)
        for (int l = 0; l < j; ++l) v = v - dot(span.direction[l], v) * span.direction[l];
      const Pack square = dot(v, v);
      const Mask is_faster = square > most;
      most = select(is_faster, square, most), fastest = select(is_faster, v, fastest);
    }
    const Pack square = dot(fastest, fastest);
    span.found[j] = square > Pack(0.0);
    span.direction[j] = (Pack(1.0) / sqrt(select(span.found[j], square, Pack(1.0)))) * fastest;
  }
  return span;
}

MECHKIN_INLINE Vec3 normalised_or(const Vec3& a, const Vec3& other) {
  const Pack square = dot(a, a);
  const Mask has = square > Pack(0.0);
  return select(has, (Pack(1.0) / sqrt(select(has, square, Pack(1.0)))) * a, other);
}

// Where loops let a joint slip in fewer directions than its surfaces could, its components are along these, carried on
// from the origin's by projection: friction acts where it can slip, and a slip along one line has a sign. In a place where
// there are fewer yet, they are as at the origin.
inline void span_frame(const Plan& p, const ReducedMotion& m, const Slips& s, int k, Pack level, const SlipsGiven& given,
                       const SlipsFound& found) {
  const Friction& f = p.friction[k];
  const int begin = s.first[k], count = s.first[k + 1] - begin, d = directions(p);
  const Pack lever = (f.slides < 0 ? Pack(0.0) : Pack(1.0)) + (f.turns < 0 ? Pack(0.0) : Pack(f.radius));
  for (int c = 0; c < count; ++c)
    for (int i = 0; i < d; ++i)
      s.row[(begin + c) * d + i] = power(direction_of(p, m, p.place[f.place], i), s.frame[begin + c]);
  const SlipSpan span = slip_span(s, begin, count, d, Pack(IMMOBILE) * lever * level);
  found.span[k] = 0.0;
  for (int j = 0; j < 3; ++j) found.span[k] += select(span.found[j], Pack(1.0), Pack(0.0));
  const Pack most = given.span[k];
  const Mask few = (most > Pack(0.0)) & (most < Pack((double)count)), two = few & (most > Pack(1.0));
  if (!any(few)) return;
  const auto way = [&](const Pack* at) { return Vec3{at[0], at[1], count > 2 ? at[2] : Pack(0.0)}; };
  const Vec3 before[2] = {way(given.way + 2 * begin), way(given.way + 2 * begin + count)};
  const auto project = [&](const Vec3& a) {
    return dot(span.direction[0], a) * span.direction[0] +
           select(two, dot(span.direction[1], a) * span.direction[1], zero3());
  };
  const Mask is_told = (select(two, found.span[k], Pack(2.0)) > Pack(1.0)) & span.found[0];
  Vec3 now[2];
  now[0] = normalised_or(project(before[0]), span.direction[0]);
  const Vec3 second = project(before[1]);
  now[1] = normalised_or(second - dot(now[0], second) * now[0], span.direction[1]);
  for (int j = 0; j < 2; ++j) now[j] = select(is_told, now[j], before[j]);
  Wrench along[2] = {zero_wrench(), zero_wrench()};
  for (int j = 0; j < 2; ++j) {
    const Pack part[3] = {now[j].x, now[j].y, now[j].z};
    for (int c = 0; c < count; ++c) {
      along[j] += part[c] * s.frame[begin + c];
      found.way[2 * begin + j * count + c] = part[c];
    }
  }
  s.frame[begin] = select(few, along[0], s.frame[begin]);
  s.frame[begin + 1] = select(few, select(two, along[1], zero_wrench()), s.frame[begin + 1]);
  if (count > 2) s.frame[begin + 2] = select(few, zero_wrench(), s.frame[begin + 2]);
}

// The derivative of a slip at u'' = 0, right where the joint does not slip: of slides by the accelerations of its point.
inline Pack convective_slip(const Workspace& w, const JointPlace& j, const Vec3& point, const Wrench& frame) {
  const Motion &a = motion_of(w, j.first), &b = motion_of(w, j.second);
  const Vec3 carried = cross(b.velocity.angular, b.velocity.at(point)) - cross(a.velocity.angular, a.velocity.at(point));
  return power(b.acceleration - a.acceleration, frame) + dot(carried, frame.force);
}

// Frames, rates and rows of all slips.
inline void find_slips(const Plan& p, const Workspace& w, const ReducedMotion& m, const Slips& s, const SlipsGiven& given,
                       const SlipsFound& found) {
  const int d = directions(p);
  Pack level = 0.0;
  for (int k = 0; k < p.links * p.charts; ++k) level = component_level(level, {m.twist[k].angular, m.twist[k].linear});
  const Pack rates = twist_level(p, w), seconds = acceleration_level(p, w) + rates * rates;
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    find_frame(p, w, m, s, k);
    found.span[k] = 1.0;
    if (s.first[k + 1] - s.first[k] > 1) span_frame(p, m, s, k, level, given, found);
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
      s.mobile[c] = f.pushes ? all_lanes(false) : largest > Pack(IMMOBILE) * lever * level;
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
