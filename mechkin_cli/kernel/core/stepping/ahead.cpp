// Nodes ahead of a step, closed and looked at half way in one pack: a step alone leaves all but one lane idle.
//
// The curve through the last two nodes tells some of the next ones well enough for Newton's method. Each is judged by its
// prediction from the node before it as ever, once that one is on the branch. How many go together does not depend on
// the width of the packs, nor does what they get.
#include <algorithm>
#include <cmath>

#include "rows/units.hpp"
#include "stepping/stepper.hpp"

// Beyond a on the curve through two nodes, by their values and two derivatives.
void Stepper::extrapolate(const Node& before, const Node& a, double place, double* guess, long stride) const {
  const double h = a.place - before.place, t = (place - before.place) / h, u = t - 1.0;
  const double t2 = t * t, t3 = t2 * t, u2 = u * u, u3 = u2 * u;
  // both ends' basis polynomials, those of a by the distance from it
  const double value0 = -u3 * (1.0 + 3.0 * t + 6.0 * t2), value1 = t3 * (1.0 - 3.0 * u + 6.0 * u2);
  const double first0 = -t * u3 * (1.0 + 3.0 * t), first1 = u * t3 * (1.0 - 3.0 * u);
  const double second0 = -0.5 * t2 * u3, second1 = 0.5 * u2 * t3;
  for (int s = 0; s < plan_.states; ++s) {
    const int slot = turn_of_state_[s];
    // angles that were reduced in between
    const double turned = slot < 0 ? 0.0 : FULL_TURN * (before.turn[slot] - a.turn[slot]);
    guess[s * stride] = value0 * (before.state[s] + turned) + value1 * a.state[s] +
                        h * (first0 * before.state_first[s] + first1 * a.state_first[s]) +
                        h * h * (second0 * before.state_second[s] + second1 * a.state_second[s]);
  }
}

void Stepper::run_ahead(const Request& r) {
  if (!wide_) {
    wide_ = kernel_unit(NodesAhead::MOST);
    if (!wide_) wide_ = kernel_unit(2);
    wide_memory_.resize(wide_->workspace_size(plan_));
    if (wide_->lanes >= NodesAhead::MOST) wide_->prepare(plan_, wide_memory_.data());
  }
  if (wide_->lanes >= NodesAhead::MOST)
    wide_->run_row(plan_, r, wide_memory_.data());
  else
    wide_->run_rows(plan_, r, 0, r.rows, wide_memory_.data());
}

void Stepper::close_ahead(const Node& before, const Node& a, const double* sigma, int count, NodesAhead* ahead) {
  const long rows = count, slots = turn_slots_;
  ahead->clear();
  rows_ahead_.resize(rows * (3 * plan_.inputs + 2 * plan_.states + 2 * plan_.columns + 2 * plan_.blocks + entries_ + 3 * slots + 2));
  double* at = rows_ahead_.data();
  const auto take = [&](long columns) {
    double* const here = at;
    at += columns * rows;
    return here;
  };
  double *const inputs = take(plan_.inputs), *const rates = take(plan_.inputs), *const accelerations = take(plan_.inputs);
  double* const guess = take(plan_.states);
  for (long k = 0; k < rows; ++k) {
    path_.at(sigma[k], &point_);
    for (int i = 0; i < plan_.inputs; ++i) {
      const long e = i * rows + k;
      inputs[e] = point_.inputs[i], rates[e] = point_.first[i], accelerations[e] = point_.second[i];
    }
    ahead->node[k]->inputs = point_.inputs;
    extrapolate(before, a, sigma[k], guess + k, rows);
  }
  normalise_quaternions(guess, rows, rows);
  Request r = {};
  r.rows = rows, r.inputs = inputs, r.rates = rates, r.accelerations = accelerations, r.guess = guess;
  r.states = take(plan_.states), r.velocities = take(plan_.columns), r.second = take(plan_.columns);
  r.side = take(plan_.blocks), r.pivot = take(plan_.blocks), r.jacobian = take(entries_);
  r.turns = turns_.data(), r.turn_count = (int)turns_.size();
  r.turn = take(slots), r.turn_first = take(slots), r.turn_second = take(slots);
  r.residual = take(1), r.correction = take(1);
  unsigned char flags[NodesAhead::MOST];
  r.flags = flags;
  r.demand = DEMAND_VELOCITY | DEMAND_ACCELERATION;
  r.iterations = limits_.iterations;
  r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
  run_ahead(r);
  for (long k = 0; k < rows && flags[k] == 0; ++k) {
    Node* const node = ahead->node[k];
    node->sigma = node->place = sigma[k], node->rate = 1.0, node->bend = 0.0;
    node->apart = limits_.plan_step, node->own = node->own_second = 0.0;
    size_node(node);
    const auto read = [&](const double* from, auto* to) {
      for (std::size_t e = 0; e < to->size(); ++e) (*to)[e] = from[e * rows + k];
    };
    read(r.states, &node->state), read(r.velocities, &node->first), read(r.second, &node->second);
    read(r.side, &node->side), read(r.pivot, &node->pivot), read(r.jacobian, &node->jacobian);
    for (const ClosingTurn& t : turns_)
      for (int s = t.slot; s < t.slot + t.width; ++s) {
        const long e = s * rows + k;
        node->turn[s] = r.turn[e], node->turn_first[s] = r.turn_first[e], node->turn_second[s] = r.turn_second[e];
      }
    for (const TreeTurn& t : tree_turns_) node->turn[t.slot] = 0.0;
    if (!finish(node)) break;
    ahead->count = (int)k + 1;
  }
  if (!ahead->count) return;
  // half way to each from the one before
  Request half = {};
  half.rows = ahead->count, half.inputs = inputs, half.guess = guess, half.jacobian = r.jacobian;
  half.residual = r.residual, half.correction = r.correction, half.flags = flags, half.demand = DEMAND_JACOBIAN;
  for (int k = 0; k < ahead->count; ++k) {
    const Node &from = k ? *ahead->node[k - 1] : a, &to = *ahead->node[k];
    middle(from, to, &guess_);
    for (int s = 0; s < plan_.states; ++s) guess[s * half.rows + k] = guess_[s];
    path_.at(from.sigma + 0.5 * (to.sigma - from.sigma), &point_);
    for (int i = 0; i < plan_.inputs; ++i) inputs[i * half.rows + k] = point_.inputs[i];
  }
  run_ahead(half);
  ahead->half_way.resize(ahead->count * entries_);
  for (int k = 0; k < ahead->count; ++k)
    for (long e = 0; e < entries_; ++e) ahead->half_way[k * entries_ + e] = half.jacobian[e * half.rows + k];
}
