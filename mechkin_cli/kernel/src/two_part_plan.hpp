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

// Writes the plan of the two, as widen_by.
inline long join_parts(const LanePlan& first, const LanePlan* second, char* memory) {
  return widen_by(first, TwoPartConstants{first, second}, memory);
}

}  // namespace
