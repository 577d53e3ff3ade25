// The equations of motion in the coordinates u of a chart (chart.hpp):
//
//     M u'' = -r,   M_ij = sum over links of V_i . I V_j,   r_i = sum over links of V_i . (I A_0 + bias - loads)
//
// with V_i the twists of the links by u_i' = 1 and A_0 their accelerations at u'' = 0 (Kane, Dynamics, 1985: generalised
// speeds; here with the screws of the closed mechanism). Reactions do no work on V_i and are not computed.
#pragma once

#include "forces/energy.hpp"
#include "rows/regular_band.hpp"

namespace {

// Beside the kernel's workspace: directions are those of the chart, then those of the driven inputs.
struct ReducedMotion {
  Pack* tangent;   // directions x columns: rates of the columns
  Twist* twist;    // directions x links
  Pack* inertia;   // directions x charts: V_d . I V_j
  Pack* force;     // directions: r_d
  Pack* factor;    // charts x charts: Cholesky's
  Pack* radius;    // two matrices of the largest full block
  SegmentRoom segment;  // of a block with a band
};

inline int directions(const Plan& p) { return p.charts + p.inputs; }

inline long lay_out_motion(const Plan& p, char* at, ReducedMotion* m) {
  Room room = {at};
  const int d = directions(p);
  m->tangent = room.take<Pack>(d * p.columns);
  m->twist = room.take<Twist>(d * p.links);
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
  return room.used;
}

// Rates of all columns and twists of all links, by one direction alone.
inline void move_along(const Plan& p, Workspace& w, ReducedMotion& m, int direction) {
  for (int i = 0; i < p.charts; ++i) w.place_rate[i] = 0.0;
  for (int i = 0; i < p.inputs; ++i) w.rate[p.input_column[i]] = 0.0;
  (direction < p.charts ? w.place_rate[direction] : w.rate[p.input_column[direction - p.charts]]) = 1.0;
  for (int b = 0; b < p.blocks; ++b) block_velocities(p, w, b);
  move_rest(p, w);
  for (int c = 0; c < p.columns; ++c) m.tangent[direction * p.columns + c] = w.rate[c];
  for (int k = 0; k < p.links; ++k) m.twist[direction * p.links + k] = w.motion[k].velocity;
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

// Momentum of a link that moves with a twist: m v and I omega about the kernel's origin.
inline Wrench momentum(const LinkInertia& m, const Pose& pose, const Twist& twist) {
  const Vec3 centre = pose.point(m.centre), omega = pose.components(twist.angular);
  const auto* t = m.tensor;
  const Vec3 spin = {Pack(t[0]) * omega.x + Pack(t[3]) * omega.y + Pack(t[4]) * omega.z,
                     Pack(t[3]) * omega.x + Pack(t[1]) * omega.y + Pack(t[5]) * omega.z,
                     Pack(t[4]) * omega.x + Pack(t[5]) * omega.y + Pack(t[2]) * omega.z};
  Wrench r = force_at(centre, Pack(m.mass) * twist.at(centre));
  r.moment += pose.vector(spin);
  return r;
}

inline void reduce_inertia(const Plan& p, const Workspace& w, ReducedMotion& m) {
  const int d = directions(p);
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
  for (int i = 0; i < directions(p); ++i) {
    m.force[i] = 0.0;
    for (int k = 0; k < p.links; ++k) m.force[i] += power(m.twist[i * p.links + k], w.carried[k]);
  }
}

// A reduced inertia below this part of its largest entry is rounding.
constexpr double NO_INERTIA = 1e-14;

// M = L L^T and u'' = -M^-1 r; lanes where M is positive.
inline Mask solve_motion(const Plan& p, const ReducedMotion& m, Pack* second) {
  const int n = p.charts;
  Pack largest = 0.0;
  for (int i = 0; i < n; ++i) largest = max(largest, abs(m.inertia[i * n + i]));
  Mask positive = all_lanes(true);
  Pack* const l = m.factor;
  for (int j = 0; j < n; ++j) {
    Pack pivot = m.inertia[j * n + j];
    for (int k = 0; k < j; ++k) pivot -= l[j * n + k] * l[j * n + k];
    const Mask good = pivot > Pack(NO_INERTIA) * largest;
    positive = positive & good;
    l[j * n + j] = sqrt(select(good, pivot, Pack(1.0)));
    for (int i = j + 1; i < n; ++i) {
      Pack x = m.inertia[i * n + j];
      for (int k = 0; k < j; ++k) x -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = x / l[j * n + j];
    }
  }
  for (int i = 0; i < n; ++i) {
    second[i] = -m.force[i];
    for (int k = 0; k < i; ++k) second[i] -= l[i * n + k] * second[k];
    second[i] = second[i] / l[i * n + i];
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int k = i + 1; k < n; ++k) second[i] -= l[k * n + i] * second[k];
    second[i] = second[i] / l[i * n + i];
  }
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
