// Coulomb friction of joints from their own reactions (docs/friction.md).
//
// The surfaces of a joint slip with a speed made of its slides, and of its turns by the radius; friction is one force
// against that velocity, the coefficient times the joint's normal load. Reactions are linear in these forces: the balance
// is solved without them and for a unit of each, then the small system of the forces (friction_solver.hpp).
#pragma once

#include "arithmetic/elementary.hpp"
#include "forces/friction_solver.hpp"
#include "forces/reactions.hpp"

namespace {

// Speeds in parts of the mechanism's largest, and accelerations in parts of the largest, up to which a joint is at rest:
// rates of unknowns are off by up to about 1e-16 times a condition of 1e6.
constexpr double JOINT_AT_REST = 1e-10;
// Friction forces in parts of the largest reaction up to which there is none.
constexpr double NO_FRICTION = 1e-12;

// The part of a relative motion that rubs.
MECHKIN_INLINE Vec3 rubbing_part(int code, const Vec3& axis, const Vec3& a) {
  if (code < 0) return zero3();
  if (code == FREE_ALL) return a;
  const Vec3 along = dot(axis, a) * axis;
  return code == FREE_ALONG ? along : a - along;
}

// How the surfaces of a joint slip, or begin to; `speed` combines both.
struct Slip {
  Vec3 turn, slide;
  Pack speed;
};
MECHKIN_INLINE Slip slip_of(const Friction& f, const Vec3& axis, const Vec3& angular, const Vec3& linear) {
  Slip s = {rubbing_part(f.turns, axis, angular), rubbing_part(f.slides, axis, linear), Pack(0.0)};
  const Pack radius = f.radius;
  s.speed = sqrt(dot(s.slide, s.slide) + radius * radius * dot(s.turn, s.turn));
  return s;
}

// Of surfaces that slip: mu = sliding + (at rest - sliding) exp(-(v / speed)^2): Armstrong-Helouvry, Control of Machines with Friction (1991).
MECHKIN_INLINE Pack coefficient_at(const Friction& f, Pack speed) {
  if (!f.falls) return f.sliding;
  const Pack part = speed / Pack(f.speed);
  return Pack(f.sliding) + (Pack(f.at_rest) - Pack(f.sliding)) * exp(-(part * part));
}

// The largest component of the links' spatial accelerations.
inline Pack acceleration_level(const Plan& p, const Workspace& w) {
  Pack level = 0.0;
  for (int k = 0; k < p.links; ++k) {
    const Twist& t = w.motion[k].acceleration;
    level = component_level(level, {t.angular, t.linear});
  }
  return level;
}

MECHKIN_INLINE Vec3 of_length_one(const Vec3& a) { return (Pack(1.0) / sqrt(dot(a, a))) * a; }

// The tangent of a joint's curve, or the normal of its surface.
inline Vec3 course_axis(const Plan& p, const Workspace& w, int joint) {
  const Twist* const screw = w.screw + p.joints[joint].column;
  return of_length_one(p.joints[joint].type == TREE_A ? cross(screw[0].linear, screw[1].linear) : screw[0].linear);
}

// Axes, points and directions of everything that rubs.
inline void place_contacts(const Plan& p, const Workspace& w) {
  const Rubbing& r = w.rubbing;
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    r.axis[k] = f.course < 0 ? carried_vector(w, f.link, f.axis) : course_axis(p, w, f.course);
    r.point[k] = carried_point(w, j.point_on, j.point);
    for (int d = j.drive_begin; d < j.drive_end; ++d) r.effort_along[d] = along_coordinate(p, w, p.drive[d].axis, Pack(1.0));
    for (int c = f.contact_begin; c < f.contact_end; ++c)
      if (p.contact[c].code == CONTACT_ALONG)
        r.direction[c] = f.course < 0 ? carried_vector(w, f.link, p.contact[c].direction) : r.axis[k];
  }
}

