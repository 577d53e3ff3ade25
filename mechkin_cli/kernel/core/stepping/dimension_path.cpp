#include "stepping/dimension_path.hpp"

#include <algorithm>
#include <cmath>

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

// Distance from a fold (rad, length units) up to which the branch is its parabola but for parts as small.
constexpr double ON_PARABOLA = 1e-4;
// Times that Newton begins again: its steps take that to the root of rounding: on the fold each halves the distance.
constexpr int COMING_DOWN = 4;

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

// Closes the target from a place next to a fold that is no nearer than the target: at a distance d in sigma from it
// x' = h / 2d and x'' = h / 4d^2, so h = x'^2 / x'' and d = x' / 2x''. On a parabola Newton's method stays on the side where
// it begins, and steps that shrink with the distance need not be known to rounding.
bool come_down(Stepper& stepper, const Node& node, Node* target) {
  const double first = product(node.state_first, node.state_first);
  const double second = std::sqrt(product(node.state_second, node.state_second));
  const double way = first / second, rest = 1.0 - node.sigma;
  if (!(way <= ON_PARABOLA) || !(product(node.state_first, node.state_second) > 0.0)) return false;
  if (!(rest * second <= std::sqrt(first))) return false;
  std::vector<double> guess = node.state;
  for (int k = 0; !stepper.rest(1.0, guess.data(), target); ++k, guess = target->state)
    if (k == COMING_DOWN) return false;
  double square = 0.0;
  for (std::size_t s = 0; s < node.state.size(); ++s) {
    const double moved = target->state[s] - node.state[s];
    square += moved * moved;
  }
  return square <= 4.0 * way * way;
}

}  // namespace

bool follow_to_target(Stepper& stepper, const double* start, Node* node) {
  const StepLimits& limits = stepper.limits();
  Node next;
  if (!stepper.begin(0.0, start, node)) return false;
  double h = stepper.wanted_step(*node);
  for (int steps = 0; node->sigma < 1.0; ++steps) {
    if (steps >= limits.most_steps) return false;
    // a rest of a millionth of a step is taken along
    const bool last = node->sigma + 1.000001 * h >= 1.0;
    const double step = last ? 1.0 - node->sigma : h;
    if (stepper.step(*node, step, last ? 1.0 : node->sigma + step, &next)) {
      h = std::fmin(stepper.wanted_step(next), 4.0 * step);
      std::swap(*node, next);
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
