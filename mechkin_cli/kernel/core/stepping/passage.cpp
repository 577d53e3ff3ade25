#include "stepping/passage.hpp"

#include <algorithm>
#include <cmath>

#include "stepping/branch_point.hpp"
#include "stepping/tracker.hpp"

namespace {

// A block other than the arc's own stands in the way where its matrix changes this many times faster.
constexpr double FASTER = 3.0;
// A block that the arc's own hangs on passes its trouble on: it stands in the way where its own change is not small
// beside that.
constexpr double BEFORE = 0.5;
// Part of the step that the arc's own block wants, below which it is asked which other one stands in the way.
constexpr double SHORTENED = 1.0 / 64.0, STUCK = 1.0 / 1024.0;
// Speed of the path along the arc below which rows are closed one by one: next to a dead centre.
constexpr double SLOW = 1e-2;
// Correction of such a row: the root of a rounding, by which its place next to a dead centre may be off.
constexpr double CLOSED = 1e-7;
// Rounding of sigma, in parts of max(1, |sigma|), below which a row's place on the arc is not told better.
constexpr double SIGMA_ROUNDING = 2.3e-16;
// Step on the arc (rad, length units) by which such a rounding moves a row's place where sigma's rate, 1e-5 and more, is
// far above its own rounding.
constexpr double TOLD_STEP = 1e-11;
// Arclength below which a branch is not resolved: where two branches pass at a gap of 1e-16 of the size, they bend
// over its root.
constexpr double LEAST_ARC = 1e-10;
constexpr double SINGULAR_STEP = 1e-6;
// Rate of sigma below which the branch is about to turn back, and what may be left of sigma before it does, in parts of
// max(1, |sigma|).
constexpr double STEEP = 0.1, ROUNDING_LEFT = 1e-12;
// Pivots of a matrix that is singular a little farther on, in parts of the least that steps may have.
constexpr double SINGULAR_PIVOTS = 100.0;
// Arclength (rad, length units) on which the path moves by less than this where a walk comes to nothing: a slide that
// grows without bound. A screw of a thousandth of the size's lead moves it by some tenths.
constexpr double FARTHEST = 1000.0, STANDING = 1e-6;
// Half a unit in the last place of an equation, and how many of them its unknowns round by.
constexpr double EQUATION_ROUNDING = 1e-16, UNKNOWN_ROUNDINGS = 10.0;
// Attempts behind a dead centre; through a gap of 1e-12 it takes some sixty.
constexpr int MOST_BEHIND = 300;
// Arclength before a branch point from which its place is told, and steps that are tried to come there.
constexpr double WAY_BEHIND = 0.1;
constexpr int MOST_BACK = 100;
// Rate and second derivative of sigma by arclength that are rounding.
constexpr double AT_REST = 1e-9;
// Equations from which on bounds of a matrix are wide beside those of its blocks.
constexpr double MANY_EQUATIONS = 60.0;
// Least ratio of sigma's second derivative at a dead centre and its mean over the step that it lies in.
constexpr double SAME_BEND = 0.2;

// sigma between two nodes, by its quintic Hermite polynomial, with its derivative by the place.
struct SigmaBetween {
  const Node &a, &b;
  double at(double t, double* slope) const {
    const double h = b.place - a.place, t2 = t * t, t3 = t2 * t;
    const double value1 = t3 * (10 - t * (15 - 6 * t)), first0 = t - t3 * (6 - t * (8 - 3 * t));
    const double first1 = -t3 * (4 - t * (7 - 3 * t)), second0 = 0.5 * t2 * (1 - t * (3 - t * (3 - t)));
    const double second1 = 0.5 * t3 * (1 - t * (2 - t));
    const double value1_t = 30 * t2 * (1 - t) * (1 - t), first0_t = 1 - t2 * (18 - t * (32 - 15 * t));
    const double first1_t = -t2 * (12 - t * (28 - 15 * t));
    const double second0_t = t * (1 - t * (4.5 - t * (6 - 2.5 * t))), second1_t = t2 * (1.5 - t * (4 - 2.5 * t));
    *slope = value1_t * (b.sigma - a.sigma) / h + first0_t * a.rate + first1_t * b.rate +
             h * (second0_t * a.bend + second1_t * b.bend);
    return a.sigma + value1 * (b.sigma - a.sigma) + h * (first0 * a.rate + first1 * b.rate) +
           h * h * (second0 * a.bend + second1 * b.bend);
  }
};

// The part of a step at which sigma is met; it rises from a to b.
double part_at(const Node& a, const Node& b, double sigma) {
  const SigmaBetween between = {a, b};
  double low = 0.0, high = 1.0, t = 0.5;
  for (int i = 0; i < 60; ++i) {
    double slope = 0.0;
    const double miss = between.at(t, &slope) - sigma;
    (miss > 0.0 ? high : low) = t;
    const double next = t - miss / (slope * (b.place - a.place));
    const double taken = next > low && next < high ? next : 0.5 * (low + high);
    if (std::fabs(taken - t) <= 1e-15) break;
    t = taken;
  }
  return t;
}

void interpolate_all(const Node& a, const Node& b, double t, Node* node) {
  const double h = b.place - a.place, t2 = t * t, t3 = t2 * t;
  const double value1 = t3 * (10 - t * (15 - 6 * t)), first0 = t - t3 * (6 - t * (8 - 3 * t));
  const double first1 = -t3 * (4 - t * (7 - 3 * t)), second0 = 0.5 * t2 * (1 - t * (3 - t * (3 - t)));
  const double second1 = 0.5 * t3 * (1 - t * (2 - t));
  const auto between = [&](const Node::Few& v0, const Node::Few& v1, const Node::Few& f0, const Node::Few& f1,
                           const Node::Few& s0, const Node::Few& s1, Node::Few* out) {
    out->resize(v0.size());
    for (std::size_t i = 0; i < v0.size(); ++i)
      (*out)[i] = v0[i] + value1 * (v1[i] - v0[i]) + h * (first0 * f0[i] + first1 * f1[i]) +
                  h * h * (second0 * s0[i] + second1 * s1[i]);
  };
  between(a.state, b.state, a.state_first, b.state_first, a.state_second, b.state_second, &node->state);
  between(a.turn, b.turn, a.turn_first, b.turn_first, a.turn_second, b.turn_second, &node->turn);
}

class Walker {
 public:
  Walker(const StepLimits& limits, double refused, double until)
      : limits_(limits), refused_(refused), until_(until) {}

