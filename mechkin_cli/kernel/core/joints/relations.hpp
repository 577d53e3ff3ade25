// A relation between coordinates: the sum of some of them, or of functions of them, each with its factor, is given.
//
// It is an equation of joints, not of frames, so its entry has nothing to read from a closure. What it is, and what the
// freedoms of its loop's tree joints move it by, comes from its terms (`TermOf`); it transmits along its coordinates
// (forces/wrenches.hpp). A place is the same place a turn on only where no relation counts turns: coordinates in one are
// threads or slides in the tree.
#pragma once

#include "joints/composition.hpp"
#include "joints/functions.hpp"

namespace {

template <int LENGTHS>
struct Relation : Coordinates<> {
  static constexpr bool is_relation = true;
  static constexpr char letter[] = "";
  static constexpr int equations = 1, lengths = LENGTHS;
  static constexpr unsigned axes = NO_AXES;
  template <class Meet>
  static MECHKIN_INLINE void sides(const Closure&, Meet&&) {}
};

// A term by its coordinate where it is a function of it: value, and the first three derivatives.
struct TermCurve {
  Pack value, slope, bend, third;
};

// What a term's coordinate moves by per unit of its tree joint's freedom.
MECHKIN_INLINE Pack coordinate_by_freedom(const Plan& p, const LoopEntry& e) {
  const TreeJoint& j = p.joints[e.joint];
  return j.type == TREE_H && p.axis[p.term[e.term].axis].slide ? Pack(j.pitch) : Pack(1.0);
}
// What a term moves by per unit of its coordinate; `curve` of terms.
MECHKIN_INLINE Pack term_slope(const Plan& p, const TermCurve* curve, int term) {
  return p.term[term].function < 0 ? Pack(p.term[term].factor) : curve[term].slope;
}
// Per unit of its tree joint's freedom; zero of an entry that only leads through its joint.
MECHKIN_INLINE Pack slope_by_freedom(const Plan& p, const TermCurve* curve, const LoopEntry& e, int freedom) {
  if (p.term[e.term].freedom != freedom) return 0.0;
  const TreeJoint& j = p.joints[e.joint];
  const Pack slope = term_slope(p, curve, e.term);
  return j.type == TREE_H && p.axis[p.term[e.term].axis].slide ? slope * Pack(j.pitch) : slope;
}
// The sum of a relation's terms over `of(tree joint, freedom)`, each by its slope.
template <class Of>
MECHKIN_INLINE Pack sum_by_slopes(const Plan& p, const TermCurve* curve, const ClosingJoint& j, Of&& of) {
  Pack sum = 0.0;
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const int freedom = p.term[p.loop[l].term].freedom;
    if (freedom >= 0)
      sum += slope_by_freedom(p, curve, p.loop[l], freedom) * of(p.joints[p.loop[l].joint], freedom);
  }
  return sum;
}

// The curves of those terms of a relation that are functions, up to an order, at states q.
inline void find_curves(const Plan& p, const ClosingJoint& j, const Pack* q, int order, Pack* registers, TermCurve* curve) {
  if (!p.functions.functions) return;
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const LoopEntry& e = p.loop[l];
    const Term& t = p.term[e.term];
    if (t.function < 0 || t.freedom < 0) continue;
    const Function& f = p.functions.function[t.function];
    const Pack argument = t.argument, factor = t.factor;
    registers[0] = argument * (coordinate_by_freedom(p, e) * q[p.joints[e.joint].state + t.freedom]);
    run_function(p, f, order, registers);
    TermCurve& c = curve[e.term];
    c.value = factor * function_output(p, f, 0, registers);
    Pack scale = factor * argument;
    c.slope = scale * function_output(p, f, 1, registers);
    if (order < 2) continue;
    scale = scale * argument;
    c.bend = scale * function_output(p, f, 2, registers);
    if (order > 2) c.third = (scale * argument) * function_output(p, f, 3, registers);
  }
  // the other parts of a joint, which come first, carry what its coordinate does
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const Term& through = p.term[p.loop[l].term];
    if (through.function < 0 || through.freedom >= 0) continue;
    for (int own = l + 1; own < j.loop_end; ++own)
      if (p.term[p.loop[own].term].axis == through.axis) curve[p.loop[l].term] = curve[p.loop[own].term];
  }
}
// Calls with the curve, the entry and the freedom of each of a relation's terms that is a function.
template <class Met>
MECHKIN_INLINE void each_curve(const Plan& p, const TermCurve* curve, const ClosingJoint& j, Met&& met) {
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const LoopEntry& e = p.loop[l];
    if (p.term[e.term].function >= 0 && p.term[e.term].freedom >= 0) met(curve[e.term], e, p.term[e.term].freedom);
  }
}

// The closing equations of a joint whose closure is placed, its curves found.
template <class Entry>
MECHKIN_INLINE void closing_residual(const Plan& p, const Pack* q, const TermCurve* curve, const ClosingJoint& j, const Closure& k,
                                     Entry entry, Pack* r) {
  if constexpr (Entry::is_relation) {
    Pack sum = 0.0;
    for (int l = j.loop_begin; l < j.loop_end; ++l) {
      const LoopEntry& e = p.loop[l];
      const int freedom = p.term[e.term].freedom;
      if (freedom < 0) continue;
      if (p.term[e.term].function >= 0)
        sum += curve[e.term].value;
      else
        sum += slope_by_freedom(p, curve, e, freedom) * q[p.joints[e.joint].state + freedom];
    }
    r[0] = sum - Pack(j.parameter);
  } else {
    entry.residual(k, r);
  }
}
// What a freedom of a loop's tree joint, whose screw is given, moves the closing equations by.
template <class Entry>
MECHKIN_INLINE void closing_column(const Plan& p, const TermCurve* curve, const Closure& k, const LoopEntry& e, int freedom,
                                   const Twist& screw, Entry entry, Pack* out) {
  if constexpr (Entry::is_relation)
    out[0] = slope_by_freedom(p, curve, e, freedom);
  else
    entry.column(k, Pack(e.sign) * screw, out);
}

}  // namespace
