#include "stepping/stepper.hpp"

#include <cmath>
#include <cstring>

void Line::at(double sigma, PathPoint* point) const {
  const int n = plan_.inputs;
  point->inputs.resize(n), point->first.assign(u_, u_ + n), point->second.assign(n, 0.0);
  for (int i = 0; i < n; ++i) point->inputs[i] = x0_[i] + sigma * u_[i];
}

double tangent_product(const Node& a, const Node& b) {
  double s = 0.0;
  for (std::size_t i = 0; i < a.first.size(); ++i) s += a.first[i] * b.first[i];
  return s + a.own * b.own;
}

std::vector<ClosingTurn> closing_turns(const Plan& plan, const KernelUnit& unit) {
  std::vector<ClosingTurn> turns;
  int slot = 0;
  const auto add = [&](int closing, int freedom, int width) {
    turns.push_back({closing, freedom, slot, width});
    slot += width;
  };
  for (int c = 0; c < plan.closings; ++c) {
    if (plan.closing[c].type == PAIR_DISTANCE || is_relation(plan.closing[c].type)) continue;
    const PairType& pair = unit.pair_types[plan.closing[c].type];
    // without conditions on directions an orientation is free; it is carried along where no angle tells it
    if (pair.equations == pair.lengths && !pair.turns) add(c, -1, 4);
    for (int freedom = 0; freedom < 6; ++freedom)
      if (pair.turns >> freedom & 1) add(c, freedom, 1);
  }
  return turns;
}

int slots_of(const std::vector<ClosingTurn>& turns) {
  int slots = 0;
  for (const ClosingTurn& t : turns) slots += t.width;
  return slots;
}

namespace {

// Those from a slot on.
std::vector<TreeTurn> tree_turns_from(const Plan& plan, int slot) {
  std::vector<TreeTurn> turns;
  for (int k = 0; k < plan.links; ++k) {
    const TreeJoint& j = plan.joints[k];
    if ((j.type == TREE_R || j.type == TREE_C) && plan.column_block[j.column] >= 0) turns.push_back({j.state, slot++});
  }
  return turns;
}

}  // namespace

std::vector<TreeTurn> tree_turns(const Plan& plan, const KernelUnit& unit) {
  return tree_turns_from(plan, slots_of(closing_turns(plan, unit)));
}

int turn_slots(const Plan& plan, const KernelUnit& unit) {
  const int slots = slots_of(closing_turns(plan, unit));
  return slots + (int)tree_turns_from(plan, slots).size();
}

Stepper::Stepper(const Path& path, const KernelUnit& unit, const StepLimits& limits)
    : path_(path), plan_(path.plan(0.0)), unit_(unit), limits_(limits), memory_(unit.workspace_size(plan_)),
      turns_(closing_turns(plan_, unit)), tree_turns_(tree_turns_from(plan_, slots_of(turns_))),
      turn_of_state_(plan_.states, -1), turn_slots_(slots_of(turns_) + (int)tree_turns_.size()) {
  for (const TreeTurn& t : tree_turns_) turn_of_state_[t.state] = t.slot;
  unit.prepare(plan_, memory_.data());
  for (int b = 0; b < plan_.blocks; ++b) entries_ += plan_.block[b].rows * plan_.block[b].size;
}

bool Stepper::close(double sigma, const double* guess, double apart, Node* node) {
  if (!solve(sigma, guess, true, node)) return false;
  node->apart = apart;
  node->own = path_.varies() ? 1.0 : 0.0, node->own_second = 0.0;
  if (path_.varies()) {
    if (!differentiate_by_plan(node)) return false;
    columns_of_states(node);
    return has_derivatives(*node);
  }
  return finish(node);
}

bool Stepper::has_derivatives(const Node& node) {
  for (double d : node.first) if (!std::isfinite(d)) return false;
  for (double d : node.second) if (!std::isfinite(d)) return false;
  return true;
}

// A node that the kernel closed, of a path along which the plan does not change.
bool Stepper::finish(Node* node) const {
  differentiate_states(node);
  differentiate_turns(node);
  return has_derivatives(*node);
}

void Stepper::size_node(Node* node) const {
  node->state.resize(plan_.states);
  node->first.resize(plan_.columns), node->second.resize(plan_.columns);
  node->side.assign(plan_.blocks, 1.0), node->pivot.resize(plan_.blocks);
  node->jacobian.resize(entries_), node->factored.clear(), node->danger.assign(plan_.blocks, 0.0);
  node->singular.assign(plan_.blocks, HUGE_VAL);
  node->turn.resize(turn_slots_), node->turn_first.resize(turn_slots_), node->turn_second.resize(turn_slots_);
}

