// The balance of a row with the efforts where they act: at the inputs, or at actuators (actuation.hpp), and the friction
// that goes by the reactions of these efforts.
//
// A friction force has efforts of its own: those that a unit of it wants at the inputs, taken to the actuators. They act
// together with it, so that reactions are linear in the friction forces alone, as without actuators. Of more actuators
// than freedoms each has the efforts of least norm, and so has their sum.
#pragma once

#include "forces/actuation.hpp"

namespace {

// Adds to the loads of the contacts by a unit of each friction those by the efforts that it wants.
inline void reach_contacts(Balance& balance) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  const Rubbing& r = w.rubbing;
  for (int a = 0; a < p.actuators; ++a) {
    for (int k = 0; k < p.links; ++k) w.carried[k] = zero_wrench();
    apply_along_coordinate(balance, p.actuator[a].axis, Pack(1.0));
    distribute(p, w, 0);
    read_contacts(p, w, r.reach, 1);
    for (int f = 0; f < p.frictions; ++f) {
      const Pack share = w.actuation.share[(1 + f) * efforts(p) + a];
      for (int c = 0; c < p.contacts; ++c) r.gain[c * p.frictions + f] += share * r.reach[c];
    }
  }
}

// As find_gains, the efforts acting at the actuators.
template <class RateByLeader>
inline void find_actuated_gains(Balance& balance, int shift, const RateByLeader& rate_by_leader) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  const Rubbing& r = w.rubbing;
  const Actuation& at = w.actuation;
  for (int k = 0; k < p.links; ++k) r.applied[k] = w.carried[k];
  for (int number = 0; number <= p.frictions; ++number) {
    if (number) {
      for (int k = 0; k < p.links; ++k) w.carried[k] = zero_wrench();
      rub(balance, number - 1, Pack(1.0));
    }
    distribute(p, w, 0);
    if (number) read_contacts_of(p, w, number - 1, r.drag[number - 1], r.gain + number - 1, p.frictions);
    find_motors(p, w, rate_by_leader);
    want_efforts(p, at, number);
  }
  *at.least = solve_actuators(p, at, 1 + p.frictions, at.share);
  reach_contacts(balance);
  for (int k = 0; k < p.links; ++k) w.carried[k] = r.applied[k];
  for (int a = 0; a < p.actuators; ++a) {
    r.effort[a] = at.share[a];
    apply_along_coordinate(balance, p.actuator[a].axis, r.effort[a]);
  }
  distribute(p, w, shift);
  read_contacts(p, w, r.base, 1);
  w.rubbing.level = balance.level = reaction_level(p, w);
}

// As apply_friction, the efforts acting at the actuators.
template <class RateByLeader>
inline void apply_actuated_friction(Balance& balance, bool accelerating, int shift, const RateByLeader& rate_by_leader) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  Rubbing& r = w.rubbing;
  const Pack rates = twist_level(p, w);
  aim_frictions(p, w, accelerating, rates);
  apply_told(balance);
  find_actuated_gains(balance, shift, rate_by_leader);
  solve_friction(p, r);
  mark_open(p, r);
  // a singular set has no efforts, whatever friction there is
  const Mask held = *w.actuation.least > Pack(ACTUATORS_AT_REST);
  for (int k = 0; k < p.frictions; ++k) r.state[k] = select(held, r.state[k], Pack((double)FRICTION_DECIDED));
  judge_friction(p, r, balance.level);
  for (int k = 0; k < p.frictions; ++k) r.state[k] = select(held, r.state[k], Pack((double)FRICTION_DECIDED));
  for (int k = 0; k < p.links; ++k) w.carried[k] = r.applied[k];
  Pack* const motor = w.actuation.motor;
  for (int a = 0; a < p.actuators; ++a) {
    motor[a] = r.effort[a];
    for (int f = 0; f < p.frictions; ++f) motor[a] += r.force[f] * w.actuation.share[(1 + f) * efforts(p) + a];
    apply_along_coordinate(balance, p.actuator[a].axis, motor[a]);
  }
  for (int k = 0; k < p.frictions; ++k) rub(balance, k, r.force[k]);
  add_told(p, r);
  distribute(p, w, shift);
  r.self_locking = self_locking(r, p.actuators, motor, Pack(NOTHING_WORKS) * balance.level * rates,
                                [&](int a) { return actuator_rate(p, w, a); });
}

// `row_value` gives angles with their whole turns, `rate_by_leader` rates of inputs by those that they follow. Friction is
// solved for where actuators share its effort; else the packs that go together solve it together, and finish_balance follows.
template <class RowValue, class RateByLeader>
inline void begin_balance(Balance& balance, bool accelerating, int shift, const RowValue& row_value,
                          const RateByLeader& rate_by_leader) {
  const Plan& p = balance.p;
  Workspace& w = balance.w;
  if (!p.actuators) {
    balance_loads(balance, accelerating, shift, row_value);
    if (!p.frictions) find_motors(p, w, rate_by_leader);
    return;
  }
  if (p.frictions) {
    apply_loads(balance, accelerating, row_value);
    return apply_actuated_friction(balance, accelerating, shift, rate_by_leader);
  }
  // the actuators' efforts will leave nothing to the inputs that they answer for but rounding
  Balance by_inputs = balance;
  balance_loads(by_inputs, accelerating, 0, row_value);
  find_motors(p, w, rate_by_leader);
  want_efforts(p, w.actuation, 0);
  *w.actuation.least = solve_actuators(p, w.actuation, 1, w.actuation.motor);
  apply_loads(balance, accelerating, row_value);
  for (int a = 0; a < p.actuators; ++a) apply_along_coordinate(balance, p.actuator[a].axis, w.actuation.motor[a]);
  distribute(p, w, shift);
}
MECHKIN_INLINE bool solves_friction_together(const Plan& p) { return p.frictions && !p.actuators; }
template <class RateByLeader>
inline void finish_balance(Balance& balance, int shift, const RateByLeader& rate_by_leader) {
  apply_friction(balance, shift);
  find_motors(balance.p, balance.w, rate_by_leader);
}

}  // namespace
