// The balance of a row's powers, which shares no sum with the balance of its forces (powers.hpp).
#pragma once

#include "forces/balance.hpp"
#include "forces/powers.hpp"

namespace {

// |sum of powers| / sum of their magnitudes; nan where nothing moves or works, for then no balance is told. `level` is
// that of the wrenches, see reaction_level.
template <class RowValue, class More>
inline Pack power_error(const Plan& p, const Workspace& w, bool accelerating, Pack level, const RowValue& row_value,
                        const More& add_more) {
  Powers powers = {Pack(0.0), Pack(0.0)};
  for (int k = 0; k < p.links; ++k) {
    if (!p.inertia[k].present) continue;
    add_gravity_power(powers, p, w, k);
    if (accelerating) add_kinetic_power(powers, p.inertia[k], w.pose[k], w.motion[k]);
  }
  for (int l = 0; l < p.loads; ++l) add_load_power(powers, p, w, p.load[l], row_value);
  for (int f = 0; f < p.frictions; ++f) powers.add(-(w.rubbing.force[f] * w.rubbing.speed[f]));
  for (int i = 0; i < p.inputs; ++i) powers.add(w.effort[i] * w.rate[p.input_column[i]]);
  add_more(powers);
  const Mask none = powers.size <= Pack(NOTHING_WORKS) * level * twist_level(p, w);
  const Pack size = select(none, Pack(1.0), powers.size);
  return select(none, Pack(__builtin_nan("")), abs(powers.sum) / size);
}

}  // namespace