bool Stepper::solve(double sigma, const double* guess, bool moving, Node* node) {
  const Plan& plan = path_.plan(sigma);
  path_.at(sigma, &point_);
  node->sigma = node->place = sigma, node->rate = 1.0, node->bend = 0.0;
  node->inputs = point_.inputs;
  size_node(node);
  for (const TreeTurn& t : tree_turns_) node->turn[t.slot] = 0.0;
  double residual = 0.0;
  unsigned char flags = 0;
  Request r = {};
  r.rows = 1;
  r.inputs = point_.inputs.data(), r.rates = point_.first.data(), r.accelerations = point_.second.data();
  r.guess = guess;
  r.states = node->state.data();
  r.velocities = node->first.data(), r.second = node->second.data();
  r.residual = &residual, r.correction = &node->correction;
  r.side = node->side.data(), r.pivot = node->pivot.data(), r.jacobian = node->jacobian.data();
  r.turns = turns_.data(), r.turn_count = (int)turns_.size();
  r.turn = node->turn.data(), r.turn_first = node->turn_first.data(), r.turn_second = node->turn_second.data();
  r.flags = &flags;
  r.demand = moving ? DEMAND_VELOCITY | DEMAND_ACCELERATION : 0;
  if (!moving) r.side = r.pivot = r.jacobian = nullptr, r.turn_count = 0;
  r.iterations = limits_.iterations;
  r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
  unit_.run_row(plan, r, memory_.data());
  return flags == 0;
}

// Steps towards a fold are parts of the distance from it, beyond which nothing closes: a small part of them is clear of it.
double Stepper::apart_for(double h) const { return std::fmin(limits_.plan_step, PART_OF_STEP * std::fabs(h)); }

bool Stepper::begin(double sigma, const double* guess, Node* node) {
  if (close(sigma, guess, node)) return true;
  for (double h = limits_.plan_step; path_.varies() && h >= limits_.least_step; h *= PART_OF_STEP)
    if (close(sigma, guess, PART_OF_STEP * h, node)) return true;
  return false;
}

bool Stepper::suit(double h, Node* node) {
  if (!path_.varies() || node->apart <= apart_for(h)) return false;
  const std::vector<double> state = node->state;
  Node again;
  if (!close(node->sigma, state.data(), apart_for(h), &again)) return false;
  again.danger = node->danger, again.singular = node->singular, again.least = node->least;
  *node = again;
  return true;
}

// The derivatives by sigma where the plan changes with it, from three closed places: symmetric differences, one-sided
// at the ends of the path, beyond which a plan need not exist.
bool Stepper::differentiate_by_plan(Node* node) {
  const double d = node->apart, sigma = node->sigma;
  const bool low = sigma < d, high = sigma > 1.0 - d;
  const double one = low || !high ? d : -d, two = low ? 2.0 * d : high ? -2.0 * d : -d;
  Node near, far;
  if (!solve(sigma + one, node->state.data(), false, &near)) return false;
  guess_.resize(plan_.states);
  for (int s = 0; s < plan_.states; ++s)
    guess_[s] = node->state[s] + two / one * (near.state[s] - node->state[s]);
  normalise_quaternions(guess_.data(), 1);
  if (!solve(sigma + two, guess_.data(), false, &far)) return false;
  node->state_first.resize(plan_.states), node->state_second.resize(plan_.states);
  for (int s = 0; s < plan_.states; ++s) {
    // divided differences of Newton's parabola
    const double a = (near.state[s] - node->state[s]) / one, b = (far.state[s] - near.state[s]) / (two - one);
    const double c = (b - a) / two;
    node->state_first[s] = a - one * c;
    node->state_second[s] = 2.0 * c;
  }
  return true;
}

void Stepper::predict(const Node& n, double h, std::vector<double>* guess) const {
  guess->resize(plan_.states);
  for (int s = 0; s < plan_.states; ++s)
    (*guess)[s] = n.state[s] + h * n.state_first[s] + 0.5 * h * h * n.state_second[s];
  normalise_quaternions(guess->data(), 1);
}

bool Stepper::step(const Node& a, double h, double sigma, Node* b) {
  predict(a, h, &ahead_);
  return close(sigma, ahead_.data(), apart_for(h), b) && judge(a, b);
}

// The inputs are columns too, so the first derivatives hold the whole tangent of the branch.
double Stepper::wanted_step(const Node& n) const {
  double b2 = n.own_second * n.own_second, along = n.own * n.own_second, most = longest_step(n);
  // a fifth less than what would be refused
  for (double danger : n.danger) most = lesser(most, 0.8 * limits_.radius / danger);
  for (double s : n.second) b2 += s * s;
  if (b2 == 0.0) return most;
  const double t2 = tangent_product(n, n);
  for (std::size_t i = 0; i < n.first.size(); ++i) along += n.first[i] * n.second[i];
  const double across = std::sqrt(greater(b2 - along * along / t2, 0.0));
  const double by_bend = limits_.bend * std::sqrt(t2 / b2);
  const double by_turn = across > 0.0 ? limits_.turn * std::sqrt(t2) / across : HUGE_VAL;
  return lesser(most, lesser(by_bend, by_turn));
}

