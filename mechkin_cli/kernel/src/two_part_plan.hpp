// A plan whose constants have two parts: high and low, or midpoint and radius, each a plan of doubles of one structure.
#pragma once

#include "arithmetic/two_parts.hpp"

namespace {
using PlanNumber = TwoParts;
}

#include "plan_constants.hpp"

namespace {

// Without a plan of the second parts they are zero.
struct TwoPartConstants {
  const LanePlan& first;
  const LanePlan* second;
  template <class At>
  TwoParts number(At&& at) const { return {at(first), second ? at(*second) : 0.0}; }
  template <class At>
  void numbers(TwoParts* to, int count, At&& at) const {
    for (int n = 0; n < count; ++n) to[n] = {at(first)[n], second ? at(*second)[n] : 0.0};
  }
  template <class At>
  void frame(Frame* to, At&& at) const { gather_frame(*this, to, at); }
};

inline TwoParts ratio(TwoParts a, TwoParts b) {
  const Pack q = Pack(a) / Pack(b);
  return {lane(part_of(q, 0), 0), lane(part_of(q, 1), 0)};
}

// Writes the plan of the two, as widen_by; what follows from constants is computed of both their parts.
inline long join_parts(const LanePlan& first, const LanePlan* second, char* memory) {
  const long bytes = widen_by(first, TwoPartConstants{first, second}, memory);
  if (!memory) return bytes;
  Plan& joined = *reinterpret_cast<Plan*>(memory);
  joined.row_weight = ratio(joined.length, joined.size);
  TwoParts* const weight = const_cast<TwoParts*>(joined.column_weight);  // the memory is the caller's
  for (int c = 0; c < first.columns; ++c)
    // angles weigh 1, slides size by length
    weight[c] = first.column_weight[c] == 1.0 ? TwoParts{1.0, 0.0} : ratio(joined.size, joined.length);
  return bytes;
}

}  // namespace
