// Friction of a motion (docs/friction.md, Motions): each joint that rubs slips one way, or sticks.
//
// The acceleration is eliminated first: a friction force and what it accelerates act together,
//
//     u'' = M^-1 (-r - sum of B_s^T z_s - B_h^T h),
//
// with B the rows of the slips along their units. So are the forces h of what sticks, by that its slip stays zero:
// B_h M^-1 B_h^T h = the slip's derivative without h. Reactions are then linear in the forces z of what slips alone, and
// the small system of these forces is that of a sweep (friction_solver.hpp).
#pragma once

#include "response/held_slips.hpp"

namespace {

// Slips in several directions, in parts of what the links' rates would give, whose direction is rounding.
constexpr double NO_DIRECTION = 1e-12;

// What friction makes of a stage: lanes without an answer, the power that it takes, and the efforts of driven inputs.
struct Slid {
  Mask undecided;
  Pack power;
};

// What u'' needs of the joints, beside what w.carried has.
inline void accelerate(const Plan& p, Workspace& w, const ReducedMotion& m, const Pack* second) {
  for (int k = 0; k < p.links; ++k) {
    if (!p.inertia[k].present) continue;
    for (int i = 0; i < p.charts; ++i)
      w.carried[k] += second[i] * momentum(p.inertia[k], w.pose[k], m.twist[i * p.links + k]);
  }
}

// Whether a slip has a sign.
MECHKIN_INLINE Mask slips_along_line(const Slips& s, const SlipsGiven& given, int k) {
  return s.first[k + 1] - s.first[k] == 1 ? all_lanes(true) : given.span[k] == Pack(1.0);
}

// Units of friction and coefficients. What sticks has all its columns, what slips the first alone.
inline void aim_slips(const Plan& p, const Workspace& w, const Slips& s, const SlipsGiven& given) {
  const Rubbing& r = w.rubbing;
  const Pack rates = twist_level(p, w);
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const int begin = s.first[k], end = s.first[k + 1];
    const Mask sticks = given.sense[k] == Pack(0.0);
    Pack square = 0.0;
    for (int c = begin; c < end; ++c) {
      square += s.rate[c] * s.rate[c];
      s.sticks[c] = sticks;
      s.unit[c] = select(sticks, s.frame[c], zero_wrench());
    }
    Pack speed = sqrt(square);
    const Pack fast = speed;
    const Mask is_line = slips_along_line(s, given, k);
    if (all(is_line)) {
      s.unit[begin] = select(sticks, Pack(1.0), given.sense[k]) * s.frame[begin];
    } else {
      const Pack lever = (f.slides < 0 ? Pack(0.0) : Pack(1.0)) + (f.turns < 0 ? Pack(0.0) : Pack(f.radius));
      const Mask begins = speed <= Pack(NO_DIRECTION) * lever * rates;
      // beyond its zero a slip goes on as before
      Pack ahead = 0.0;
      for (int c = begin; c < end; ++c) ahead += given.aim[c] * s.rate[c];
      const Mask is_back = ~is_line & ~(given.armed[k] == Pack(0.0)) & (ahead < Pack(0.0));
      speed = select(is_back, -speed, speed);
      const Pack per = Pack(1.0) / select(begins, Pack(1.0), speed);
      Wrench along = zero_wrench();
      for (int c = begin; c < end; ++c) along += select(begins, given.aim[c], per * s.rate[c]) * s.frame[c];
      along = select(is_line, given.sense[k] * s.frame[begin], along);
      s.unit[begin] = select(sticks, s.unit[begin], along);
    }
    // beyond its zero a slip goes on with its sense
    r.speed[k] = select(sticks, Pack(0.0), select(is_line, given.sense[k] * s.rate[begin], speed));
    const Mask quiet = ~(given.quiet[k] == Pack(0.0));
    r.coefficient[k] = select(sticks, Pack(0.0), select(quiet, Pack(f.at_rest), coefficient_at(f, fast)));
    r.state[k] = (double)FRICTION_DECIDED;
  }
}

// Whether some lane has friction along a column.
inline bool acts(const Slips& s, int k, int c) { return c == s.first[k] || any(s.sticks[c]); }

