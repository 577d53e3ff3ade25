#include "stepping/arc.hpp"

#include <algorithm>
#include <cmath>

namespace {

// Half a unit in the last place of an equation; singular values below which it moves the unknowns by more than a
// hundredth of the least that steps have.
constexpr double ROUNDING = 1e-16, LOOSE = 1e-4;

}  // namespace

std::vector<char> upstream_blocks(const Plan& plan, const KernelUnit& unit) {
  const int n = plan.blocks;
  std::vector<char> before((std::size_t)n * n, 0);
  for (int b = 0; b < n; ++b) {
    const auto hangs_on = [&](int other) {
      if (other < 0 || other == b) return;
      before[b * n + other] = 1;
      for (int k = 0; k < n; ++k) before[b * n + k] |= before[other * n + k];
    };
    for (int c = plan.block[b].closing_begin; c < plan.block[b].closing_end; ++c)
      for (int l = plan.closing[c].loop_begin; l < plan.closing[c].loop_end; ++l) {
        const TreeJoint& j = plan.joints[plan.loop[l].joint];
        for (int f = 0; f < unit.tree_types[j.type].freedoms; ++f) hangs_on(plan.column_block[j.column + f]);
      }
  }
  return before;
}

Arc::Arc(const Path& path, const KernelUnit& unit, const StepLimits& limits, std::vector<char> own,
         std::vector<char> carried, double weight)
    : Stepper(path, unit, limits), own_(std::move(own)), before_(plan_.blocks, 0), carried_(std::move(carried)),
      weight_(weight) {
  const std::vector<char> upstream = upstream_blocks(plan_, unit);
  const int n = plan_.blocks;
  for (int b = 0; b < n; ++b) {
    if (!own_[b]) continue;
    const Block& block = plan_.block[b];
    if (first_ < 0) first_ = b;
    rows_ += block.rows, size_ += block.size;
    unknown_.insert(unknown_.end(), plan_.unknown + block.column_begin, plan_.unknown + block.column_begin + block.size);
    for (int other = 0; other < n; ++other)
      if (upstream[b * n + other] && !own_[other]) before_[other] = 1;
  }
  for (const ClosingTurn& t : turns())
    for (int b = 0; b < n; ++b)
      if (carries(b) && t.closing >= plan_.block[b].closing_begin && t.closing < plan_.block[b].closing_end)
        carried_turns_.push_back(t);
}

bool Arc::look(const double* guess, bool complete, const std::vector<double>& rates, double sigma_rate,
               const std::vector<double>& accelerations, double sigma_bend, int iterations, unsigned demand, Node* node,
               Looked* out) {
  path_.at(node->sigma, &point_);
  node->inputs = point_.inputs;
  std::vector<double> input_rates(plan_.inputs), input_accelerations(plan_.inputs);
  for (int i = 0; i < plan_.inputs; ++i) {
    input_rates[i] = point_.first[i] * sigma_rate;
    input_accelerations[i] = point_.second[i] * sigma_rate * sigma_rate + point_.first[i] * sigma_bend;
  }
  std::vector<unsigned char> use(plan_.blocks);
  bool all = true;
  for (int b = 0; b < plan_.blocks; ++b) {
    const bool solved = before_[b] || (complete && carried_[b]);
    use[b] = own_[b] ? BLOCK_HELD : solved ? BLOCK_SOLVED : BLOCK_LEFT;
    all = all && use[b] != BLOCK_LEFT;
  }
  out->equations.assign(rows_, 0.0), out->first.assign(rows_, 0.0), out->second.assign(rows_, 0.0);
  const Held held = {use.data(), complete && all, rates.data(), accelerations.data(),
                     out->equations.data(), out->first.data(), out->second.data()};
  size_node(node);
  double residual = 0.0;
  unsigned char flags = 0;
  Request r = {};
  r.rows = 1, r.held = &held;
  r.inputs = point_.inputs.data(), r.rates = input_rates.data(), r.accelerations = input_accelerations.data();
  r.guess = guess, r.states = node->state.data();
  r.velocities = node->first.data(), r.second = node->second.data();
  r.residual = &residual, r.correction = &node->correction, r.flags = &flags;
  r.side = node->side.data(), r.pivot = node->pivot.data(), r.jacobian = node->jacobian.data();
  if (complete && (demand & DEMAND_ACCELERATION)) {
    r.turns = carried_turns_.data(), r.turn_count = (int)carried_turns_.size();
    std::fill(node->turn_first.begin(), node->turn_first.end(), 0.0);
    std::fill(node->turn_second.begin(), node->turn_second.end(), 0.0);
    r.turn = node->turn.data(), r.turn_first = node->turn_first.data(), r.turn_second = node->turn_second.data();
  }
  r.demand = demand;
  r.iterations = iterations;
  r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
  std::fill(node->pivot.begin(), node->pivot.end(), 1.0);
  unit_.run_row(plan_, r, memory_.data());
  // the held blocks' equations are Newton's business until it has ended
  return complete ? flags == 0 : true;
}

