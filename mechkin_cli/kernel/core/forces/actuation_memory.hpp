// What a pack of rows keeps of the efforts where they act (actuation.hpp).
#pragma once

#include "arithmetic/pack.hpp"
#include "plan/plan.hpp"

namespace {

struct Actuation {
  Pack* motor;              // actuators, or inputs where there are none: efforts where they act
  Pack* influence;          // (columns + actuators + 1 + frictions) x inputs, where there are actuators
  Pack* influence_factors;  // (actuators + 2) x inputs, likewise
  Pack* share;              // (1 + frictions) x efforts(plan): without friction, and by a unit of each
  Pack* least;              // one: least rate of the actuators, all together, in a motion of length one
};

// Room for the efforts of all inputs, or of all actuators.
MECHKIN_INLINE int efforts(const Plan& p) { return p.inputs + p.actuators + 1; }

// Gives the arrays their places; `take(bytes)` is room for some bytes.
template <class Take>
inline void lay_out_actuation(const Plan& p, const Take& take, Actuation* a) {
  const long pack = sizeof(Pack), inputs = p.actuators ? p.inputs : 0;
  a->motor = (Pack*)take(efforts(p) * pack);
  a->influence = (Pack*)take((p.columns + p.actuators + 1 + p.frictions) * inputs * pack);
  a->influence_factors = (Pack*)take((p.actuators + 2) * inputs * pack);
  a->share = (Pack*)take(p.actuators ? (1 + p.frictions) * efforts(p) * pack : 0);
  a->least = (Pack*)take(pack);
}

}  // namespace
