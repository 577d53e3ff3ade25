// Programs of quantities over intervals.
#pragma once

#include "forces/program_reads.hpp"
#include "tape/enclosed_tape.hpp"

namespace {

// The values of loads that vary into `w.load`.
template <class RowValue>
inline void enclose_loads(const Plan& p, Workspace& w, const RowValue& row_value) {
  if (!p.load_values) return;
  read_program(p, w, p.law, row_value, w.law);
  replay_pack(instructions_of(p.law), w.law);
  for (int v = 0; v < p.load_values; ++v) w.load[v] = w.law[p.law.output[v]];
}

}  // namespace
