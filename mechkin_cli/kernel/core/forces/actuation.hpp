// Efforts at actuators instead of at the inputs (docs/numerics.md, Actuators).
//
// The motion is prescribed at inputs x and balanced there by generalised efforts Q. Actuators at coordinates y, of
// rates dy = J dx, do the same virtual work with efforts t where
//
//     J^T t = Q
//
// Inputs that one motor moves through a constraint, dx_k = c dx_i, add c Q_k to Q_i and c J_k to J_i. Both sides are taken for
// motions that are orthonormal over all coordinates of the tree, lengths in parts of the size, so that neither rank nor
// solution knows which coordinates are the inputs. More actuators than freedoms have the efforts of least norm, forces
// by the size beside moments.
#pragma once

#include "forces/drives.hpp"
#include "forces/energy.hpp"

namespace {

// Rates of the actuators in parts of the motion below which some motion leaves them all at rest: rounding leaves 1e-16
// by the condition of the loops.
constexpr double ACTUATORS_AT_REST = 1e-10;

MECHKIN_INLINE Pack actuator_weight(const Plan& p, int a) {
  return p.axis[p.actuator[a].axis].slide ? Pack(p.row_weight) : Pack(1.0);
}

// Influence coefficients (columns + actuators + 1, free inputs): rates of the tree's coordinates, then of the actuators,
// for a unit rate of each free input, lengths in parts of the size. Leaves rates and velocities of the last input behind.
template <class RateByLeader>
inline void find_influence(const Plan& p, Workspace& w, const RateByLeader& rate_by_leader) {
  const int n = free_inputs(p);
  int f = 0;
  for (int input = 0; input < p.driven; ++input) {
    if (is_led(p, input)) continue;
    for (int i = 0; i < p.inputs; ++i) w.rate[p.input_column[i]] = i == input ? 1.0 : 0.0;
    for (int t = 0; t < p.input_constraints; ++t)
      if (p.input_constraint[t].leader == input) w.rate[p.input_column[p.input_constraint[t].input]] = rate_by_leader(t);
    for (int b = 0; b < p.blocks; ++b) block_velocities(p, w, b);
    move_rest(p, w);
    Pack* const out = w.actuation.influence + f++;
    for (int c = 0; c < p.columns; ++c) out[c * n] = w.rate[c] / Pack(p.column_weight[c]);
    for (int a = 0; a < p.actuators; ++a)
      out[(p.columns + a) * n] = actuator_weight(p, a) * actuator_rate(p, w, a);
  }
}

// Turns the columns of the first `motion` rows of a (rows x n) orthonormal, all rows with them (Gram and Schmidt, twice).
inline void orthonormalise(Pack* a, int motion, int rows, int n) {
  for (int k = 0; k < n; ++k) {
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < k; ++j) {
        Pack along = 0.0;
        for (int i = 0; i < motion; ++i) along += a[i * n + j] * a[i * n + k];
        for (int i = 0; i < rows; ++i) a[i * n + k] -= along * a[i * n + j];
      }
    const Pack inverse = Pack(1.0) / sqrt(column_square(a, motion, n, k));
    for (int i = 0; i < rows; ++i) a[i * n + k] *= inverse;
  }
}

// The efforts of the free inputs, of the motors that find_motors leaves, as wanted of the actuators in case `number`.
inline void want_efforts(const Plan& p, const Actuation& at, int number) {
  Pack* const wanted = at.influence + (p.columns + p.actuators + number) * free_inputs(p);
  int f = 0;
  for (int i = 0; i < p.driven; ++i)
    if (!is_led(p, i)) wanted[f++] = at.motor[i];
}

// The actuators' efforts for what is wanted in each of `cases`, into `out`, efforts(plan) apart; not a number where the set
// is singular. Returns the least rate of the actuators, all together, in a motion of length one.
inline Pack solve_actuators(const Plan& p, const Actuation& at, int cases, Pack* out) {
  const int n = free_inputs(p), m = p.actuators, rows = p.columns + m + cases;
  Pack* const jacobian = at.influence + p.columns * n;
  const Pack* const wanted = jacobian + m * n;
  orthonormalise(at.influence, p.columns, rows, n);
  // the rows of the motion have done their duty
  Pack *const copy = at.influence_factors, *const pivot = copy + m * n, *const beta = pivot + n;
  for (int e = 0; e < m * n; ++e) copy[e] = jacobian[e];
  const Pack least = smallest_singular_value(copy, m, n, pivot);
  const Reflectors qr = {jacobian, pivot, beta, m, n};
  reflect(qr);
  const Mask known = least > Pack(ACTUATORS_AT_REST);
  for (int c = 0; c < cases; ++c) {
    Pack* const effort = out + c * efforts(p);
    for (int k = 0; k < n; ++k) effort[k] = wanted[c * n + k];
    solve_transposed(qr, effort, 0);
    for (int a = 0; a < m; ++a)
      effort[a] = select(known, effort[a] * actuator_weight(p, a), Pack(__builtin_nan("")));
  }
  return least;
}

// What the actuators put in, for the balance of powers.
inline void add_actuator_power(Powers& powers, const Plan& p, const Workspace& w) {
  for (int a = 0; a < p.actuators; ++a) powers.add(w.actuation.motor[a] * actuator_rate(p, w, a));
}

}  // namespace