// Accelerations by a unit along each column, and what the contacts carry of it.
inline void find_answers(Balance& balance, const ReducedMotion& m, const Slips& s, const Pack* second) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  const int d = directions(p), n = p.charts;
  for (int k = 0; k < p.frictions; ++k) {
    const JointPlace& j = p.place[p.friction[k].place];
    for (int c = s.first[k]; c < s.first[k + 1]; ++c) {
      for (int i = 0; i < d; ++i) s.along[c * d + i] = power(direction_of(p, m, j, i), s.unit[c]);
      s.start[c] = convective_slip(w, j, w.rubbing.point[k], s.unit[c]);
      for (int i = 0; i < n; ++i) {
        s.start[c] += s.along[c * d + i] * second[i];
        s.by[c * n + i] = -s.along[c * d + i];
      }
      if (!acts(s, k, c)) {
        for (int i = 0; i < n; ++i) s.by[c * n + i] = 0.0;
        for (int e = 0; e < p.contacts; ++e) s.load[e * s.columns + c] = zero3();
        continue;
      }
      solve_factored(p, m, s.by + c * n);
      for (int l = 0; l < p.links; ++l) w.carried[l] = zero_wrench();
      balance.apply(j.second, Pack(-1.0) * s.unit[c]);
      balance.apply(j.first, s.unit[c]);
      accelerate(p, w, m, s.by + c * n);
      distribute(p, w, 0);
      read_contacts_of(p, w, k, s.unit[c], s.load + c, s.columns);
    }
  }
}

// Forces along the columns' units, and u'' with them.
inline void gather_forces(const Plan& p, const Slips& s, const Rubbing& r, Pack* second) {
  const int m = s.columns, n = p.frictions;
  for (int k = 0; k < n; ++k)
    for (int c = s.first[k]; c < s.first[k + 1]; ++c) {
      Pack held = s.hold[c * (n + 1)];
      for (int f = 0; f < n; ++f) held += r.force[f] * s.hold[c * (n + 1) + f + 1];
      s.force[c] = select(s.sticks[c], held, c == s.first[k] ? r.force[k] : Pack(0.0));
    }
  for (int c = 0; c < m; ++c)
    for (int i = 0; i < p.charts; ++i) second[i] += s.force[c] * s.by[c * p.charts + i];
}

// What is told of the slips: along the frame, not along the units.
inline void tell_slips(const Plan& p, const Slips& s, const Rubbing& r, const SlipsGiven& given, const Pack* second,
                       const SlipsFound& found) {
  const int d = directions(p);
  for (int k = 0; k < p.frictions; ++k) {
    const int begin = s.first[k], end = s.first[k + 1];
    found.limit[k] = Pack(p.friction[k].at_rest) * r.normal[k];
    found.state[k] = r.state[k];
    found.answer[k] = 0.0;
    const Mask is_line = slips_along_line(s, given, k);
    for (int c = begin; c < end; ++c) {
      const Mask rests = r.speed[k] == Pack(0.0);
      const Pack turned = select(rests, given.aim[c], s.rate[c] / select(rests, Pack(1.0), r.speed[k]));
      const Pack part = select(is_line, c == begin ? given.sense[k] : Pack(0.0), turned);
      found.rate[c] = s.rate[c];
      found.force[c] = select(s.sticks[c], s.force[c], part * s.force[begin]);
      found.answer[k] = max(found.answer[k], s.inverse[c * s.columns + c]);
      found.second[c] = s.convective[c];
      for (int i = 0; i < p.charts; ++i) {
        found.second[c] += s.row[c * d + i] * second[i];
        found.row[c * p.charts + i] = select(s.mobile[c], s.row[c * d + i], Pack(0.0));
      }
    }
  }
}

