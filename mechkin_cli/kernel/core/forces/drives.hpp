// Efforts and rates of inputs, of the motors that move them through constraints, and of actuators.
#pragma once

#include "forces/wrenches.hpp"

namespace {

// Whether a motor of its own, or an actuator, answers for an input.
MECHKIN_INLINE bool is_led(const Plan& p, int input) {
  for (int t = 0; t < p.input_constraints; ++t)
    if (p.input_constraint[t].input == input) return true;
  return false;
}

// The freedoms that actuators answer for: inputs of the motion that follow no other through a constraint.
MECHKIN_INLINE int free_inputs(const Plan& p) {
  int count = 0;
  for (int i = 0; i < p.driven; ++i) count += !is_led(p, i);
  return count;
}

MECHKIN_INLINE Pack actuator_rate(const Plan& p, const Workspace& w, int a) {
  Pack value, rate;
  const Actuator& at = p.actuator[a];
  joint_coordinate(p, w, at.axis, at.reference, at.freedom, true, &value, &rate);
  return rate;
}

// The generalised effort of each free input with what its constraints transmit, for the inputs' own motors.
template <class RateByLeader>
inline void find_motors(const Plan& p, Workspace& w, const RateByLeader& rate_by_leader) {
  Pack* const motor = w.actuation.motor;
  for (int i = 0; i < p.inputs; ++i) motor[i] = w.effort[i];
  for (int t = 0; t < p.input_constraints; ++t) motor[p.input_constraint[t].leader] += rate_by_leader(t) * w.effort[p.input_constraint[t].input];
}

// What a joint's first link exerts on the second in all, the moment about the joint's point: constraint, drives and
// actuators, without joint loads.
inline Wrench total_wrench(const Plan& p, const Workspace& w, const JointPlace& j) {
  const Wrench held = joint_wrench(p, w, j);
  const Vec3 at = carried_point(w, j.point_on, j.point);
  Wrench r = {without_free(p, w, j, false, held.moment - cross(at, held.force)),
              without_free(p, w, j, true, held.force)};
  const auto add = [&](int axis, Pack effort) {
    const Wrench own = along_coordinate(p, w, axis, effort);
    r.force += own.force;
    r.moment += own.moment - cross(at, own.force);
  };
  for (int d = j.drive_begin; d < j.drive_end; ++d) {
    const Drive& drive = p.drive[d];
    const bool answered = p.actuators && drive.input < p.driven && !is_led(p, drive.input);
    if (!answered) add(drive.axis, Pack(drive.scale) * w.effort[drive.input]);
  }
  for (int a = 0; a < p.actuators; ++a)
    if (&p.place[p.axis[p.actuator[a].axis].place] == &j) add(p.actuator[a].axis, w.actuation.motor[a]);
  return r;
}

}  // namespace
