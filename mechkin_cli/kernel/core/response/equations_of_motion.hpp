// The equations of motion in the coordinates u of a chart (chart.hpp):
//
//     M u'' = -r,   M_ij = sum over links of V_i . I V_j,   r_i = sum over links of V_i . (I A_0 + bias - loads)
//
// with V_i the twists of the links by u_i' = 1 and A_0 their accelerations at u'' = 0 (Kane, Dynamics, 1985: generalised
// speeds; here with the screws of the closed mechanism). Reactions do no work on V_i and are not computed.
#pragma once

#include "forces/energy.hpp"
#include "response/composite_bodies.hpp"
#include "rows/regular_band.hpp"

namespace {

// Beside the kernel's workspace: directions are those of the chart, then those of the driven inputs.
struct ReducedMotion {
  Pack* tangent;   // directions x columns: rates of the columns
  Twist* twist;    // directions x links, but where composite bodies take their place
  Pack* inertia;   // directions x charts: V_d . I V_j
  Pack* force;     // directions: r_d
  Pack* factor;    // charts x charts: Cholesky's, L^T in its upper half
  Pack* radius;    // two matrices of the largest full block
  Composites composites;
  SegmentRoom segment;  // of a block with a band
};

inline int directions(const Plan& p) { return p.charts + p.inputs; }

inline long lay_out_motion(const Plan& p, char* at, ReducedMotion* m) {
  Room room = {at};
  const int d = directions(p);
  m->tangent = room.take<Pack>(d * p.columns);
  m->twist = room.take<Twist>(has_composites(p) ? 0 : d * p.links);
  m->inertia = room.take<Pack>(d * p.charts);
  m->force = room.take<Pack>(d);
  m->factor = room.take<Pack>(p.charts * p.charts);
  int largest = 0;
  for (int b = 0; b < p.blocks; ++b) {
    const Block& at = p.block[b];
    if (!at.band_entries && at.rows > largest) largest = at.rows;
    if (!at.band_entries) continue;  // of one block, that with the chart
    const long used = lay_out_segment(p.band + at.column_begin, at.size, at.band_entries, nullptr, &m->segment);
    lay_out_segment(p.band + at.column_begin, at.size, at.band_entries, room.take<char>((int)used), &m->segment);
  }
  m->radius = room.take<Pack>(2 * largest * largest);
  m->composites = lay_out_composites(p, d, room);
  return room.used;
}

// All directions at rest but one, which has the rate 1.
inline void stand_but(const Plan& p, Workspace& w, int direction) {
  for (int i = 0; i < p.charts; ++i) w.place_rate[i] = 0.0;
  for (int i = 0; i < p.inputs; ++i) w.rate[p.input_column[i]] = 0.0;
  (direction < p.charts ? w.place_rate[direction] : w.rate[p.input_column[direction - p.charts]]) = 1.0;
}

// Of many freedoms the rates of the chart's block by all directions, which are solved for together.
inline const Pack* solved_together(const Plan& p, Workspace& w, const ReducedMotion& m) {
  const BlockMatrices at = matrices_of(p, w, 0);
  const int d = directions(p);
  if (p.charts <= FEW_FREEDOMS || at.row || at.m != at.n || p.block[0].charts != p.charts || d > 2 * at.n) return nullptr;
  for (int i = 0; i < d; ++i) {
    stand_but(p, w, i);
    known_rates(p, w, 0, w.right);
    for (int r = 0; r < at.n; ++r) m.radius[r * d + i] = w.right[r];
  }
  solve_columns(at.lu(), m.radius, d);
  return m.radius;
}

// Rates of all columns by each direction alone, and twists of all links.
inline void move_along(const Plan& p, Workspace& w, const ReducedMotion& m) {
  const Pack* const together = solved_together(p, w, m);
  const int d = directions(p);
  for (int i = 0; i < d; ++i) {
    stand_but(p, w, i);
    for (int b = 0; b < p.blocks; ++b) {
      if (b || !together) {
        block_velocities(p, w, b);
        continue;
      }
      const Block& block = p.block[b];
      for (int u = 0; u < block.size; ++u) w.rate[p.unknown[block.column_begin + u]] = together[u * d + i];
      if (!has_composites(p)) move_block(p, w, block);
    }
    for (int c = 0; c < p.columns; ++c) m.tangent[i * p.columns + c] = w.rate[c];
    if (has_composites(p)) continue;
    move_rest(p, w);
    for (int k = 0; k < p.links; ++k) m.twist[i * p.links + k] = w.motion[k].velocity;
  }
}

// Rates, twists and the accelerations at u'' = 0.
inline void move(const Plan& p, Workspace& w, const ReducedMotion& m, const Pack* rate, const Pack* input_rate,
                 const Pack* input_second) {
  for (int c = 0; c < p.columns; ++c) {
    Pack sum = 0.0;
    for (int i = 0; i < p.charts; ++i) sum += rate[i] * m.tangent[i * p.columns + c];
    for (int i = 0; i < p.inputs; ++i) sum += input_rate[i] * m.tangent[(p.charts + i) * p.columns + c];
    w.rate[c] = sum;
  }
  for (int b = 0; b < p.blocks; ++b) move_block(p, w, p.block[b]);
  move_rest(p, w);
  for (int i = 0; i < p.charts; ++i) w.place_acceleration[i] = 0.0;
  for (int i = 0; i < p.inputs; ++i) w.acceleration[p.input_column[i]] = input_second[i];
  for (int b = 0; b < p.blocks; ++b) block_accelerations(p, w, b);
  accelerate_rest(p, w);
}

inline void reduce_inertia(const Plan& p, const Workspace& w, ReducedMotion& m) {
  const int d = directions(p);
  if (has_composites(p)) {
    find_bodies(p, w, m.composites);
    take_directions(p, m.composites, m.tangent, d);
    return reduce_bodies(p, w, m.composites, d, m.inertia);
  }
  for (int e = 0; e < d * p.charts; ++e) m.inertia[e] = 0.0;
  for (int k = 0; k < p.links; ++k) {
    if (!p.inertia[k].present) continue;
    for (int j = 0; j < p.charts; ++j) {
      const Wrench by = momentum(p.inertia[k], w.pose[k], m.twist[j * p.links + k]);
      for (int i = 0; i < d; ++i)
        if (i >= p.charts || i >= j) m.inertia[i * p.charts + j] += power(m.twist[i * p.links + k], by);
    }
  }
  for (int i = 0; i < p.charts; ++i)
    for (int j = i + 1; j < p.charts; ++j) m.inertia[i * p.charts + j] = m.inertia[j * p.charts + i];
}

// What the directions need of forces at u'' = 0.
template <class RowValue>
inline void reduce_forces(const Plan& p, Workspace& w, ReducedMotion& m, const RowValue& row_value) {
  Balance balance = {p, w, zero_wrench(), zero_wrench(), true, Pack(0.0)};
  apply_inertia(balance, true);
  for (int l = 0; l < p.loads; ++l) apply_load(balance, p.load[l], row_value);
  if (has_composites(p)) return reduce_carried(p, w, m.composites, directions(p), m.force);
  for (int i = 0; i < directions(p); ++i) {
    m.force[i] = 0.0;
    for (int k = 0; k < p.links; ++k) m.force[i] += power(m.twist[i * p.links + k], w.carried[k]);
  }
}

// A reduced inertia below this part of its largest entry is rounding.
constexpr double NO_INERTIA = 1e-14;

// x := M^-1 x with the factors that solve_motion leaves.
inline void solve_factored(const Plan& p, const ReducedMotion& m, Pack* x) {
  const int n = p.charts;
  const Pack* const l = m.factor;
  for (int k = 0; k < n; ++k) {
    x[k] = x[k] / l[k * n + k];
    for (int i = k + 1; i < n; ++i) x[i] -= l[k * n + i] * x[k];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] = x[i] / l[i * n + i];
  }
}