// What rows are told: of what sticks all that its rates do not tell.
inline void tell_rows(const Plan& p, const Workspace& w, const Slips& s, const Rubbing& r, const SlipsFound& found) {
  const Pack rates = twist_level(p, w);
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const int begin = s.first[k];
    const Pack lever = (f.slides < 0 ? Pack(0.0) : Pack(1.0)) + (f.turns < 0 ? Pack(0.0) : Pack(f.radius));
    Wrench sum = zero_wrench();
    Mask mobile = all_lanes(false);
    for (int c = begin; c < s.first[k + 1]; ++c) {
      sum += s.force[c] * s.unit[c];
      mobile = mobile | s.mobile[c];
    }
    const Mask sticks = s.sticks[begin], starts = ~sticks & mobile & (r.speed[k] <= Pack(JOINT_AT_REST) * lever * rates);
    const Mask loaded = ~(Pack(f.at_rest) * r.normal[k] <= Pack(NO_FRICTION) * *found.level);
    const Mask open = sticks & loaded & (~mobile | ~(found.loose[k] == Pack(0.0)));
    const Pack how = select(mobile, Pack((double)TOLD_OPEN), Pack((double)TOLD_IMMOBILE));
    Pack* const told = found.told + k * TOLD_NUMBERS;
    told[0] = select(open, how, select(sticks | starts, Pack((double)TOLD_FORCE), Pack((double)TOLD_NOTHING)));
    const Vec3 part[2] = {sum.moment, sum.force};
    for (int i = 0; i < 2; ++i) {
      told[1 + 3 * i] = part[i].x, told[2 + 3 * i] = part[i].y, told[3 + 3 * i] = part[i].z;
    }
  }
}

// The small system before it is solved, as SlipSystem has it; `open`: lanes in which loads that slip are not unique.
inline void tell_system(const Plan& p, const Slips& s, const Rubbing& r, Mask open, Pack* to) {
  const int n = p.frictions, m = s.columns;
  const auto put = [&](Pack x) { *to++ = x; };
  put(select(open, Pack(1.0), Pack(0.0)));
  for (int k = 0; k < n; ++k) put(r.coefficient[k]);
  for (int k = 0; k < n; ++k)
    for (int f = 0; f <= n; ++f) {
      const int own = s.first[k];
      Pack second = f ? select(s.sticks[s.first[f - 1]], Pack(0.0), -s.inverse[own * m + s.first[f - 1]]) : s.start[own];
      for (int c = 0; c < m; ++c) second -= s.inverse[own * m + c] * s.hold[c * (n + 1) + f];
      put(second);
    }
  for (int e = 0; e < p.contacts; ++e)
    for (int f = 0; f <= n; ++f) {
      const Vec3 load = f ? r.gain[e * n + f - 1] : r.base[e];
      put(load.x), put(load.y), put(load.z);
    }
}

// u'' with friction in the place of `second`.
template <class RowValue>
inline Slid slide(const Plan& p, Workspace& w, const ReducedMotion& m, const Slips& s, const SlipsGiven& given,
                  const RowValue& row_value, Pack* second, const SlipsFound& found) {
  Balance balance = {p, w, zero_wrench(), zero_wrench(), true, Pack(0.0)};
  Rubbing& r = w.rubbing;
  apply_inertia(balance, true);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_value);
  place_contacts(p, w);
  find_slips(p, w, m, s, given, found);
  aim_slips(p, w, s, given);
  accelerate(p, w, m, second);
  distribute(p, w, 0);
  read_contacts(p, w, s.base, 1);
  *found.level = reaction_level(p, w);
  find_answers(balance, m, s, second);
  for (int k = 0; k < p.frictions; ++k) found.loose[k] = 0.0;
  Slid slid = {factor_held(p, s, given, found.loose), Pack(0.0)};
  hold_slips(p, s, r);
  if (found.system) tell_system(p, s, r, slid.undecided, found.system);
  solve_friction(p, r);
  gather_forces(p, s, r, second);
  tell_slips(p, s, r, given, second, found);
  tell_rows(p, w, s, r, found);
  for (int k = 0; k < p.frictions; ++k) {
    slid.undecided = slid.undecided | ~(r.state[k] == Pack((double)FRICTION_DECIDED));
    slid.power += r.force[k] * r.speed[k];
  }
  for (int i = p.charts; i < directions(p); ++i)
    for (int c = 0; c < s.columns; ++c) m.force[i] += s.force[c] * s.along[c * directions(p) + i];
  return slid;
}

}  // namespace