// Direction, speed and coefficient of a joint's friction: against the velocity, where that is zero against the
// acceleration, in which the joint is about to move. `rates` is the mechanism's largest.
inline void aim_friction(const Plan& p, Workspace& w, int k, bool accelerating, Pack rates) {
  const Friction& f = p.friction[k];
  const JointPlace& j = p.place[f.place];
  const Rubbing& r = w.rubbing;
  const Vec3 axis = r.axis[k], point = r.point[k];
  const Motion &a = motion_of(w, j.first), &b = motion_of(w, j.second);
  if (f.pushes) {
    r.drag[k] = Pack(-1.0) * push_of(p, w, j);
    r.speed[k] = power(b.velocity - a.velocity, r.drag[k]);
    r.coefficient[k] = 1.0, r.at_rest[k] = 0.0;
    return;
  }
  const Pack radius = f.radius, lever = Pack(JOINT_AT_REST) * ((f.slides < 0 ? Pack(0.0) : Pack(1.0)) +
                                                               (f.turns < 0 ? Pack(0.0) : radius));
  Slip slip = slip_of(f, axis, b.velocity.angular - a.velocity.angular, b.velocity.at(point) - a.velocity.at(point));
  const Mask moving = slip.speed > lever * rates;
  Mask aimed = moving;
  r.speed[k] = select(moving, slip.speed, Pack(0.0));
  if (accelerating && !all(moving)) {
    const Slip start = slip_of(f, axis, b.acceleration.angular - a.acceleration.angular,
                               b.point_acceleration(point) - a.point_acceleration(point));
    aimed = moving | (start.speed > lever * acceleration_level(p, w));
    slip = {select(moving, slip.turn, start.turn), select(moving, slip.slide, start.slide),
            select(moving, slip.speed, start.speed)};
  }
  const Pack scale = select(aimed, Pack(1.0) / select(aimed, slip.speed, Pack(1.0)), Pack(0.0));
  r.drag[k] = force_at(point, scale * slip.slide);
  r.drag[k].moment += (scale * radius * radius) * slip.turn;
  r.coefficient[k] = select(moving, coefficient_at(f, r.speed[k]), Pack(f.at_rest));
  r.at_rest[k] = select(aimed, Pack(0.0), Pack(1.0));
}

// What the contacts carry of the joints' reactions now, `stride` apart from `out` on.
inline void read_contacts(const Plan& p, const Workspace& w, Vec3* out, int stride) {
  const Rubbing& r = w.rubbing;
  for (int k = 0; k < p.frictions; ++k) {
    const Friction& f = p.friction[k];
    const JointPlace& j = p.place[f.place];
    Wrench by = transmitted_wrench(w, j);
    for (int d = j.drive_begin; d < j.drive_end; ++d)
      by -= (Pack(p.drive[d].scale) * w.effort[p.drive[d].input]) * r.effort_along[d];
    if (f.contact_end == f.contact_begin + 1 && p.contact[f.contact_begin].code == CONTACT_TOTAL) {
      out[f.contact_begin * stride] = Pack(p.contact[f.contact_begin].share) * by.force;
      continue;
    }
    const Vec3 axis = r.axis[k], moment = by.moment - cross(r.point[k], by.force);
    const Vec3 radial = by.force - dot(axis, by.force) * axis, tilt = cross(moment, axis);
    for (int c = f.contact_begin; c < f.contact_end; ++c) {
      const Contact& at = p.contact[c];
      if (at.code == CONTACT_TOTAL)
        out[c * stride] = Pack(at.share) * by.force;
      else if (at.code == CONTACT_RADIAL)
        out[c * stride] = Pack(at.share) * radial + Pack(at.tilt) * tilt;
      else if (at.code == CONTACT_TRANSMITTED)
        out[c * stride] = {Pack(at.share) * by.force.x, Pack(0.0), Pack(0.0)};
      else
        out[c * stride] = {dot(r.direction[c], Pack(at.share) * by.force + Pack(at.tilt) * tilt) +
                               Pack(at.roll) * dot(axis, moment),
                           Pack(0.0), Pack(0.0)};
    }
  }
}