  void walk(const Node& from, Passage* p) const {
    go(from, p);
    if (p->end == PassageEnd::lost && p->blame < 0 && !p->unbounded)
      p->blame = loosest_before(*p->arc, p->nodes.empty() ? from : p->nodes.back());
  }

 private:
  // Of the blocks that its own hang on the one nearest to a singular place, -1 where the rounding of none moves the
  // equations by more than is accepted: each look closes them anew. What is walked together has one rounding.
  int loosest_before(const Arc& arc, const Node& a) const {
    int loosest = -1;
    double least = UNKNOWN_ROUNDINGS * EQUATION_ROUNDING / limits_.accept;
    for (std::size_t k = 0; k < a.singular.size(); ++k)
      if (arc.before()[k] && a.singular[k] < least) loosest = (int)k, least = a.singular[k];
    return loosest;
  }

  void go(const Node& from, Passage* p) const {
    Arc& arc = *p->arc;
    Node a, b;
    if (!arc.enter(from, &a)) return;
    p->nodes.assign(1, a);
    double h = std::fmin(arc.wanted_step(a), refused_ / a.rate);
    int refuses = -1;  // the block that refused the last step
    Node mark = a;
    const double rows = arc.equations() + 1.0, cube = rows * rows * rows;
    while (p->steps + p->rejected < limits_.arc_steps && (p->steps + p->rejected) * cube < limits_.arc_work) {
      if (a.place - mark.place >= FARTHEST) {
        p->unbounded = std::fabs(a.sigma - mark.sigma) * arc.speed() < STANDING;
        if (p->unbounded) return;
        mark = a;
      }
      if (stands_in_the_way(arc, a, refuses, h, p)) return;
      if (h < LEAST_ARC) {
        if (touches_dead_centre(p) || !cross_branch_point(p, &a)) return;
        h = arc.wanted_step(a);
      }
      int blame = -1;
      const bool good = arc.step(a, h, &b, &blame) && (continue_turns(arc, a, &b) || h <= limits_.angle_step) &&
                        shows_its_turns(a, b);
      if (!good) {
        ++p->rejected;
        // at a branch point steps of any length end where the pivots are rounding
        const bool singular = h < SINGULAR_STEP && blame >= 0 && arc.owns(blame) && arc.own_pivot(b) < limits_.arc_pivot;
        h = singular ? 0.0 : 0.5 * h, refuses = blame;
        continue;
      }
      ++p->steps;
      if (b.rate <= 0.0 && !rests(arc, a, b)) {
        Node fold;
        if (locate_dead_centre(arc, a, b, &fold)) {
          p->nodes.push_back(fold), p->beyond = on_the_other_side(arc, b), p->end = PassageEnd::dead_centre;
          return;
        }
        h *= 0.5;
        if (h < LEAST_ARC) return;
        continue;
      }
      p->nodes.push_back(b);
      // a step of twice what the path's own steps are refused at: they can go on. Behind a branch point of many loops those
      // of the arc are shorter, as they are of one matrix, and the path's ask each loop by itself
      const double pace = std::fmin(b.rate, a.rate) * arc.speed();
      const bool asks_blocks = !p->crossings.empty() && rows > MANY_EQUATIONS && pace > 0.0;
      if (b.sigma >= until_ || pace * h >= 2.0 * limits_.narrow ||
          (asks_blocks && pace * arc.step_of_blocks(a, b) >= 2.0 * limits_.narrow)) {
        p->end = PassageEnd::through;
        return;
      }
      h = std::fmin(arc.wanted_step(b), 4.0 * h);
      a = b, refuses = -1;
    }
  }

