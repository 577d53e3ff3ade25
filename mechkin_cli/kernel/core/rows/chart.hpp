// A chart: coordinates u of a mechanism's free motion about a place, the origin.
//
//     u_i = sum over the block's columns c of direction_ic d_c
//
// with d the way from the origin: q - q0 of a scalar state; of an orientation 2 vec(q q0*), twice the vector part of the
// turn from there, whose derivative at the origin is the angular velocity. Where the directions span the tangent space
// at the origin, the chart's equations and the closing equations together determine the place, also in a dead centre of
// any one coordinate. They stand as the last rows of their block, so that one factorisation serves position, rates,
// accelerations and reactions; their multipliers are the forces along u that nothing exerts.
#pragma once

#include "joints/tree_joints.hpp"

namespace {

// What a chart needs of the workspace; arrays of packs.
struct Chart {
  const Pack* direction;  // charts x columns: weights included, zero for columns of other blocks
  const Pack* origin;     // states
  const Pack *place, *rate, *acceleration;  // charts: u and its derivatives
};

// The turn q q0* of an orientation from its origin.
MECHKIN_INLINE Quaternion turn_from(const Pack* q, const Pack* origin) {
  return product({q[0], q[1], q[2], q[3]}, {origin[0], -origin[1], -origin[2], -origin[3]});
}

// Calls scalar(column, state) and turn(first column, first state) for what a block's joints have.
template <class Scalar, class Turn>
MECHKIN_INLINE void each_state(const Plan& p, const Block& b, Scalar&& scalar, Turn&& turn) {
  for (int o = b.joint_begin; o < b.joint_end; ++o) {
    const TreeJoint& t = p.joints[p.order[o]];
    with_tree_joint(t.type, [&](auto entry) __attribute__((always_inline)) {
      if (entry.states != entry.freedoms) return turn(t.column, t.state);
      for (int f = 0; f < entry.freedoms; ++f) scalar(t.column + f, t.state + f);
    });
  }
}

// u(q) - u into r (charts).
inline void chart_equations(const Plan& p, const Block& b, const Chart& chart, const Pack* q, Pack* r) {
  for (int i = 0; i < b.charts; ++i) {
    const Pack* const along = chart.direction + i * p.columns;
    Pack sum = -chart.place[i];
    each_state(
        p, b, [&](int c, int s) { sum += along[c] * (q[s] - chart.origin[s]); },
        [&](int c, int s) {
          const Quaternion turn = turn_from(q + s, chart.origin + s);
          sum += Pack(2.0) * dot(Vec3{along[c], along[c + 1], along[c + 2]}, Vec3{turn.x, turn.y, turn.z});
        });
    r[i] = sum;
  }
}

// du/dt = sum of direction_c q'_c; of an orientation d' = vec(omega r) with the turn r from the origin, so that the row's
// entries are r_0 t + vec(r) x t.
template <class Put>
inline void chart_rows(const Plan& p, const Block& b, const Chart& chart, const Pack* q, Put&& put) {
  for (int i = 0; i < b.charts; ++i) {
    const Pack* const along = chart.direction + i * p.columns;
    each_state(
        p, b, [&](int c, int) { put(i, c, along[c]); },
        [&](int c, int s) {
          const Quaternion turn = turn_from(q + s, chart.origin + s);
          const Vec3 t = {along[c], along[c + 1], along[c + 2]};
          const Vec3 row = turn.w * t + cross(Vec3{turn.x, turn.y, turn.z}, t);
          put(i, c, row.x), put(i, c + 1, row.y), put(i, c + 2, row.z);
        });
  }
}

// u'' - (the part of the second derivative that stays without accelerations): of an orientation
// d'' = vec(omega' r) - |omega|^2 vec(r) / 2.
inline void chart_second(const Plan& p, const Block& b, const Chart& chart, const Pack* q, const Pack* rate, Pack* r) {
  for (int i = 0; i < b.charts; ++i) {
    const Pack* const along = chart.direction + i * p.columns;
    Pack sum = chart.acceleration[i];
    each_state(
        p, b, [](int, int) {},
        [&](int c, int s) {
          const Quaternion turn = turn_from(q + s, chart.origin + s);
          const Vec3 omega = {rate[c], rate[c + 1], rate[c + 2]};
          sum += (Pack(0.5) * dot(omega, omega)) *
                 dot(Vec3{along[c], along[c + 1], along[c + 2]}, Vec3{turn.x, turn.y, turn.z});
        });
    r[i] = sum;
  }
}

}  // namespace
