// Bushings: springs and dampers between two frames, one on each link, in all six directions.
//
// With the axes A of the first link's frame, the deflection is e = (shift, turn): the way from its origin to that of the
// second frame, and the rotation vector of the second frame against it, both in A. The energy 1/2 (e - free) . K (e - free)
// is a function of the relative pose alone, so that the forces have a potential for finite deflections, too: with
// g = K (e - free) = (f, c), the second link gets -f at its frame's origin, and the couple -J^-T c, where turn' = J^-1 omega
// (F. Bullo and R. Murray, Proportional derivative control on the Euclidean group, 1995):
//
//     J^-T c = c + turn x c / 2 + B s x (s x c),   s = sin t n the skew part,   B = (1 - t/2 cot(t/2)) / sin^2 t
//
// for the turn t n. Half a turn has no rotation vector, and no force. Dampers act on the velocities of the second frame's
// origin and the angular velocity, in A.
#pragma once

#include "arithmetic/elementary.hpp"
#include "rows/moving.hpp"

namespace {

// What a rotation vector is per skew part, t / sin t, and B above. Both are power series of v = sin^2(t/2) for small turns,
// where the quotients cancel.
struct TurnFactors {
  Pack vector, bend;
};

// Below this v the terms left out are less than the last place.
constexpr double SMALL_TURN = 0x1p-8;
#if MECHKIN_ARITHMETIC == MECHKIN_DOUBLES
constexpr int TURN_TERMS = 7;
#else
constexpr int TURN_TERMS = 14;
#endif

// t / sin t = sum of a_n v^n, a_n = a_(n-1) 2n / (2n + 1), and B = sum of a_n / (2n + 3) v^n / (4 (1 - v)).
inline TurnFactors small_turn_factors(Pack v) {
  Pack vector = 1.0, bend = Pack(1.0) / Pack(2.0 * TURN_TERMS + 3.0);
  for (int n = TURN_TERMS; n > 0; --n) {
    const Pack step = v * (Pack(2.0 * n) / Pack(2.0 * n + 1.0));
    vector = Pack(1.0) + step * vector;
    bend = Pack(1.0) / Pack(2.0 * n + 1.0) + step * bend;
  }
  return {vector, bend / (Pack(4.0) * (Pack(1.0) - v))};
}

inline TurnFactors large_turn_factors(Pack sine, Pack cosine) {
  const Pack vector = atan2(sine, cosine) / sine;
  return {vector, (Pack(1.0) - vector * (Pack(0.5) * (Pack(1.0) + cosine))) / (sine * sine)};
}

#if MECHKIN_ENCLOSES

// The series where all of the interval is small, with what it leaves out: less than twice its first term.
inline TurnFactors turn_factors(const Vec3& skew, Pack cosine) {
  const Pack v = Pack(0.5) * (Pack(1.0) - cosine);
  const Mask small = magnitude(v) < Real(SMALL_TURN);
  TurnFactors near = small_turn_factors(v);
  const auto known = [&](Pack& x) { x.radius = select(small, widened(x.radius + Real(0x1p-110)), Real(__builtin_inf())); };
  known(near.vector), known(near.bend);
  const TurnFactors far = large_turn_factors(sqrt(dot(skew, skew)), cosine);
  return {narrower(far.vector, near.vector), narrower(far.bend, near.bend)};
}

#else

inline TurnFactors turn_factors(const Vec3& skew, Pack cosine) {
  const Pack v = Pack(0.5) * (Pack(1.0) - cosine);
  const Mask small = v < Pack(SMALL_TURN);
  const TurnFactors near = small_turn_factors(v);
  const TurnFactors far = large_turn_factors(select(small, Pack(1.0), sqrt(dot(skew, skew))), cosine);
  return {select(small, near.vector, far.vector), select(small, near.bend, far.bend)};
}

#endif

// A bushing as it stands: the axes of its first frame and the origin of its second in ground axes, and its deflection.
struct Deflection {
  Vec3 axis[3], at;
  Vec3 shift, turn, skew;  // in the first frame's axes
  Pack bend;

