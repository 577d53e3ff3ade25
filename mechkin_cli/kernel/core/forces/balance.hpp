// The balance of forces of a pack of rows: everything applied, reactions and efforts found.
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

// The balance without friction, of which what is solved for then is prepared.
template <class RowValue>
inline void balance_loads(Balance& balance, bool accelerating, int shift, const RowValue& row_value) {
  apply_loads(balance, accelerating, row_value);
  if (balance.p.frictions)
    prepare_friction(balance, accelerating, shift);
  else
    distribute(balance.p, balance.w, shift);
}

}  // namespace