// The same where a unit of friction k acts, which takes `drag` from its second link.
inline void read_contacts_of(const Plan& p, const Workspace& w, int k, const Wrench& drag, Vec3* out, int stride) {
  read_contacts(p, w, out, stride);
  const Pack own = dot(w.rubbing.axis[k], drag.moment);
  for (int c = p.friction[k].contact_begin; c < p.friction[k].contact_end; ++c)
    if (p.contact[c].code == CONTACT_TRANSMITTED) out[c * stride].x -= Pack(p.contact[c].roll) * own;
}

inline void rub(Balance& balance, int k, Pack force) {
  const JointPlace& j = balance.p.place[balance.p.friction[k].place];
  const Wrench drag = force * balance.w.rubbing.drag[k];
  balance.apply(j.second, Pack(-1.0) * drag);
  balance.apply(j.first, drag);
}

// The sums over the tree of a unit of friction k: nothing of it goes beyond where the ways of both links to ground meet.
inline void rub_way(Balance& balance, int k) {
  const Plan& p = balance.p;
  const Workspace& w = balance.w;
  const JointPlace& j = p.place[p.friction[k].place];
  // parents have lower numbers
  for (int a = j.first, b = j.second; a != b;)
    if (a > b)
      w.carried[a] -= w.rubbing.drag[k], a = p.joints[a].parent;
    else
      w.carried[b] += w.rubbing.drag[k], b = p.joints[b].parent;
}

// Friction that a motion tells acts as a load: of what sticks, or is just starting to slip, no rate tells it.
inline void apply_told(Balance& balance) {
  const Workspace& w = balance.w;
  const Rubbing& r = w.rubbing;
  if (!r.is_told) return;
  if (balance.p.inputs) {
    for (int k = 0; k < balance.p.links; ++k) r.applied[k] = w.carried[k];
    distribute(balance.p, balance.w, 0);
    for (int i = 0; i < balance.p.inputs; ++i) r.effort[i] = w.effort[i];
    for (int k = 0; k < balance.p.links; ++k) w.carried[k] = r.applied[k];
  }
  for (int k = 0; k < balance.p.frictions; ++k) {
    const Pack* const t = r.told + k * TOLD_NUMBERS;
    const Mask told = ~(t[0] == Pack((double)TOLD_NOTHING));
    if (!any(told)) continue;
    const Wrench by = {{t[1], t[2], t[3]}, {t[4], t[5], t[6]}};
    r.drag[k] = {select(told, by.moment, r.drag[k].moment), select(told, by.force, r.drag[k].force)};
    r.coefficient[k] = select(told, Pack(0.0), r.coefficient[k]);
    r.speed[k] = select(told, Pack(0.0), r.speed[k]);
    r.at_rest[k] = select(told, Pack(0.0), r.at_rest[k]);
    rub(balance, k, select(told, Pack(1.0), Pack(0.0)));
  }
}

inline void mark_open(const Plan& p, const Rubbing& r) {
  for (int k = 0; k < p.frictions && r.is_told; ++k)
    r.state[k] = select(r.told[k * TOLD_NUMBERS] >= Pack((double)TOLD_OPEN), Pack((double)FRICTION_AT_REST), r.state[k]);
}

// Beside what was solved for: the drag of what is told is all of its friction.
inline void add_told(const Plan& p, const Rubbing& r) {
  for (int k = 0; k < p.frictions && r.is_told; ++k)
    r.force[k] += select(r.told[k * TOLD_NUMBERS] == Pack((double)TOLD_NOTHING), Pack(0.0), Pack(1.0));
}