  // Whether sigma stands still but for rounding, as it does in a narrow place that a block turns through while nothing
  // else moves: its rate's sign there says nothing.
  bool rests(const Arc& arc, const Node& a, const Node& b) const {
    const double speed = arc.scale(), moved = std::fabs(b.sigma - a.sigma);
    return std::fmax(std::fabs(a.rate), std::fabs(b.rate)) * speed <= AT_REST &&
           std::fmax(std::fabs(a.bend), std::fabs(b.bend)) * speed <= AT_REST &&
           moved <= 1e-14 * std::fmax(1.0, std::fabs(b.sigma));
  }

  // Two dead centres in one step would go unseen: sigma's rate keeps its sign at both ends. Between them the rate's
  // cubic Hermite polynomial must not come near zero.
  bool shows_its_turns(const Node& a, const Node& b) const {
    if (a.rate * b.rate <= 0.0) return true;
    const double sense = std::copysign(1.0, a.rate);
    const double h = b.place - a.place, least = 0.25 * std::fmin(std::fabs(a.rate), std::fabs(b.rate));
    if (sense * a.bend >= 0.0 || sense * b.bend <= 0.0) return true;
    for (int i = 1; i < 16; ++i) {
      const double t = i / 16.0, t2 = t * t, t3 = t2 * t;
      const double rate = (1 - 3 * t2 + 2 * t3) * a.rate + (3 * t2 - 2 * t3) * b.rate +
                          h * ((t - 2 * t2 + t3) * a.bend + (t3 - t2) * b.bend);
      if (sense * rate < least) return h <= 1e-12;
    }
    return true;
  }

  // Whether another block is what refuses the steps; then the walk ends here.
  bool stands_in_the_way(const Arc& arc, const Node& a, int blame, double h, Passage* p) const {
    const double own = arc.own_danger(a);
    for (std::size_t k = 0; k < a.danger.size(); ++k)
      if (arc.before()[k] && a.danger[k] > std::fmax(BEFORE * own, 1.0 / limits_.narrow)) {
        p->blame = (int)k;
        return true;
      }
    if (h > SHORTENED * arc.own_step(a)) return false;
    int other = blame >= 0 && !arc.owns(blame) ? blame : -1;
    // far below its own step it is another one in any case
    const double least = h > STUCK * arc.own_step(a) ? FASTER * std::fmax(own, 1.0) : 0.0;
    for (std::size_t k = 0; blame < 0 && k < a.danger.size(); ++k) {
      if (arc.owns((int)k) || !arc.carries((int)k) || !(a.danger[k] > least)) continue;
      if (other < 0 || a.danger[k] > a.danger[other]) other = (int)k;
    }
    if (other < 0) return false;
    p->blame = other;
    return true;
  }