  Vec3 components(const Vec3& a) const { return {dot(a, axis[0]), dot(a, axis[1]), dot(a, axis[2])}; }
  Vec3 vector(const Vec3& a) const { return a.x * axis[0] + a.y * axis[1] + a.z * axis[2]; }
  Vec3 couple_by(const Vec3& c) const {
    return c + Pack(0.5) * cross(turn, c) + bend * cross(skew, cross(skew, c));
  }
  // The rate of the turn by an angular velocity.
  Vec3 turn_rate(const Vec3& omega) const {
    return omega - Pack(0.5) * cross(turn, omega) + bend * cross(skew, cross(skew, omega));
  }
};

inline Deflection deflection(const Plan& p, const Workspace& w, const Load& l) {
  const Bushing& b = p.bushing[l.freedom];
  Deflection d;
  d.axis[0] = carried_vector(w, l.link, b.on_first.x);
  d.axis[1] = carried_vector(w, l.link, b.on_first.y);
  d.axis[2] = carried_vector(w, l.link, b.on_first.z);
  const Vec3 other[] = {carried_vector(w, l.other, b.on_second.x), carried_vector(w, l.other, b.on_second.y),
                        carried_vector(w, l.other, b.on_second.z)};
  d.at = carried_point(w, l.other, b.on_second.o);
  d.shift = d.components(d.at - carried_point(w, l.link, b.on_first.o));
  Vec3 skew = zero3();
  Pack trace = 0.0;
  for (int k = 0; k < 3; ++k) skew += cross(d.axis[k], other[k]), trace += dot(d.axis[k], other[k]);
  d.skew = d.components(Pack(0.5) * skew);
  const TurnFactors by = turn_factors(d.skew, Pack(0.5) * (trace - Pack(1.0)));
  d.turn = by.vector * d.skew, d.bend = by.bend;
  return d;
}

// Two vectors of three, as the six numbers of a deflection, its rate, or what acts along it.
struct Six {
  Vec3 slides, turns;
};

// Of the velocity of the second frame's origin and the angular velocity, as the first link sees them.
inline Six deflection_velocity(const Workspace& w, const Load& l, const Deflection& d) {
  const Twist relative = motion_of(w, l.other).velocity - motion_of(w, l.link).velocity;
  return {d.components(relative.at(d.at)), d.components(relative.angular)};
}

inline Six times_matrix(const Bushing& b, const Six& e) {
  const Pack in[] = {e.slides.x, e.slides.y, e.slides.z, e.turns.x, e.turns.y, e.turns.z};
  Pack out[6];
  for (int i = 0; i < 6; ++i) {
    out[i] = 0.0;
    for (int k = 0; k < 6; ++k) {
      const int row = i < k ? i : k, column = i < k ? k : i;
      out[i] += Pack(b.matrix[row * (11 - row) / 2 + column]) * in[k];
    }
  }
  return {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
}

inline Six stretch(const Bushing& b, const Deflection& d) {
  return {d.shift - constant(b.free), d.turn - constant(b.free + 3)};
}

inline Pack product_of(const Six& a, const Six& b) { return dot(a.slides, b.slides) + dot(a.turns, b.turns); }

inline Pack bushing_energy(const Plan& p, const Workspace& w, const Load& l) {
  const Bushing& b = p.bushing[l.freedom];
  const Six e = stretch(b, deflection(p, w, l));
  return Pack(0.5) * product_of(e, times_matrix(b, e));
}

// Force and moment about its frame's origin, on the second link and in ground axes.
inline Six bushing_force(const Plan& p, const Workspace& w, const Load& l, const Deflection& d) {
  const Bushing& b = p.bushing[l.freedom];
  if (l.type == LOAD_BUSHING_DAMPER) {
    const Six by = times_matrix(b, deflection_velocity(w, l, d));
    return {-d.vector(by.slides), -d.vector(by.turns)};
  }
  const Six by = times_matrix(b, stretch(b, d));
  return {-d.vector(by.slides), -d.vector(d.couple_by(by.turns))};
}

inline Wrench bushing_wrench(const Plan& p, const Workspace& w, const Load& l) {
  const Deflection d = deflection(p, w, l);
  const Six by = bushing_force(p, w, l, d);
  Wrench r = force_at(d.at, by.slides);
  r.moment += by.turns;
  return r;
}

}  // namespace
