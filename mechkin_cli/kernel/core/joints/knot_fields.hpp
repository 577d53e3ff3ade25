// A field of knots, a knot for each lane.
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/functions.hpp"

namespace {

template <class Number>
inline Pack field_of_lanes(const KnotOf<Number>* const* knot, Number KnotOf<Number>::*of) {
  double values[PARTS][LANES];
  for (int i = 0; i < LANES; ++i) {
    const Pack number = knot[i]->*of;
    for (int k = 0; k < PARTS; ++k) values[k][i] = lane(part_of(number, k), i);
  }
  Real part[PARTS];
  for (int k = 0; k < PARTS; ++k) part[k] = load(values[k]);
  return from_parts(part);
}

}  // namespace
