// The balance of forces of a pack of rows: everything applied, friction solved for, reactions and efforts found.
#pragma once

#include "friction.hpp"

namespace {

// `row_value` gives angles with their whole turns; the values of loads that vary stand in `w.load` (quantity_program.hpp).
// `acting`: the actuators' efforts are known loads.
template <class RowValue>
inline Balance balance_forces(const Plan& p, Workspace& w, bool moving, bool accelerating, int shift,
                              const RowValue& row_value, bool acting = false) {
  Balance balance = {p, w, zero_wrench(), zero_wrench(), moving, Pack(0.0)};
  apply_inertia(balance, accelerating);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_value);
  if (acting)
    for (int a = 0; a < p.actuators; ++a) apply_along_coordinate(balance, p.actuator[a].axis, w.actuation.motor[a]);
  if (p.frictions)
    apply_friction(balance, accelerating, shift);
  else
    distribute(p, w, shift);
  balance.level = reaction_level(p, w);
  return balance;
}

}  // namespace
