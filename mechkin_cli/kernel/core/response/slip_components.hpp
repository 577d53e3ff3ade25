// How many components the slip of a joint has in a motion.
#pragma once

#include "plan/plan.hpp"

namespace {

constexpr int components_of(int code) { return code < 0 ? 0 : code == FREE_ALONG ? 1 : code == FREE_ALL ? 3 : 2; }

// Whether a joint slips along one direction alone, so that its slip has a sign. What pushes has the direction of its force.
template <class Number>
inline bool has_signed_slip(const FrictionOf<Number>& f) {
  return f.screws || f.pushes || components_of(f.turns) + components_of(f.slides) == 1;
}

template <class AnyPlan, class Number>
inline int slip_components(const AnyPlan& p, const FrictionOf<Number>& f) {
  if (has_signed_slip(f) || (p.charts == 1 && p.inputs == 0)) return 1;
  return components_of(f.turns) + components_of(f.slides);
}

template <class AnyPlan>
inline int slip_columns(const AnyPlan& p) {
  int columns = 0;
  for (int k = 0; k < p.frictions; ++k) columns += slip_components(p, p.friction[k]);
  return columns;
}

}  // namespace
