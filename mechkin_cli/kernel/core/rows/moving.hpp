// Twists of the links and their derivatives from the rates of the tree's columns, and what the loops' closing equations
// want of them (docs/numerics.md, Rates).
#pragma once

#include "rows/placing.hpp"

namespace {

// Of a link, or of ground (-1).
MECHKIN_INLINE const Motion& motion_of(const Workspace& w, int link) { return w.motion[link]; }

inline void move_hung(const Plan& p, Workspace& w, int k, bool second) {
  const HungBody& hung = p.hung[p.joints[k].hung];
  const Vec3 A = w.pose[k].o, B = carried_point(w, hung.second, hung.point);
  w.motion[k] = hung_motion(A, B, motion_of(w, p.joints[k].parent), motion_of(w, hung.second), second);
}
// Sum of the screws of tree joint k, each times its entry of `rate`.
MECHKIN_INLINE Twist joint_twist(const Plan& p, const Workspace& w, int k, const Pack* rate) {
  const TreeJoint& j = p.joints[k];
  Twist sum = zero_twist();
  with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    for (int i = 0; i < entry.freedoms; ++i) sum += rate[j.column + i] * w.screw[j.column + i];
  });
  return sum;
}

// Twist of the link of tree joint k from its parent's: V = V_p + S q'.
inline void move_link(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  if (j.type == TREE_L) return move_hung(p, w, k, false);
  w.motion[k].velocity = motion_of(w, j.parent).velocity + joint_twist(p, w, k, w.rate);
}
// Sums over pairs and triples of parameters, of which one derivative stands for all orders: of c_ij a_i b_j and c_ijk a_i a_j a_k.
inline Vec3 bent(const Course& c, int parameters, const Pack* a, const Pack* b) {
  if (parameters == 1) return (a[0] * b[0]) * c.bend[0];
  return (a[0] * b[0]) * c.bend[0] + (a[0] * b[1] + a[1] * b[0]) * c.bend[1] + (a[1] * b[1]) * c.bend[2];
}
inline Vec3 bent_again(const Course& c, int parameters, const Pack* a) {
  if (parameters == 1) return (a[0] * a[0] * a[0]) * c.third[0];
  const Pack three = 3.0;
  return (a[0] * a[0] * a[0]) * c.third[0] + (three * (a[0] * a[0] * a[1])) * c.third[1] +
         (three * (a[0] * a[1] * a[1])) * c.third[2] + (a[1] * a[1] * a[1]) * c.third[3];
}
// What a joint's screws, seen from its parent, change by along a curve or a surface: the second derivative of the place by
// motion alone.
inline Vec3 second_of_course(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  find_course(p, j, w.q, 2, w.function, w.course + k);
  const Pack* const rate = w.rate + j.column;
  return w.pose[k].vector(bent(w.course[k], p.functions.function[j.function].arguments, rate, rate));
}

// Its spatial acceleration, where the twists are known: V' = V_p' + S q'' + [V_p, S q'], and of a course its bend. With
// `again` only q'' and V_p' are others than they were.
inline void accelerate_link(const Plan& p, Workspace& w, int k, bool again) {
  const TreeJoint& j = p.joints[k];
  if (j.type == TREE_L) return move_hung(p, w, k, true);
  const Motion& parent = motion_of(w, j.parent);
  if (!again) {
    w.convective[k] = bracket(parent.velocity, joint_twist(p, w, k, w.rate));
    if (j.function >= 0) w.convective[k].linear += second_of_course(p, w, k);
  }
  w.motion[k].acceleration = parent.acceleration + joint_twist(p, w, k, w.acceleration) + w.convective[k];
}
inline void move_block(const Plan& p, Workspace& w, const Block& b) {
  for (int o = b.joint_begin; o < b.joint_end; ++o) move_link(p, w, p.order[o]);
}
inline void accelerate_block(const Plan& p, Workspace& w, const Block& b, bool again) {
  for (int o = b.joint_begin; o < b.joint_end; ++o) accelerate_link(p, w, p.order[o], again);
}
// Links beyond all blocks.
inline void move_rest(const Plan& p, Workspace& w) {
  for (int k = 0; k < p.rest_count; ++k) move_link(p, w, p.rest[k]);
}
inline void accelerate_rest(const Plan& p, Workspace& w) {
  for (int k = 0; k < p.rest_count; ++k) accelerate_link(p, w, p.rest[k], false);
}

// Right-hand side -J q' over the loop's columns that are already known.
inline void known_rates(const Plan& p, const Workspace& w, int index, Pack* right) {
  const Block& b = p.block[index];
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    if (is_relation(j.type)) {
      right[j.row] = -sum_by_slopes(p, w.curve, j, [&](const TreeJoint& t, int f) {
        return unknown_index(p, index, t.column + f) < 0 ? w.rate[t.column + f] : Pack(0.0);
      });
      continue;
    }
    const Closure& k = w.closure[c];
    Twist a = zero_twist();
    for (int at = j.known_begin; at < j.columns_end; ++at) {
      const LoopColumn& met = p.loop_column[at];
      a += (Pack(p.loop[met.loop].sign) * w.rate[met.column]) * w.screw[met.column];
    }
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      if constexpr (!entry.is_relation) {
        Pack r[MAX_CLOSING_ROWS];
        entry.column(k, a, r);
        for (int i = 0; i < entry.equations; ++i) right[j.row + i] = -r[i];
      }
    });
  }
  for (int i = 0; i < b.charts; ++i) right[b.rows - b.charts + i] = w.place_rate[i];
}