// Of one block as the kernel has it; of several by rates of one unknown after the other, since one block's equations
// read the unknowns of those before it: each in a lane of its own.
Matrix Arc::own_jacobian(const Node& node) {
  int blocks = 0;
  for (char own : own_) blocks += own;
  if (blocks == 1) return block_matrix(node.jacobian.data(), first_);
  Matrix j(rows_, size_);
  path_.at(node.sigma, &point_);
  std::vector<unsigned char> use(plan_.blocks);
  for (int b = 0; b < plan_.blocks; ++b) use[b] = own_[b] ? BLOCK_HELD : before_[b] ? BLOCK_SOLVED : BLOCK_LEFT;
  for (int begin = 0; begin < size_; begin += unit_.lanes) {
    const int rows = std::min(unit_.lanes, size_ - begin);
    const auto in_rows = [rows](const std::vector<double>& one) {
      std::vector<double> every;
      every.reserve(one.size() * rows);
      for (double x : one) every.insert(every.end(), rows, x);
      return every;
    };
    const std::vector<double> inputs = in_rows(point_.inputs), guess = in_rows(node.state);
    const std::vector<double> still((std::size_t)plan_.inputs * rows, 0.0), none((std::size_t)size_ * rows, 0.0);
    std::vector<double> rates = none, states(guess.size()), velocities((std::size_t)plan_.columns * rows);
    for (int k = 0; k < rows; ++k) rates[(std::size_t)(begin + k) * rows + k] = 1.0;
    std::vector<double> equations((std::size_t)rows_ * rows), first(equations), residual(rows), correction(rows);
    std::vector<unsigned char> flags(rows);
    const Held held = {use.data(), false, rates.data(), none.data(), equations.data(), first.data(), nullptr};
    Request r = {};
    r.rows = rows, r.held = &held;
    r.inputs = inputs.data(), r.rates = still.data(), r.guess = guess.data();
    r.states = states.data(), r.velocities = velocities.data();
    r.residual = residual.data(), r.correction = correction.data(), r.flags = flags.data();
    r.demand = DEMAND_VELOCITY;
    r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
    unit_.run_row(plan_, r, memory_.data());
    for (int i = 0; i < rows_; ++i)
      for (int k = 0; k < rows; ++k) j(i, begin + k) = first[(std::size_t)i * rows + k];
  }
  return j;
}

std::vector<double> Arc::tangent(const Node& node) const {
  std::vector<double> t(size_ + 1);
  for (int u = 0; u < size_; ++u) t[u] = node.first[unknown_[u]];
  t[size_] = node.rate * scale_;
  return t;
}

namespace {

double length_of(const std::vector<double>& v) {
  double square = 0.0;
  for (double x : v) square += x * x;
  return std::sqrt(square);
}

bool is_finite(const std::vector<double>& v) {
  for (double x : v)
    if (!std::isfinite(x)) return false;
  return true;
}

}  // namespace

Matrix Arc::bordered(const Node& node) const { return with_row(extended(node), tangent(node)); }

// Increments of the unknowns; a turn's third order does not matter to Newton's method.
void Arc::advance(const std::vector<double>& step, double* state) const {
  for (int u = 0; u < size_; ++u) {
    const int column = unknown_[u];
    const TreeJoint& j = plan_.joints[plan_.column_joint[column]];
    if (j.type != TREE_S) {
      state[j.state + column - j.column] += step[u];
      continue;
    }
    if (column != j.column) continue;
    double* const q = state + j.state;
    double w[3] = {};
    for (int v = 0; v < size_; ++v)
      if (plan_.column_joint[unknown_[v]] == plan_.column_joint[column]) w[unknown_[v] - j.column] = 0.5 * step[v];
    const double turned[4] = {q[0] - w[0] * q[1] - w[1] * q[2] - w[2] * q[3],
                              q[1] + w[0] * q[0] + w[1] * q[3] - w[2] * q[2],
                              q[2] + w[1] * q[0] + w[2] * q[1] - w[0] * q[3],
                              q[3] + w[2] * q[0] + w[0] * q[2] - w[1] * q[1]};
    const double size = std::sqrt(turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] +
                                  turned[3] * turned[3]);
    for (int i = 0; i < 4; ++i) q[i] = turned[i] / size;
  }
}

