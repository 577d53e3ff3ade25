// Friction of a motion of one freedom (docs/friction.md, Motions).
//
// The freedom moves one way or the other, its `sense`, and all joints slip with it, or it rests. The acceleration is
// eliminated first: a friction force and what it accelerates act together, u'' = M^-1 (-r + sum of z_k g_k), so that
// reactions are linear in the z_k alone and the small system of the forces is that of a sweep. At rest both ways are
// tried with the coefficients of rest; it stays where neither moves.
#pragma once

#include "equations_of_motion.hpp"

namespace {

// What friction makes of a stage: lanes without an answer, and the power that it takes.
struct Slid {
  Mask undecided;
  Pack power;
};

// x := M^-1 x with the factors that solve_motion leaves.
inline void solve_factored(const Plan& p, const ReducedMotion& m, Pack* x) {
  const int n = p.charts;
  const Pack* const l = m.factor;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] = x[i] / l[i * n + i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] = x[i] / l[i * n + i];
  }
}

// What u'' needs of the joints, beside what w.carried has.
inline void accelerate(const Plan& p, Workspace& w, const ReducedMotion& m, const Pack* second) {
  for (int k = 0; k < p.links; ++k) {
    if (!p.inertia[k].present) continue;
    for (int i = 0; i < p.charts; ++i)
      w.carried[k] += second[i] * momentum(p.inertia[k], w.pose[k], m.twist[i * p.links + k]);
  }
}

// Directions, speeds and coefficients for a sense; `resting` lanes have the coefficients of rest.
inline void aim_along(const Plan& p, Workspace& w, const ReducedMotion& m, Pack sense, Pack rate, Mask resting) {
  Pack level = 0.0;
  for (int k = 0; k < p.links; ++k) level = component_level(level, {m.twist[k].angular, m.twist[k].linear});
  const Rubbing& r = w.rubbing;
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    const Twist a = j.first < 0 ? zero_twist() : m.twist[j.first], b = j.second < 0 ? zero_twist() : m.twist[j.second];
    const Slip slip = slip_of(f, r.axis[k], b.angular - a.angular, b.at(r.point[k]) - a.at(r.point[k]));
    const Pack radius = f.radius, lever = (f.slides < 0 ? Pack(0.0) : Pack(1.0)) + (f.turns < 0 ? Pack(0.0) : radius);
    const Mask moves = slip.speed > Pack(JOINT_AT_REST) * lever * level;
    const Pack scale = select(moves, sense / select(moves, slip.speed, Pack(1.0)), Pack(0.0));
    r.drag[k] = force_at(r.point[k], scale * slip.slide);
    r.drag[k].moment += (scale * radius * radius) * slip.turn;
    r.speed[k] = select(moves, slip.speed * abs(rate), Pack(0.0));
    r.coefficient[k] = select(resting, Pack(f.at_rest), coefficient_at(f, r.speed[k]));
    r.state[k] = (double)FRICTION_DECIDED;
  }
}

// Friction forces for the directions, and u'' with them; lanes without an answer. `second` is u'' without friction,
// r.applied what the links need at u'' = 0.
inline Mask slide_along(Balance& balance, const ReducedMotion& m, const Pack* second, Pack* out) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  Rubbing& r = w.rubbing;
  for (int k = 0; k < p.links; ++k) w.carried[k] = r.applied[k];
  accelerate(p, w, m, second);
  distribute(p, w, 0);
  read_contacts(p, w, r.base, 1);
  for (int f = 0; f < p.frictions; ++f) {
    for (int k = 0; k < p.links; ++k) w.carried[k] = zero_wrench();
    rub(balance, f, Pack(1.0));
    Pack by = 0.0;
    for (int k = 0; k < p.links; ++k) by -= power(m.twist[k], w.carried[k]);
    solve_factored(p, m, &by);
    r.answer[f] = by;
    accelerate(p, w, m, &by);
    distribute(p, w, 0);
    read_contacts(p, w, r.gain + f, p.frictions);
  }
  solve_friction(p, r);
  Mask undecided = all_lanes(false);
  *out = *second;
  for (int k = 0; k < p.frictions; ++k) {
    undecided = undecided | ~(r.state[k] == Pack((double)FRICTION_DECIDED));
    *out += r.force[k] * r.answer[k];
  }
  return undecided;
}

// u'' of one freedom with friction in the place of `second`. `sense`: 1, -1, or 0 at rest, where `ways` are the
// accelerations that both ways would have; its third entry is the switch at whose zero the sense changes.
template <class RowValue>
inline Slid slide(const Plan& p, Workspace& w, const ReducedMotion& m, Pack sense, Pack rate, const RowValue& row_value,
                  Pack* second, Pack* ways) {
  Balance balance = {p, w, zero_wrench(), zero_wrench(), true, Pack(0.0)};
  apply_inertia(balance, true);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_value);
  for (int k = 0; k < p.links; ++k) w.rubbing.applied[k] = w.carried[k];
  place_contacts(p, w);
  const Mask resting = sense == Pack(0.0);
  aim_along(p, w, m, select(resting, Pack(1.0), sense), rate, resting);
  Slid found = {slide_along(balance, m, second, ways), Pack(0.0)};
  for (int k = 0; k < p.frictions; ++k) found.power += w.rubbing.force[k] * w.rubbing.speed[k];
  found.power = select(resting, Pack(0.0), found.power);
  ways[1] = ways[0];
  if (any(resting)) {
    aim_along(p, w, m, Pack(-1.0), rate, resting);
    found.undecided = found.undecided | (resting & slide_along(balance, m, second, ways + 1));
  }
  ways[2] = select(resting, min(-ways[0], ways[1]), sense * rate);
  *second = select(resting, Pack(0.0), ways[0]);
  return found;
}

}  // namespace