// Second and third derivative of a relation: those of a term g of a coordinate c, which moves by c', c'' and c''', are
// g_c c'' + g_cc c' c' and g_c c''' + 3 g_cc c' c'' + g_ccc c' c' c'.
inline Pack second_of_relation(const Plan& p, Workspace& w, const ClosingJoint& j) {
  find_curves(p, j, w.q, 2, w.function, w.curve);
  Pack sum = sum_by_slopes(p, w.curve, j, [&](const TreeJoint& t, int f) { return w.acceleration[t.column + f]; });
  each_curve(p, w.curve, j, [&](const TermCurve& g, const LoopEntry& e, int f) {
    const Pack rate = coordinate_by_freedom(p, e) * w.rate[p.joints[e.joint].column + f];
    sum += g.bend * (rate * rate);
  });
  return sum;
}
inline Pack third_of_relation(const Plan& p, Workspace& w, const ClosingJoint& j) {
  find_curves(p, j, w.q, 3, w.function, w.curve);
  Pack sum = sum_by_slopes(p, w.curve, j, [&](const TreeJoint& t, int f) { return w.jerk[t.column + f]; });
  each_curve(p, w.curve, j, [&](const TermCurve& g, const LoopEntry& e, int f) {
    const int column = p.joints[e.joint].column + f;
    const Pack by = coordinate_by_freedom(p, e), rate = by * w.rate[column], acceleration = by * w.acceleration[column];
    sum += Pack(3.0) * g.bend * (rate * acceleration) + g.third * (rate * rate * rate);
  });
  return sum;
}

// Second derivatives of a block's closing equations, negative, into w.right: as the links move.
inline void second_of_equations(const Plan& p, Workspace& w, const Block& b) {
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    const Motion &first = motion_of(w, j.first), &other = motion_of(w, j.second);
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      Pack r[MAX_CLOSING_ROWS];
      if constexpr (entry.is_relation)
        r[0] = second_of_relation(p, w, j);
      else
        entry.second(w.closure[c], first, other, r);
      for (int i = 0; i < entry.equations; ++i) w.right[j.row + i] = -r[i];
    });
    if (j.slide >= 0) w.right[j.row] += Pack(j.slide_sign) * w.acceleration[p.joints[j.slide].column];
  }
  if (b.charts) chart_second(p, b, w.chart(), w.q, w.rate, w.right + b.rows - b.charts);
}

// A link's motion with its jerk.
MECHKIN_INLINE MotionToJerk motion_to_jerk(const Workspace& w, int link) {
  return {w.motion[link], w.link_jerk[link]};
}

// V'' = V_p'' + S q''' + 2 [V_p, S q''] + [V_p', S q'] + [V_p, [V_p, S q']], since S' = [V_p, S]. Of a course S q'' and
// S q''' stand for the second and third derivatives of its place.
inline void jerk_link(const Plan& p, Workspace& w, int k) {
  const TreeJoint& j = p.joints[k];
  const MotionToJerk parent = motion_to_jerk(w, j.parent);
  if (j.type == TREE_L) {
    const HungBody& hung = p.hung[j.hung];
    const Vec3 A = w.pose[k].o, B = carried_point(w, hung.second, hung.point);
    w.link_jerk[k] = hung_jerk(A, B, w.motion[k], parent, motion_to_jerk(w, hung.second));
    return;
  }
  Twist first = zero_twist(), second = zero_twist(), third = zero_twist();
  with_tree_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
    for (int i = 0; i < entry.freedoms; ++i) {
      const Twist s = w.screw[j.column + i];
      first += w.rate[j.column + i] * s;
      second += w.acceleration[j.column + i] * s;
      third += w.jerk[j.column + i] * s;
    }
  });
  if (j.function >= 0) {
    find_course(p, j, w.q, 3, w.function, w.course + k);
    const Course& c = w.course[k];
    const int n = p.functions.function[j.function].arguments;
    const Pack *const rate = w.rate + j.column, *const acceleration = w.acceleration + j.column;
    second.linear += w.pose[k].vector(bent(c, n, rate, rate));
    third.linear += w.pose[k].vector(Pack(3.0) * bent(c, n, rate, acceleration) + bent_again(c, n, rate));
  }
  w.link_jerk[k] = parent.jerk + third + Pack(2.0) * bracket(parent.velocity, second) +
                   bracket(parent.acceleration, first) + bracket(parent.velocity, bracket(parent.velocity, first));
}

// Third derivatives of a block's closing equations, negative, into w.right: as the links move.
inline void third_of_equations(const Plan& p, Workspace& w, const Block& b) {
  for (int c = b.closing_begin; c < b.closing_end; ++c) {
    const ClosingJoint& j = p.closing[c];
    const MotionToJerk first = motion_to_jerk(w, j.first), other = motion_to_jerk(w, j.second);
    with_closing_joint(j.type, [&](auto entry) __attribute__((always_inline)) {
      Pack r[MAX_CLOSING_ROWS];
      if constexpr (entry.is_relation)
        r[0] = third_of_relation(p, w, j);
      else
        entry.third(w.closure[c], first, other, r);
      for (int i = 0; i < entry.equations; ++i) w.right[j.row + i] = -r[i];
    });
    if (j.slide >= 0) w.right[j.row] += Pack(j.slide_sign) * w.jerk[p.joints[j.slide].column];
  }
}

}  // namespace
