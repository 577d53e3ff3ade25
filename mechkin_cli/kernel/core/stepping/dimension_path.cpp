#include "stepping/dimension_path.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/dense.hpp"
#include "rows/unit.hpp"

DimensionPath::DimensionPath(const Tape& tape, const KernelUnit& unit, const double* base, FrozenPlan* plan,
                             const double* inputs, long moving, long stride)
    : tape_(tape), unit_(unit), base_(base), plan_(plan), inputs_(inputs), moving_(moving), stride_(stride),
      memory_(unit.replay_size(tape)) {}

void DimensionPath::aim(const double* target, const std::vector<double>& near) {
  target_ = target;
  places_.clear(), outputs_.clear();
  replay(near);
}

void DimensionPath::replay(const std::vector<double>& places) const {
  const std::size_t count = places.size(), before = places_.size();
  values_.resize(tape_.inputs * count), verdict_.resize(count);
  for (int k = 0; k < tape_.inputs; ++k)
    for (std::size_t i = 0; i < count; ++i)
      values_[k * count + i] =
          places[i] == 1.0 ? target_[k] : base_[k] + places[i] * (target_[k] - base_[k]);
  places_.insert(places_.end(), places.begin(), places.end());
  outputs_.resize(places_.size() * tape_.outputs);
  const TapeRequest request = {(long)count, values_.data(), outputs_.data() + before * tape_.outputs, verdict_.data()};
  unit_.replay(tape_, request, memory_.data());
}

const double* DimensionPath::outputs(double sigma) const {
  std::size_t k = 0;
  while (k < places_.size() && places_[k] != sigma) ++k;
  if (k == places_.size()) replay({sigma});
  return outputs_.data() + k * tape_.outputs;
}

void DimensionPath::at(double sigma, PathPoint* point) const {
  const int n = plan_->view().inputs;
  point->inputs.resize(n), point->first.assign(n, 0.0), point->second.assign(n, 0.0);
  const double* const from = inputs_ ? inputs_ : outputs(sigma) + moving_;
  const long stride = inputs_ ? 1 : stride_;
  for (int i = 0; i < n; ++i) point->inputs[i] = from[i * stride];
  // nothing closes where there is no plan
  if (!is_plan_) point->inputs.assign(n, __builtin_nan(""));
}

const Plan& DimensionPath::plan(double sigma) const {
  is_plan_ = plan_->assign(outputs(sigma));
  return plan_->view();
}