// Newton's method on the equations and border.(step taken) = target, both counted from the guess.
bool Arc::close_by(std::vector<double> state, double sigma, const std::vector<double>& border, double target,
                   Node* node) {
  const std::vector<double> none(size_, 0.0), guess = state;
  const double guessed = sigma;
  Looked seen;
  std::vector<double> way(size_ + 1, 0.0);
  bool short_step = false;
  for (int iteration = 0; iteration <= limits_.iterations; ++iteration) {
    node->sigma = sigma;
    look(state.data(), false, none, 1.0, none, 0.0, limits_.iterations, DEMAND_VELOCITY, node, &seen);
    state = node->state;
    node->extended = with_column(own_jacobian(*node), seen.first, 1.0 / scale_);
    if (short_step) break;
    std::vector<double> right(rows_ + 1);
    for (int i = 0; i < rows_; ++i) right[i] = -seen.equations[i];
    right[rows_] = target;
    for (int u = 0; u <= size_; ++u) right[rows_] -= border[u] * way[u];
    const std::vector<double> step = LeastSquares(with_row(extended(*node), border)).solve(right);
    if (!is_finite(step)) return false;
    advance(step, state.data());
    sigma += step[size_] / scale_;
    for (int u = 0; u <= size_; ++u) way[u] += step[u];
    short_step = length_of(step) <= limits_.coarse;
  }
  if (!short_step) return false;
  double correction = std::fabs(sigma - guessed) * scale_;
  for (int s = 0; s < plan_.states; ++s) correction = std::fmax(correction, std::fabs(state[s] - guess[s]));
  node->correction = correction;
  return true;
}

// A closed node's tangent, on the side of the one it has, and second derivatives; then all that is carried along.
bool Arc::differentiate(Node* node) {
  const std::vector<double> before = tangent(*node);
  std::vector<double> right(rows_ + 1, 0.0);
  right[rows_] = 1.0;
  std::vector<double> t = LeastSquares(with_row(extended(*node), before)).solve(right);
  const double size = length_of(t);
  if (!(size > 0.0) || !std::isfinite(size)) return false;
  for (double& x : t) x /= size;
  const std::vector<double> rates(t.begin(), t.end() - 1), none(size_, 0.0);
  const double rate = t[size_] / scale_;
  const std::vector<double> state = node->state;
  const double correction = node->correction;
  Looked seen;
  look(state.data(), false, rates, rate, none, 0.0, limits_.iterations, DEMAND_VELOCITY | DEMAND_ACCELERATION, node,
       &seen);
  for (int i = 0; i < rows_; ++i) right[i] = -seen.second[i];
  right[rows_] = 0.0;
  const LeastSquares matrix(with_row(extended(*node), t));
  const std::vector<double> second = matrix.solve(right);
  const std::vector<double> accelerations(second.begin(), second.end() - 1);
  const double bend = second[size_] / scale_;
  if (!is_finite(second) || !look(state.data(), true, rates, rate, accelerations, bend, limits_.iterations,
                                  DEMAND_VELOCITY | DEMAND_ACCELERATION, node, &seen))
    return false;
  node->rate = rate, node->bend = bend;
  node->correction = std::fmax(correction, node->correction);
  // what the weight adds to the inputs' own part in the tangent
  const double more = std::sqrt(weight_ * weight_ - 1.0) * speed_;
  node->own = rate * more, node->own_second = bend * more;
  double pivot = matrix.least_singular_bound();
  if (pivot < limits_.arc_pivot) pivot = std::sqrt(ROUNDING / rounding_of_matrix(*node, matrix, t));
  for (int b = 0; b < plan_.blocks; ++b)
    if (own_[b]) node->pivot[b] = pivot;
  clear_uncarried(node);
  differentiate_states(node), differentiate_turns(node);
  return is_finite(node->first) && is_finite(node->second);
}

