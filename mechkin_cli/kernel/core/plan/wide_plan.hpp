// A plan for each lane: plans of one structure whose constants stand side by side in packs, so that variants march
// together.
#pragma once

#include "arithmetic/pack.hpp"

namespace {
using PlanNumber = Pack;
}

#include "plan/plan_constants.hpp"

namespace {

// The numbers of all lanes' plans at one place of them.
struct Lanes {
  const LanePlan* const* plan;  // LANES
  template <class At>
  Pack number(At&& at) const {
    double values[LANES];
    for (int i = 0; i < LANES; ++i) values[i] = at(*plan[i]);
    return load(values);
  }
  template <class At>
  void numbers(Pack* to, int count, At&& at) const {
    for (int n = 0; n < count; ++n) to[n] = number([&](const LanePlan& p) { return at(p)[n]; });
  }
  template <class At>
  void frame(Frame* to, At&& at) const { gather_frame(*this, to, at); }
};

// Writes the wide plan of some plans (LANES), as widen_by.
MECHKIN_RARE long widen(const LanePlan* const* plans, char* memory) { return widen_by(*plans[0], Lanes{plans}, memory); }

}  // namespace
