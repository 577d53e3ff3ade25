// What the joints that rub need of a workspace (friction.hpp).
#pragma once

#include "plan/plan.hpp"
#include "arithmetic/vector.hpp"

namespace {

struct Rubbing {
  Wrench* applied;  // links: what they need of their joints, before the tree sums it
  Wrench* drag;     // frictions: what a unit of friction takes from the second link
  Pack *speed, *coefficient, *force, *normal, *state, *at_rest;  // frictions: of the surfaces, and what was found
  Pack *matrix, *bound, *border, *right, *step, *weight;  // of the small system: squares, then vectors
  Pack* per_weight;       // frictions: 1 / weight
  Pack *origin, *newton;  // frictions: where a step begins, and Newton's step from there
  Mask* swap;
  Vec3 *axis, *point;  // frictions: now
  Vec3* direction;     // contacts: now
  Wrench* effort_along;  // drives: by a unit of effort along the coordinate, of joints that rub
  Vec3 *base, *gain;   // contacts: their loads without friction; by a unit of each friction
  Vec3* load;          // contacts: their loads with the friction forces
  Pack* size;          // contacts: magnitudes of these
  Vec3* reach;         // contacts: their loads by a unit of one actuator (actuated_balance.hpp)
  Pack* effort;        // inputs, or actuators: of the drives without friction
  Pack* told;          // frictions x TOLD_NUMBERS, see FrictionTold
  bool is_told;
  Pack* share;         // frictions: six vectors of rest_share.hpp
  Pack level;          // the largest reaction without friction
  Pack rates;          // the mechanism's largest
  Pack softness;       // of magnitudes of loads, zero but on the way to a start (friction_solver.hpp)
  Pack self_locking;
};

// `take` hands out bytes, see lay_out.
template <class Take>
inline void lay_out_friction(const Plan& p, Take&& take, Rubbing* r) {
  if (!p.frictions) return;
  const long n = p.frictions, pack = sizeof(Pack);
  r->applied = (Wrench*)take(p.links * sizeof(Wrench));
  r->drag = (Wrench*)take(n * sizeof(Wrench));
  r->effort_along = (Wrench*)take(p.drives * sizeof(Wrench));
  Pack** const vectors[] = {&r->speed, &r->coefficient, &r->force, &r->normal, &r->state,
                            &r->at_rest, &r->step, &r->weight, &r->per_weight, &r->origin, &r->newton};
  for (Pack** each : vectors) *each = (Pack*)take(n * pack);
  r->matrix = (Pack*)take(n * n * pack);
  r->bound = (Pack*)take(n * n * pack);
  r->border = (Pack*)take((n + 1) * (n + 1) * pack);
  r->right = (Pack*)take((n + 1) * pack);
  r->share = (Pack*)take(6 * n * pack);
  r->swap = (Mask*)take((n * (n + 1) / 2 + 1) * sizeof(Mask));
  r->axis = (Vec3*)take(n * sizeof(Vec3));
  r->point = (Vec3*)take(n * sizeof(Vec3));
  Vec3** const of_contacts[] = {&r->direction, &r->base, &r->load, &r->reach};
  for (Vec3** each : of_contacts) *each = (Vec3*)take(p.contacts * sizeof(Vec3));
  r->size = (Pack*)take(p.contacts * pack);
  r->gain = (Vec3*)take(p.contacts * n * sizeof(Vec3));
  r->told = (Pack*)take(n * TOLD_NUMBERS * pack);
  r->is_told = false;
  r->effort = (Pack*)take((p.inputs + p.actuators + 1) * pack);
}

}  // namespace
