// A relation between coordinates: the sum of some of them, each with its factor, is given.
//
// It is an equation of joints, not of frames, so its entry has nothing to read from a closure. What it is, and what the
// freedoms of its loop's tree joints move it by, comes from its terms (`TermOf`); it transmits along its coordinates
// (forces/wrenches.hpp). A place is the same place a turn on only where no relation counts turns: coordinates in one are
// threads or slides in the tree.
#pragma once

#include "joints/composition.hpp"

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

// What a relation's coordinate is or moves by per unit of its tree joint's freedom, times its factor; zero of an entry that
// only leads through its joint.
MECHKIN_INLINE Pack term_factor(const Plan& p, const LoopEntry& e, int freedom) {
  const Term& t = p.term[e.term];
  if (t.freedom != freedom) return 0.0;
  const TreeJoint& j = p.joints[e.joint];
  return j.type == TREE_H && p.axis[t.axis].slide ? Pack(t.factor) * Pack(j.pitch) : Pack(t.factor);
}
// The sum of a relation's terms over `of(tree joint, freedom)`.
template <class Of>
MECHKIN_INLINE Pack sum_of_terms(const Plan& p, const ClosingJoint& j, Of&& of) {
  Pack sum = 0.0;
  for (int l = j.loop_begin; l < j.loop_end; ++l) {
    const int freedom = p.term[p.loop[l].term].freedom;
    if (freedom >= 0) sum += term_factor(p, p.loop[l], freedom) * of(p.joints[p.loop[l].joint], freedom);
  }
  return sum;
}
// The closing equations of a joint whose closure is placed.
template <class Entry>
MECHKIN_INLINE void closing_residual(const Plan& p, const Pack* q, const ClosingJoint& j, const Closure& k, Entry entry, Pack* r) {
  if constexpr (Entry::is_relation)
    r[0] = sum_of_terms(p, j, [&](const TreeJoint& t, int f) { return q[t.state + f]; }) - Pack(j.parameter);
  else
    entry.residual(k, r);
}
// What a freedom of a loop's tree joint, whose screw is given, moves the closing equations by.
template <class Entry>
MECHKIN_INLINE void closing_column(const Plan& p, const Closure& k, const LoopEntry& e, int freedom, const Twist& screw,
                                   Entry entry, Pack* out) {
  if constexpr (Entry::is_relation)
    out[0] = term_factor(p, e, freedom);
  else
    entry.column(k, Pack(e.sign) * screw, out);
}

}  // namespace