// What a rounding of the equations does to the matrix: the sum of the radii of M^-1 (M' - M), with M' at the states that
// a rounding moves along the directions that the equations hardly tell. Of one narrow place it is a rounding over the
// pivot's square; where one follows another the pivot is as small as the product of both, and the matrix is as sure
// as with the smaller of them alone.
double Arc::rounding_of_matrix(const Node& node, const LeastSquares& matrix, const std::vector<double>& border) {
  const Singular s = singular_vectors(node.extended);
  double radius = 0.0;
  for (int i = 0; i < size_; ++i) {
    if (s.value[i] > LOOSE) continue;
    std::vector<double> moved(size_);
    const double part = ROUNDING / s.value[i];
    for (int u = 0; u < size_; ++u) moved[u] = part * s.v(u, i);
    std::vector<double> state = node.state;
    advance(moved, state.data());
    Matrix change = matrix.solve(
        with_row(extended_at(node, state, node.sigma + part * s.v(size_, i) / scale_), border));
    subtract_identity(&change);
    radius += spectral_radius_bound(change);
  }
  return radius;
}

void Arc::clear_uncarried(Node* node) const {
  for (int c = 0; c < plan_.columns; ++c) {
    const int b = plan_.column_block[c];
    if (b < 0 || carries(b)) continue;
    node->first[c] = node->second[c] = 0.0;
  }
}

bool Arc::enter(const Node& node, Node* start) {
  double square = 0.0;
  for (int i = 0; i < plan_.inputs; ++i) {
    const double rate = node.first[plan_.input_column[i]] / (node.rate != 0.0 ? node.rate : 1.0);
    square += rate * rate;
  }
  speed_ = square > 0.0 ? std::sqrt(square) : 1.0, scale_ = weight_ * speed_;
  *start = node;
  start->place = 0.0, start->rate = node.rate;
  start->correction = 0.0;
  const std::vector<double> none(size_, 0.0);
  std::vector<double> border(size_ + 1);
  double size = 0.0;
  for (int u = 0; u < size_; ++u) border[u] = node.first[unknown_[u]];
  border[size_] = node.rate * scale_;
  size = length_of(border);
  if (!(size > 0.0) || !std::isfinite(size)) return false;
  for (double& x : border) x /= size;
  for (int u = 0; u < size_; ++u) start->first[unknown_[u]] = border[u];
  start->rate = border[size_] / scale_;
  if (!close_by(node.state, node.sigma, border, 0.0, start)) return false;
  for (int u = 0; u < size_; ++u) start->first[unknown_[u]] = border[u];
  start->rate = border[size_] / scale_;
  const bool good = differentiate(start);
  start->turn = node.turn.size() == start->turn.size() ? node.turn : start->turn;
  return good;
}

bool Arc::close_from(const Node& a, double h, Node* b) {
  std::vector<double> guess;
  predict(a, h, &guess);
  const std::vector<double> border = tangent(a);
  const double sigma = a.sigma + h * a.rate + 0.5 * h * h * a.bend;
  // the guess lies on the plane that the border tells; Newton stays in it
  *b = a;
  if (!close_by(std::move(guess), sigma, border, 0.0, b)) return false;
  b->place = a.place + h;
  for (int u = 0; u < size_; ++u) b->first[unknown_[u]] = border[u];
  b->rate = a.rate;
  return differentiate(b);
}

std::vector<double> Arc::inputs_at(double sigma) {
  path_.at(sigma, &point_);
  return point_.inputs;
}

Matrix Arc::extended_at(const Node& near, const std::vector<double>& state, double sigma) {
  const std::vector<double> none(size_, 0.0);
  Node copy = near;
  copy.sigma = sigma;
  Looked seen;
  look(state.data(), false, none, 1.0, none, 0.0, limits_.iterations, DEMAND_VELOCITY, &copy, &seen);
  return with_column(own_jacobian(copy), seen.first, 1.0 / scale_);
}

// sigma counts by its own speed, whatever its weight.
double Arc::longest_step(const Node& n) const {
  if (weight_ == 1.0) return Stepper::longest_step(n);
  const double part = n.rate * scale_, plain = n.rate * speed_;
  return limits_.longest_step / std::sqrt(std::fmax(1.0 - part * part, 0.0) + plain * plain);
}