// The step in which no input moves farther than it may: s h + b h^2 / 2 with the fastest one's derivatives.
double Stepper::longest_step(const Node& n) const {
  if (path_.is_straight()) return limits_.longest_step;
  double speed = 0.0, bend = 0.0;
  for (int i = 0; i < plan_.inputs; ++i) {
    speed = std::fmax(speed, std::fabs(n.first[plan_.input_column[i]]));
    bend = std::fmax(bend, std::fabs(n.second[plan_.input_column[i]]));
  }
  const double longest = limits_.longest_step, fast = speed + std::sqrt(speed * speed + 2.0 * bend * longest);
  return fast > 2.0 ? 2.0 * longest / fast : longest;
}

bool are_whole_turns(const double* numbers, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    if (!(std::fabs(numbers[k]) <= 0x1p53) || numbers[k] != std::rint(numbers[k])) return false;
  return true;
}

void Stepper::reduce(Node* n) const {
  for (const TreeTurn& t : tree_turns_) {
    const double whole = std::rint(n->state[t.state] / FULL_TURN);
    n->state[t.state] -= FULL_TURN * whole, n->turn[t.slot] += whole;
  }
}

void Stepper::normalise_quaternions(double* state, long stride, long rows) const {
  for (int k = 0; k < plan_.links; ++k) {
    if (plan_.joints[k].type != TREE_S) continue;
    double* q = state + plan_.joints[k].state * stride;
    for (const double* const end = q + rows; q < end; ++q) {
      const double n = std::sqrt(q[0] * q[0] + q[stride] * q[stride] + q[2 * stride] * q[2 * stride] +
                                 q[3 * stride] * q[3 * stride]);
      for (int i = 0; i < 4; ++i) q[i * stride] /= n;
    }
  }
}

namespace {

// w q for a vector w, halved.
void half_product(const double* w, const double* q, double* out) {
  out[0] = 0.5 * (-w[0] * q[1] - w[1] * q[2] - w[2] * q[3]);
  out[1] = 0.5 * (w[0] * q[0] + w[1] * q[3] - w[2] * q[2]);
  out[2] = 0.5 * (-w[0] * q[3] + w[1] * q[0] + w[2] * q[1]);
  out[3] = 0.5 * (w[0] * q[2] - w[1] * q[1] + w[2] * q[0]);
}

// q' = w q / 2, q'' = w' q / 2 + w w q / 4 for a quaternion q that turns with w about the parent's axes.
void differentiate_quaternion(const double* q, const double* w, const double* w_rate, double* first, double* second) {
  const double square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
  half_product(w, q, first);
  half_product(w_rate, q, second);
  for (int i = 0; i < 4; ++i) second[i] -= 0.25 * square * q[i];
}

// The vector part of 2 a q*.
void twice_by_conjugate(const double* a, const double* q, double* out) {
  out[0] = 2.0 * (-a[0] * q[1] + a[1] * q[0] - a[2] * q[3] + a[3] * q[2]);
  out[1] = 2.0 * (-a[0] * q[2] + a[1] * q[3] + a[2] * q[0] - a[3] * q[1]);
  out[2] = 2.0 * (-a[0] * q[3] - a[1] * q[2] + a[2] * q[1] + a[3] * q[0]);
}

}  // namespace

void Stepper::differentiate_states(Node* n) const {
  n->state_first.assign(plan_.states, 0.0);
  n->state_second.assign(plan_.states, 0.0);
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    const double *first = n->first.data() + j.column, *second = n->second.data() + j.column;
    if (j.type == TREE_S) {
      differentiate_quaternion(&n->state[j.state], first, second, &n->state_first[j.state], &n->state_second[j.state]);
      continue;
    }
    for (int f = 0; f < unit_.tree_types[j.type].freedoms; ++f) {
      n->state_first[j.state + f] = first[f];
      n->state_second[j.state + f] = second[f];
    }
  }
}

// The kernel gives a quaternion's rates as an angular velocity and its derivative about the first link's axes.
void Stepper::differentiate_turns(Node* n) const {
  for (const ClosingTurn& t : turns_) {
    if (t.freedom >= 0) continue;
    const double w[3] = {n->turn_first[t.slot], n->turn_first[t.slot + 1], n->turn_first[t.slot + 2]};
    const double a[3] = {n->turn_second[t.slot], n->turn_second[t.slot + 1], n->turn_second[t.slot + 2]};
    differentiate_quaternion(&n->turn[t.slot], w, a, &n->turn_first[t.slot], &n->turn_second[t.slot]);
  }
}

// Columns from the raw states' derivatives: w = 2 q' q*, w' = the vector part of 2 q'' q*.
void Stepper::columns_of_states(Node* n) const {
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    if (j.type == TREE_S) {
      twice_by_conjugate(&n->state_first[j.state], &n->state[j.state], &n->first[j.column]);
      twice_by_conjugate(&n->state_second[j.state], &n->state[j.state], &n->second[j.column]);
      continue;
    }
    for (int f = 0; f < unit_.tree_types[j.type].freedoms; ++f) {
      n->first[j.column + f] = n->state_first[j.state + f];
      n->second[j.column + f] = n->state_second[j.state + f];
    }
  }
}