// M = L L^T and u'' = -M^-1 r; lanes where M is positive.
inline Mask solve_motion(const Plan& p, const ReducedMotion& m, Pack* second) {
  const int n = p.charts;
  Pack largest = 0.0;
  for (int i = 0; i < n; ++i) largest = max(largest, abs(m.inertia[i * n + i]));
  Mask positive = all_lanes(true);
  Pack* const l = m.factor;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j) l[i * n + j] = m.inertia[j * n + i];
  for (int k = 0; k < n; ++k) {
    const Pack pivot = l[k * n + k];
    const Mask good = pivot > Pack(NO_INERTIA) * largest;
    positive = positive & good;
    const Pack root = sqrt(select(good, pivot, Pack(1.0)));
    l[k * n + k] = root;
    for (int i = k + 1; i < n; ++i) l[k * n + i] = l[k * n + i] / root;
    for (int i = k + 1; i < n; ++i) {
      const Pack factor = l[k * n + i];
      for (int j = i; j < n; ++j) l[i * n + j] -= factor * l[k * n + j];
    }
  }
  for (int i = 0; i < n; ++i) second[i] = -m.force[i];
  solve_factored(p, m, second);
  return positive;
}

// Power of what has no potential, and what dampers take.
template <class RowValue>
inline void powers_of_loads(const Plan& p, const Workspace& w, const ReducedMotion& m, const Pack* second,
                            const Pack* input_rate, const RowValue& row_value, Pack* work, Pack* lost) {
  Powers put = {Pack(0.0), Pack(0.0)}, taken = {Pack(0.0), Pack(0.0)};
  for (int l = 0; l < p.loads; ++l) {
    const int type = p.load[l].type;
    if (type == LOAD_SPRING || type == LOAD_COORDINATE_SPRING || type == LOAD_BUSHING) continue;
    const bool damper = type == LOAD_DAMPER || type == LOAD_COORDINATE_DAMPER || type == LOAD_BUSHING_DAMPER;
    add_load_power(damper ? taken : put, p, w, p.load[l], row_value);
  }
  for (int i = 0; i < p.inputs; ++i) {
    Pack effort = m.force[p.charts + i];
    for (int j = 0; j < p.charts; ++j) effort += m.inertia[(p.charts + i) * p.charts + j] * second[j];
    put.add(effort * input_rate[i]);
  }
  *work = put.sum, *lost = -taken.sum;
}

}  // namespace