namespace {

// Distance from a fold (rad, length units) up to which the branch is its parabola but for parts as small; and up to which
// it is, where two nodes tell the same fold. What a short arm moves is lost in rounding before it comes as near as the first.
constexpr double ON_PARABOLA = 1e-4, SEEN_PARABOLA = 1e-2;
// Part of the distance from a fold by which two nodes may tell it differently; the least way between them, and the least
// and most that is left of the way to the target, in parts of it.
constexpr double SAME_FOLD = 0.05, APART = 0.1, LEAST_LEFT = 0.5, MOST_LEFT = 1.0 + SAME_FOLD;
// Part of the square of a node's distance from the fold by which half the way may miss the parabola; its derivatives may be
// wrong by a fifth where rounding has the last of them.
constexpr double SAME_HALF = 0.2;
// Least cosine between the ways to a target and to half of it.
constexpr double SAME_WAY = 0.95;
// Times that Newton begins again: its steps take that to the root of rounding: on the fold each halves the distance.
constexpr int COMING_DOWN = 4;
// Least singular value of a block from which on derivatives of the base are well known: 1e-4 from a fold it is far smaller.
constexpr double NARROW = 1e-2;

// Closes a place next to a fold from another: on a parabola Newton's method stays on the side where it begins.
bool newton_beside_fold(Stepper& stepper, double sigma, const Node::Few& from, Node* to) {
  std::vector<double> guess = from;
  for (int k = 0; !stepper.rest(sigma, guess.data(), to); ++k, guess = to->state)
    if (k == COMING_DOWN) return false;
  return true;
}

// Whether the way to a place `rest` nearer to the fold lies on the parabola of a node: at a distance d in sigma from the
// fold x' = h / 2d and x'' = -h / 4d^2, so h = x'^2 / x'' and d = x' / 2x''. `sense`: that of sigma towards the fold.
bool is_on_parabola(const Node& node, double sense, double rest, const Node::Few& other) {
  const double first = product(node.state_first, node.state_first);
  const double second = std::sqrt(product(node.state_second, node.state_second));
  const double way = first / second;
  if (!(way <= ON_PARABOLA) || !(sense * product(node.state_first, node.state_second) > 0.0)) return false;
  if (!(rest * second <= std::sqrt(first))) return false;
  double square = 0.0;
  for (std::size_t s = 0; s < node.state.size(); ++s) {
    const double moved = other[s] - node.state[s];
    square += moved * moved;
  }
  return square <= 4.0 * way * way;
}

double distance(const Node::Few& a, const Node::Few& b) {
  double square = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

// The parabola of a node: the distances from its fold, in sigma and in the states; sigma rises to the fold with `sense` 1.
struct Parabola {
  double ahead, way;
  Parabola(const Node& node, double sense) {
    const double first = product(node.state_first, node.state_first);
    const double second = std::sqrt(product(node.state_second, node.state_second));
    const bool falls = sense * product(node.state_first, node.state_second) > 0.0;
    ahead = falls ? 0.5 * std::sqrt(first) / second : HUGE_VAL, way = first / second;
  }
};

// Whether half the way from a node to a target lies between them and on their parabola, where the squares of the distances
// from the fold are linear in sigma: where the branch passes another one by little, Newton's method may come to that.
bool keeps_to_parabola(Stepper& stepper, const Node& node, const Node& target) {
  Node half;
  if (!newton_beside_fold(stepper, 0.5 * (node.sigma + 1.0), node.state, &half)) return false;
  const double to_half = distance(node.state, half.state), to_target = distance(node.state, target.state);
  const double way = Parabola(node, 1.0).way, near = way - to_half, end = way - to_target;
  double along = 0.0;
  for (std::size_t s = 0; s < node.state.size(); ++s)
    along += (half.state[s] - node.state[s]) * (target.state[s] - node.state[s]);
  if (!(along >= SAME_WAY * to_half * to_target)) return false;
  return to_half <= to_target && std::fabs(near * near - 0.5 * (way * way + end * end)) <= SAME_HALF * way * way;
}

// Closes the target from a place next to a fold that is no nearer than the target: steps that shrink with the distance
// need not be known to rounding.
bool come_down(Stepper& stepper, const Node& node, Node* target) {
  return is_on_parabola(node, 1.0, 1.0 - node.sigma, node.state) &&
         newton_beside_fold(stepper, 1.0, node.state, target) &&
         is_on_parabola(node, 1.0, 1.0 - node.sigma, target->state) && keeps_to_parabola(stepper, node, *target);
}

// The same from farther off where this node and the one before it tell the same fold, about where the target is.
bool come_down_seen(Stepper& stepper, const Node& before, const Node& node, Node* target) {
  const Parabola a(before, 1.0), b(node, 1.0);
  const double moved = node.sigma - before.sigma, left = 1.0 - node.sigma;
  if (!(b.way <= SEEN_PARABOLA && moved >= APART * b.ahead && left >= LEAST_LEFT * b.ahead && left <= MOST_LEFT * b.ahead))
    return false;
  if (!(std::fabs(a.ahead - b.ahead - moved) <= SAME_FOLD * b.ahead)) return false;
  // of the distance h^2 in sigma the states are at h times a vector: its length is the same seen from both
  if (!(std::fabs(a.way * std::sqrt(b.ahead / a.ahead) - b.way) <= SAME_FOLD * b.way)) return false;
  return newton_beside_fold(stepper, 1.0, node.state, target) && distance(node.state, target->state) <= 1.2 * b.way &&
         keeps_to_parabola(stepper, node, *target);
}

// Whether some block's least singular value is so small that derivatives by the plan may be rounding.
bool is_narrow(const Plan& plan, const Node& node) {
  long at = 0;
  for (int b = 0; b < plan.blocks; ++b) {
    Matrix matrix(plan.block[b].rows, plan.block[b].size);
    for (double& entry : matrix.a) entry = node.jacobian[at++];
    if (!(Factored(matrix).squares.least_singular_bound() >= NARROW)) return true;
  }
  return false;
}

// Leaves a place so near to a fold that its derivatives are rounding, for the farthest one on the parabola, whose own
// derivatives tell that the fold lies behind both.
bool go_up(Stepper& stepper, const Node& node, Node* next) {
  // a ladder of places, each four times as far from the fold as the one before it, from which Newton's method comes to it
  const double whole = 1.0 - node.sigma;
  std::vector<Node::Few> places;
  std::vector<double> steps;
  for (double h = whole; h >= stepper.limits().least_step; h *= 0.0625) steps.push_back(h);
  Node there;
  const Node::Few* from = &node.state;
  places.resize(steps.size());
  for (std::size_t k = steps.size(); k-- > 0;) {
    if (!newton_beside_fold(stepper, k ? node.sigma + steps[k] : 1.0, *from, &there)) continue;
    places[k] = there.state, from = &places[k];
  }
  // next to the fold rounding decides on which side of it the ladder goes up: the other side is its mirror image
  for (std::size_t turn = 0; turn < 2 * steps.size(); ++turn) {
    const std::size_t k = turn % steps.size();
    if (places[k].empty()) continue;
    if (turn >= steps.size())
      for (std::size_t s = 0; s < places[k].size(); ++s) places[k][s] = 2.0 * node.state[s] - places[k][s];
    const double h = steps[k], sigma = k ? node.sigma + h : 1.0;
    if (!stepper.close_after(h, sigma, places[k].data(), next) || next->side != node.side) continue;
    if (is_on_parabola(*next, -1.0, h, node.state)) return true;
    const Parabola seen(*next, -1.0);
    if (seen.way <= SEEN_PARABOLA && std::fabs(seen.ahead - h) <= SAME_FOLD * h &&
        std::fabs(distance(next->state, node.state) - seen.way) <= SAME_FOLD * seen.way)
      return true;
  }
  return false;
}

// Follows the branch from a node to sigma 1; false where the steps become too short.
bool step_to_target(Stepper& stepper, Node* node) {
  const StepLimits& limits = stepper.limits();
  Node next, target;
  double h = stepper.wanted_step(*node);
  for (int steps = 0; node->sigma < 1.0; ++steps) {
    if (steps >= limits.most_steps) return false;
    // a rest of a millionth of a step is taken along
    const bool last = node->sigma + 1.000001 * h >= 1.0;
    const double step = last ? 1.0 - node->sigma : h;
    if (stepper.step(*node, step, last ? 1.0 : node->sigma + step, &next)) {
      h = std::fmin(stepper.wanted_step(next), 4.0 * step);
      std::swap(*node, next);
      if (node->sigma < 1.0 && come_down_seen(stepper, next, *node, &target)) {
        std::swap(*node, target);
        return true;
      }
      continue;
    }
    h = 0.5 * step;
    if (h < limits.least_step) return false;
    if (stepper.suit(h, node)) h = std::fmin(h, stepper.wanted_step(*node));
    if (!come_down(stepper, *node, &next)) continue;
    std::swap(*node, next);
    return true;
  }
  return true;
}

}  // namespace

bool follow_to_target(Stepper& stepper, const double* start, Node* node) {
  if (stepper.begin(0.0, start, node) && step_to_target(stepper, node)) return true;
  Node base, next;
  if (!stepper.stand(0.0, start, &base) || !is_narrow(stepper.plan(), base) || !go_up(stepper, base, &next)) return false;
  *node = next;
  return step_to_target(stepper, node);
}