double Arc::own_step(const Node& n) const {
  double bend = n.bend * scale_ * n.bend * scale_;
  for (int u = 0; u < size_; ++u) bend += n.second[unknown_[u]] * n.second[unknown_[u]];
  const double most = std::fmin(longest_step(n), 0.8 * limits_.radius / own_danger(n));
  return std::fmin(most, std::fmin(limits_.bend, limits_.turn) / std::sqrt(bend));
}

double Arc::step_of_blocks(const Node& a, const Node& b) const {
  double most = HUGE_VAL;
  int row = 0, column = 0;
  for (int k = 0; k < plan_.blocks; ++k) {
    if (!own_[k]) continue;
    const Block& block = plan_.block[k];
    Matrix from(block.rows, block.size), to = from;
    for (int i = 0; i < block.rows; ++i)
      for (int j = 0; j < block.size; ++j) {
        from(i, j) = a.extended(row + i, column + j);
        to(i, j) = b.extended(row + i, column + j);
      }
    most = std::fmin(most, 0.8 * limits_.radius * (b.place - a.place) / LeastSquares(to).change_bound(from));
    row += block.rows, column += block.size;
  }
  return most;
}

bool Arc::same_side(const Node& a, Node* b, int* blame) {
  const double h = b->place - a.place;
  Node half = a;
  half.sigma = 0.5 * (a.sigma + b->sigma) + 5.0 / 32.0 * h * (a.rate - b->rate) + h * h / 64.0 * (a.bend + b->bend);
  const std::vector<double> none(size_, 0.0);
  std::vector<double> guess;
  middle(a, *b, &guess);
  std::vector<double> t = tangent(a), other = tangent(*b);
  for (int u = 0; u <= size_; ++u) t[u] += other[u];
  const double size = length_of(t);
  for (double& x : t) x /= size;
  Looked seen;
  look(guess.data(), true, none, 1.0, none, 0.0, 0, DEMAND_VELOCITY, &half, &seen);
  half.extended = with_column(own_jacobian(half), seen.first, 1.0 / scale_);
  double own_danger = 0.0;
  const bool own_same =
      is_regular_segment(Factored(bordered(a)), with_row(half.extended, t), Factored(bordered(*b)), limits_.radius,
                         &own_danger, &b->least);
  for (int k = 0; k < plan_.blocks; ++k) {
    if (!carries(k)) continue;
    double danger = own_danger;
    const bool same = own_[k] ? own_same
                              : has_band(k)
                                  ? is_regular_band(k, a.jacobian.data(), half.jacobian.data(), b->jacobian.data(), &danger,
                                                    &b->singular[k])
                                  : is_regular_segment(Factored(block_matrix(a.jacobian.data(), k)),
                                                       block_matrix(half.jacobian.data(), k),
                                                       Factored(block_matrix(b->jacobian.data(), k)), limits_.radius, &danger,
                                                   &b->singular[k]);
    b->danger[k] = danger / std::fabs(h), b->least = std::fmin(b->least, b->singular[k]);
    if (!same || !(b->singular[k] >= limits_.pivot)) {
      *blame = k;
      return false;
    }
  }
  return true;
}

bool Arc::step(const Node& a, double h, Node* b, int* blame) {
  *blame = -1;
  if (!close_from(a, h, b)) return false;
  const double length = std::fabs(h) * std::sqrt(tangent_product(a, a));
  if (!(b->correction <= limits_.jump * length)) return false;
  for (int k = 0; k < plan_.blocks; ++k)
    if (carries(k) && !(b->pivot[k] >= (own_[k] ? limits_.arc_pivot : limits_.pivot))) {
      *blame = k;
      return false;
    }
  if (turned_too_far(a, *b) || !looks_back(a, *b, limits_.jump * length)) return false;
  const double back = b->sigma - h * b->rate + 0.5 * h * h * b->bend;
  return std::fabs(back - a.sigma) * scale_ <= limits_.jump * length && same_side(a, b, blame);
}

std::vector<double> Arc::second_along(const Node& node, const std::vector<double>& v) {
  Node copy = node;
  const std::vector<double> rates(v.begin(), v.end() - 1), none(size_, 0.0);
  Looked seen;
  look(node.state.data(), false, rates, v[size_] / scale_, none, 0.0, limits_.iterations,
       DEMAND_VELOCITY | DEMAND_ACCELERATION, &copy, &seen);
  return seen.second;
}
