// The part of their friction that joints at rest need so that nothing has to drive them (docs/friction.md, Held at rest).
//
// At rest the inputs' accelerations, however small, tell which way the mechanism would move. There the loads drive with the
// power P, and each joint that rubs may take up to mu_k N_k by its slip s_k. The mechanism rests where each takes the same
// part of what it may:
//
//     z_k = share mu_k N_k(z),    sum_k s_k z_k = P
//
// No drive is in this balance, so it does not matter which input is thought to drive. The z with this sum are a simplex,
// which the map z := P mu N(z) / sum s mu N(z) takes into itself: there is a solution wherever friction can take power.
// It is found by Newton's method on z and the share together, by that map where Newton's step leads nowhere. What teeth
// push apart with goes by the reactions as friction does, whole and without power.
#pragma once

#include "forces/friction.hpp"

namespace {

constexpr int SHARE_ITERATIONS = 80;
// Newton's steps that leave more than this part of the residual give way to the map, half of which is taken.
constexpr double SHARE_GAIN = 0.5;

// Friction forces of a trial, as in Rubbing; and what the map makes of them, in r.step.
struct ShareTrial {
  Pack share, left, size;  // what is left of the equations, and what it counts beside
};
// From the forces in r.force: r.step are those of the map, r.normal the largest that there may be.
inline ShareTrial try_share(const Plan& p, Rubbing& r, const Pack* largest, const Pack* slip, Pack power) {
  const int n = p.frictions;
  for (int k = 0; k < n; ++k) r.coefficient[k] = largest[k];
  load_contacts<0, false>(p, r);
  Pack taken = 0.0;
  Pack fastest = 0.0, pushes = 0.0;
  for (int k = 0; k < n; ++k) {
    r.normal[k] *= largest[k];
    taken += slip[k] * r.normal[k];
    fastest = max(fastest, slip[k]);
    if (p.friction[k].pushes) pushes += r.normal[k];
  }
  ShareTrial found = {power / taken, Pack(0.0), abs(power) + fastest * pushes};
  for (int k = 0; k < n; ++k) {
    r.step[k] = p.friction[k].pushes ? r.normal[k] : found.share * r.normal[k];
    const Pack part = fastest * abs(r.step[k] - r.force[k]);
    found.left = select(part <= found.left, found.left, part);  // a NaN wins
  }
  return found;
}

// Newton's step from `at` with a share, into r.force.
inline void newton_share(const Plan& p, Rubbing& r, const Pack* largest, const Pack* slip, const Pack* at, Pack share,
                         Pack power) {
  const int n = p.frictions, m = n + 1;
  for (int k = 0; k < n; ++k) {
    r.force[k] = at[k];
    r.coefficient[k] = p.friction[k].pushes ? largest[k] : share * largest[k];
  }
  load_contacts<0, false>(p, r);
  differentiate_loads(p, r);
  Pack rest = power;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) r.border[k * m + j] = r.matrix[k * n + j];
    r.border[k * m + n] = p.friction[k].pushes ? Pack(0.0) : -(largest[k] * r.normal[k]);
    r.border[n * m + k] = slip[k];
    rest -= slip[k] * at[k];
  }
  r.border[n * m + n] = 0.0;
  r.right[n] = rest;
  const Factors f = {r.border, r.swap, m};
  factor(f);
  solve(f, r.right);
  for (int k = 0; k < n; ++k) r.force[k] = at[k] + r.right[k];
}

// The share, positive where the loads push the way the mechanism is about to move; infinite where friction takes no power,
// NaN where none was found. After a balance at rest whose inputs accelerate; the forces that it found stay.
inline Pack rest_share(const Plan& p, const Workspace& w) {
  const int n = p.frictions;
  if (!n) return Pack(__builtin_nan(""));
  Rubbing r = w.rubbing;
  r.force = r.share, r.normal = r.share + n, r.coefficient = r.share + 2 * n;
  Pack *const largest = r.share + 3 * n, *const slip = r.share + 4 * n, *const kept = r.share + 5 * n;
  r.softness = 0.0;
  const Pack scale = acceleration_level(p, w);
  const Mask still = scale <= Pack(0.0);
  const Pack per = select(still, Pack(0.0), Pack(1.0) / select(still, Pack(1.0), scale));
  Pack power = 0.0, able = 0.0;
  for (int i = 0; i < p.inputs; ++i) power -= r.effort[i] * (per * w.acceleration[p.input_column[i]]);
  for (int k = 0; k < n; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    const Motion &a = motion_of(w, j.first), &b = motion_of(w, j.second);
    slip[k] = f.pushes ? Pack(0.0) : per * ::power(b.acceleration - a.acceleration, r.drag[k]);
    largest[k] = f.pushes ? Pack(1.0) : Pack(f.at_rest);
    able += slip[k] * largest[k];
  }
  const Pack nothing = Pack(NOTHING_WORKS) * r.level;
  const Mask idle = ~(able > Pack(0.0));
  const Pack start = power / select(idle, Pack(1.0), able);
  for (int k = 0; k < n; ++k) r.force[k] = p.friction[k].pushes ? Pack(0.0) : start * largest[k];
  ShareTrial best = {Pack(__builtin_nan("")), Pack(__builtin_inf()), Pack(0.0)}, at = best;
  Mask stepped = all_lanes(false), done = idle;
  for (int iteration = 0; iteration < SHARE_ITERATIONS; ++iteration) {
    const ShareTrial now = try_share(p, r, largest, slip, power);
    const Mask leads = ~stepped | (now.left < Pack(SHARE_GAIN) * at.left);
    const Mask better = ~done & (now.left < best.left);
    best.share = select(better, now.share, best.share);
    best.left = select(better, now.left, best.left);
    best.size = select(better, now.size, best.size);
    done = done | (best.left <= Pack(FRICTION_TIGHT) * best.size) |
           (~leads & (best.left <= Pack(FRICTION_STALLED) * best.size));
    if (all(done)) break;
    for (int k = 0; k < n; ++k) {
      kept[k] = select(leads, r.force[k], kept[k]);
      r.origin[k] = select(leads, r.step[k], r.origin[k]);
    }
    at.share = select(leads, now.share, at.share);
    at.left = select(leads, now.left, at.left);
    newton_share(p, r, largest, slip, kept, at.share, power);
    // where Newton's step has led nowhere, half of the map's
    for (int k = 0; k < n; ++k) r.force[k] = select(leads, r.force[k], Pack(0.5) * (kept[k] + r.origin[k]));
    stepped = leads;
  }
  const Pack far = select(power < Pack(0.0), Pack(-__builtin_inf()), Pack(__builtin_inf()));
  const Pack size = abs(power);
  Pack share = select(best.left <= Pack(FRICTION_ACCEPT) * best.size, best.share, Pack(__builtin_nan("")));
  share = select(idle, far, share);
  // no load that could be told from rounding, against friction that cannot
  const Mask light = (size <= nothing) & ~(abs(share) <= Pack(1.0));
  return select((size <= Pack(0.0)) | light, Pack(0.0), share);
}

}  // namespace
