// A plan whose constants have parts: high and low, or midpoint and radius, or high, low and radius, each a plan of doubles
// of one structure.
#pragma once

#include "arithmetic/pack.hpp"

namespace {
#if MECHKIN_ARITHMETIC == MECHKIN_INTERVALS
using PlanNumber = ThreeParts;
MECHKIN_INLINE PlanNumber joined(double a, double b, double c) { return {a, b, c}; }
#else
using PlanNumber = TwoParts;
MECHKIN_INLINE PlanNumber joined(double a, double b, double) { return {a, b}; }
#endif
}

#include "plan/plan_constants.hpp"

namespace {

// Without a plan of other parts they are zero.
struct PartConstants {
  const LanePlan& first;
  const LanePlan *second, *third;
  template <class At>
  PlanNumber number(At&& at) const {
    return joined(at(first), second ? at(*second) : 0.0, third ? at(*third) : 0.0);
  }
  template <class At>
  void numbers(PlanNumber* to, int count, At&& at) const {
    for (int n = 0; n < count; ++n)
      to[n] = joined(at(first)[n], second ? at(*second)[n] : 0.0, third ? at(*third)[n] : 0.0);
  }
  template <class At>
  void frame(Frame* to, At&& at) const { gather_frame(*this, to, at); }
};

inline PlanNumber ratio(PlanNumber a, PlanNumber b) {
  const Pack q = Pack(a) / Pack(b);
  return joined(lane(part_of(q, 0), 0), lane(part_of(q, 1), 0), PARTS > 2 ? lane(part_of(q, 2), 0) : 0.0);
}

// Writes the plan of the parts, as widen_by; what follows from constants is computed of all their parts.
inline long join_all_parts(const LanePlan& first, const LanePlan* second, const LanePlan* third, char* memory) {
  const long bytes = widen_by(first, PartConstants{first, second, third}, memory);
  if (!memory) return bytes;
  Plan& plan = *reinterpret_cast<Plan*>(memory);
  plan.row_weight = ratio(plan.length, plan.size);
  PlanNumber* const weight = const_cast<PlanNumber*>(plan.column_weight);  // the memory is the caller's
  for (int c = 0; c < first.columns; ++c)
    // angles weigh 1, slides size by length
    weight[c] = first.column_weight[c] == 1.0 ? joined(1.0, 0.0, 0.0) : ratio(plan.size, plan.length);
  return bytes;
}
inline long join_parts(const LanePlan& first, const LanePlan* second, char* memory) {
  return join_all_parts(first, second, nullptr, memory);
}

}  // namespace