// Reactions without friction and by a unit of each friction force; all loads have been applied.
inline void find_gains(Balance& balance, int shift) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  const Rubbing& r = w.rubbing;
  for (int k = 0; k < p.links; ++k) r.applied[k] = w.carried[k];
  distribute(p, w, shift);
  read_contacts(p, w, r.base, 1);
  if (!r.is_told)
    for (int i = 0; i < p.inputs; ++i) r.effort[i] = w.effort[i];
  w.rubbing.level = balance.level = reaction_level(p, w);
  for (int f = 0; f < p.frictions; ++f) {
    for (int k = 0; k < p.links; ++k) w.carried[k] = zero_wrench();
    if (p.hung_bodies) {
      rub(balance, f, Pack(1.0));
      distribute(p, w, 0);
    } else {
      rub_way(balance, f);
      distribute_sums(p, w, 0);
    }
    read_contacts_of(p, w, f, r.drag[f], r.gain + f, p.frictions);
  }
}

// No number for a friction that is loaded and whose direction is unknown, nor for those beside it, which its force
// reaches; nor for one without an answer.
inline void judge_friction(const Plan& p, const Rubbing& r, Pack level) {
  Mask lost = all_lanes(false);
  for (int k = 0; k < p.frictions; ++k) {
    const Mask loaded = ~(r.coefficient[k] * r.normal[k] <= Pack(NO_FRICTION) * level);
    const Mask open = r.state[k] == Pack((double)FRICTION_AT_REST);
    const Mask rests = ((r.at_rest[k] > Pack(0.0)) & loaded) | open;
    r.state[k] = select(rests, Pack((double)FRICTION_AT_REST), r.state[k]);
    lost = lost | rests;
  }
  const Pack nothing = __builtin_nan("");
  for (int k = 0; k < p.frictions; ++k) {
    const Mask none = lost | ~(r.state[k] == Pack((double)FRICTION_DECIDED));
    r.force[k] = select(none, nothing, r.force[k]);
    r.normal[k] = select(none, nothing, r.normal[k]);
  }
}

// Whether some of `count` drives that would brake without friction, with r.effort, has to push with it; `least`: powers up
// to it are rounding.
template <class Rate>
inline Pack self_locking(const Rubbing& r, int count, const Pack* effort, Pack least, const Rate& rate_of) {
  Mask locks = all_lanes(false);
  for (int i = 0; i < count; ++i) {
    const Pack rate = rate_of(i);
    locks = locks | ((r.effort[i] * rate < -least) & (effort[i] * rate > least));
  }
  return select(locks, Pack(1.0), Pack(0.0));
}

// Places, directions and coefficients of everything that rubs; `rates` is the mechanism's largest.
inline void aim_frictions(const Plan& p, Workspace& w, bool accelerating, Pack rates) {
  place_contacts(p, w);
  for (int k = 0; k < p.frictions; ++k) {
    aim_friction(p, w, k, accelerating, rates);
    w.rubbing.state[k] = (double)FRICTION_DECIDED;
  }
}

// What friction is solved from; every other load has been applied.
inline void prepare_friction(Balance& balance, bool accelerating, int shift) {
  balance.w.rubbing.rates = twist_level(balance.p, balance.w);
  aim_frictions(balance.p, balance.w, accelerating, balance.w.rubbing.rates);
  apply_told(balance);
  find_gains(balance, shift);
}
// Friction that is solved onto the links, and what all joints transmit.
inline void apply_friction(Balance& balance, int shift) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  Rubbing& r = w.rubbing;
  mark_open(p, r);
  judge_friction(p, r, balance.level);
  for (int k = 0; k < p.links; ++k) w.carried[k] = r.applied[k];
  for (int k = 0; k < p.frictions; ++k) rub(balance, k, r.force[k]);
  add_told(p, r);
  distribute(p, w, shift);
  r.self_locking = self_locking(r, p.inputs, w.effort, Pack(NOTHING_WORKS) * balance.level * r.rates,
                                [&](int i) { return w.rate[p.input_column[i]]; });
}

}  // namespace