  // On from the first node behind a dead centre to one that is as regular as the walk's ends are, but not over the next
  // dead centre: from there the other assembly is followed. A branch that is too short for such a node has dead centres
  // at both ends; the node where sigma moves fastest is the farthest from them.
  Node on_the_other_side(Arc& arc, Node b) const {
    Node c, fastest = b;
    double h = arc.wanted_step(b);
    for (int tries = 0; tries < MOST_BEHIND && h >= LEAST_ARC; ++tries) {
      int blame = -1;
      if (!arc.step(b, h, &c, &blame) || c.rate >= 0.0 || !shows_its_turns(b, c)) {
        h *= 0.5;
        continue;
      }
      const bool regular = -std::fmax(b.rate, c.rate) * arc.speed() * h >= 2.0 * limits_.narrow;
      b = c;
      if (regular) return b;
      if (b.rate < fastest.rate) fastest = b;
      h = std::fmin(arc.wanted_step(b), 2.0 * h);
    }
    return fastest;
  }

  // Whether nothing of sigma but a rounding is left before its rate is zero.
  bool is_at_rest(const Arc& arc, const Node& fold) const {
    if (std::fabs(fold.rate) * arc.scale() <= 1e-7) return true;
    return 0.5 * fold.rate * fold.rate <= ROUNDING_LEFT * std::fmax(1.0, std::fabs(fold.sigma)) * std::fabs(fold.bend);
  }

  // Newton on sigma' = 0 between two nodes where it changes sign.
  bool locate_dead_centre(Arc& arc, const Node& a, const Node& b, Node* fold) const {
    double low = 0.0, high = b.place - a.place, h = high * a.rate / (a.rate - b.rate);
    for (int i = 0; i < 60; ++i) {
      if (!arc.close_from(a, h, fold)) return false;
      (fold->rate > 0.0 ? low : high) = h;
      const double next = h - fold->rate / fold->bend;
      const double taken = next > low && next < high ? next : 0.5 * (low + high);
      if (std::fabs(taken - h) <= 1e-15 * std::fmax(1.0, high) || fold->rate == 0.0) break;
      h = taken;
    }
    continue_turns(arc, a, fold);
    // its derivatives must tell what the ends of the step do
    const double bend = (b.rate - a.rate) / (b.place - a.place);
    return is_at_rest(arc, *fold) && fold->bend < SAME_BEND * bend && bend < SAME_BEND * fold->bend;
  }

  // Where two branches pass at a gap near rounding, steps end shortly before a dead centre. The last nodes tell it if
  // what is left of sigma is a rounding, and the branch is seen to go back behind it.
  bool touches_dead_centre(Passage* p) const {
    if (p->nodes.size() < 2) return false;
    const Node &a = p->nodes[p->nodes.size() - 2], &b = p->nodes.back();
    const double bend = (b.rate - a.rate) / (b.place - a.place), speed = p->arc->scale();
    if (!(b.bend < SAME_BEND * bend && bend < SAME_BEND * b.bend && b.bend < 0.0)) return false;
    const double left = -0.5 * b.rate * b.rate / b.bend;
    if (!(b.rate * speed < STEEP && left <= ROUNDING_LEFT * std::fmax(1.0, std::fabs(b.sigma)))) return false;
    for (double h = p->arc->own_step(b); h > -2.0 * b.rate / b.bend; h *= 0.5) {
      if (!p->arc->close_from(b, h, &p->beyond) || !(p->beyond.correction <= limits_.jump * h)) continue;
      if (!(p->beyond.rate * speed < -STEEP * STEEP)) continue;
      p->end = PassageEnd::dead_centre;
      return true;
    }
    return false;
  }

