// The balance of forces of a pack of rows: everything applied, friction solved for, reactions and efforts found.
#pragma once

#include "forces/friction.hpp"

namespace {

// Inertia and all loads but friction onto the links. `row_value` gives angles with their whole turns; the values of loads
// that vary stand in `w.load` (quantity_program.hpp).
template <class RowValue>
inline void apply_loads(Balance& balance, bool accelerating, const RowValue& row_value) {
  const Plan& p = balance.p;
  apply_inertia(balance, accelerating);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_value);
}

template <class RowValue>
inline Balance balance_forces(const Plan& p, Workspace& w, bool moving, bool accelerating, int shift,
                              const RowValue& row_value) {
  Balance balance = {p, w, zero_wrench(), zero_wrench(), moving, Pack(0.0)};
  apply_loads(balance, accelerating, row_value);
  if (p.frictions)
    apply_friction(balance, accelerating, shift);
  else
    distribute(p, w, shift);
  return balance;
}

}  // namespace