  // The nodes of a walk, and before them some of the way backwards where it began too near to a branch point: the place is
  // told from a way that is long beside its rounding.
  std::vector<Node> with_way_behind(const Passage& p) const {
    std::vector<Node> found;
    Node a = p.nodes.front(), b;
    double h = p.arc->wanted_step(a);
    for (int tries = 0; tries < MOST_BACK && h >= LEAST_ARC && p.nodes.back().place - a.place < WAY_BEHIND; ++tries) {
      int blame = -1;
      if (!p.arc->step(a, -h, &b, &blame) || b.rate <= 0.0) {
        h *= 0.5;
        continue;
      }
      found.push_back(b);
      h = std::fmin(p.arc->wanted_step(b), 4.0 * h);
      a = b;
    }
    std::reverse(found.begin(), found.end());
    found.insert(found.end(), p.nodes.begin(), p.nodes.end());
    return found;
  }

  bool cross_branch_point(Passage* p, Node* a) const {
    BranchPointAhead point;
    if (p->arc->own_pivot(*a) > SINGULAR_PIVOTS * limits_.arc_pivot) return false;
    Node before, after;
    bool is_told = false, passes = false;
    const auto look = [&](const std::vector<Node>& nodes) {
      BranchPointAhead seen;
      if (nodes.size() < 2 || !branch_point_ahead(*p->arc, nodes, &seen)) return;
      is_told = true, point = seen;
      passes = limits_.straight && pass_straight(*p->arc, point, &before, &after);
    };
    look(p->nodes);
    if (!is_told || passes != limits_.straight) look(with_way_behind(*p));
    if (!is_told) return false;
    p->end = PassageEnd::branch_point;
    if (!passes) {
      Node there = branch_point_node(*p->arc, point);
      while (p->nodes.size() > 1 && p->nodes.back().sigma >= there.sigma) p->nodes.pop_back();
      p->nodes.push_back(there);
      return false;
    }
    p->end = PassageEnd::lost;
    while (p->nodes.size() > 1 && p->nodes.back().place >= before.place) p->nodes.pop_back();
    const auto go_on = [&](Node next) {
      continue_turns(*p->arc, p->nodes.back(), &next);
      p->nodes.push_back(next);
    };
    if (before.place > p->nodes.back().place) go_on(before);
    go_on(after);
    p->crossings.push_back(point.sigma);
    *a = p->nodes.back();
    return true;
  }

  const StepLimits& limits_;
  double refused_, until_;
};

}  // namespace

void walk_passage(const StepLimits& limits, const Node& from, double refused, double until, Passage* passage) {
  Walker(limits, refused, until).walk(from, passage);
}

bool Passage::at(double sigma, Node* node, double* limit) const {
  std::size_t i = 1;
  while (i + 1 < nodes.size() && nodes[i].sigma < sigma) ++i;
  if (nodes.size() < 2 || sigma >= nodes.back().sigma) {
    *node = nodes.back(), *limit = CLOSED;
    return true;
  }
  const Node &a = nodes[i - 1], &b = nodes[i];
  const double t = part_at(a, b, sigma);
  *node = a;
  interpolate_all(a, b, t, node);
  // what is carried along may move far on a short arc
  double square = 0.0;
  for (std::size_t s = 0; s < a.state.size(); ++s) square += (b.state[s] - a.state[s]) * (b.state[s] - a.state[s]);
  *limit = std::fmax(CLOSED, arc->limits().infill * std::fmax(b.place - a.place, std::sqrt(square)));
  if (std::fmin(a.rate, b.rate) * arc->scale() >= SLOW) return true;
  // next to a dead centre the place of sigma on the arc counts
  double low = 0.0, high = b.place - a.place, h = t * high;
  const Node between = *node;
  for (int k = 0; k < 40; ++k) {
    if (!arc->close_from(a, h, node)) {
      *node = between;
      return true;
    }
    // at the dead centre sigma's rate is rounding, and so is what is left of it; where its rate is only small, as that of
    // a screw of great lead, a step still tells the place better
    const double left = node->sigma - sigma, step = left / node->rate;
    const bool rounds = !(std::fabs(left) > SIGMA_ROUNDING * std::fmax(1.0, std::fabs(sigma)));
    if (left == 0.0 || (rounds && !(std::fabs(step) <= TOLD_STEP))) break;
    (left > 0.0 ? high : low) = h;
    const double next = h - step, taken = next > low && next < high ? next : 0.5 * (low + high);
    if (!(std::fabs(taken - h) > 1e-15 * std::fmax(1.0, h))) break;
    h = taken;
  }
  continue_turns(*arc, a, node);
  return true;
}
