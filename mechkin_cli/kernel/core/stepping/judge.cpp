// Whether two nodes of a path lie on one branch.
//
// A branch is lost where a block's Jacobian passes a singular one unseen. Both ends of a step and its middle are
// looked at: where the spectral radius of J_a^+ J_b - I is below 1, no matrix of the straight segment from J_a to J_b
// is singular. The radius changes neither with units, nor with the order or merging of blocks; a sign of a determinant
// comes back where two factors change together. What is shown is a segment of matrices, not the true path
// (docs/numerics.md).
#include <algorithm>
#include <cmath>

#include "stepping/stepper.hpp"

namespace {

// Least singular value of a block below which it makes those that hang on it wrong by more than their own rounding.
constexpr double NARROW = 1e-3;

}  // namespace

bool is_regular_segment(const Factored& a, const Matrix& middle, const Factored& b, double limit, double* danger,
                        double* least) {
  const LeastSquares &from = a.squares, &to = b.squares;
  *least = lesser(*least, to.least_singular_bound());
  *danger = to.change_bound(a.matrix);
  if (!(*danger <= limit) && !to.change_within(a.matrix, limit) && !from.change_within(b.matrix, limit)) return false;
  return from.change_within(middle, limit) && to.change_within(middle, limit);
}

Matrix Stepper::block_matrix(const double* jacobian, int block) const {
  const long at = plan_.block[block].full_at;
  Matrix matrix(plan_.block[block].rows, plan_.block[block].size);
  std::copy_n(jacobian + at, matrix.a.size(), matrix.a.begin());
  return matrix;
}

bool Stepper::is_regular_band(int block, const double* from, const double* middle, const double* to, double* danger,
                              double* least) {
  if (band_room_.empty()) band_room_.resize(unit_.band_room(plan_));
  const long at = plan_.block[block].full_at;
  BandStep step = {from + at, middle + at, to + at, limits_.radius, false, 0.0, 0.0};
  unit_.judge_band_step(plan_, block, &step, band_room_.data());
  *danger = step.danger, *least = std::fmin(*least, step.least);
  return step.is_regular;
}

void Stepper::middle(const Node& a, const Node& b, std::vector<double>* state) const {
  const double h = b.place - a.place;
  state->resize(plan_.states);
  for (int s = 0; s < plan_.states; ++s)
    (*state)[s] = 0.5 * (a.state[s] + b.state[s]) + 5.0 / 32.0 * h * (a.state_first[s] - b.state_first[s]) +
                  h * h / 64.0 * (a.state_second[s] + b.state_second[s]);
  normalise_quaternions(state->data(), 1);
}

const std::vector<Factored>& Stepper::factors(const Node& node) const {
  for (int k = (int)node.factored.size(); k < plan_.blocks; ++k)
    node.factored.emplace_back(has_band(k) ? Matrix() : block_matrix(node.jacobian.data(), k));
  return node.factored;
}

bool Stepper::same_side(const Node& a, Node* b) {
  const double half = a.sigma + 0.5 * (b->sigma - a.sigma);
  middle(a, *b, &guess_);
  const Plan& plan = path_.plan(half);
  path_.at(half, &point_);
  half_way_.resize(entries_);
  double residual = 0.0, correction = 0.0;
  unsigned char flags = 0;
  Request r = {};
  r.rows = 1, r.inputs = point_.inputs.data(), r.guess = guess_.data();
  r.residual = &residual, r.correction = &correction, r.flags = &flags;
  r.jacobian = half_way_.data(), r.demand = DEMAND_JACOBIAN;
  unit_.run_row(plan, r, memory_.data());
  return same_side(a, b, half_way_.data());
}

bool Stepper::same_side(const Node& a, Node* b, const double* half_way) {
  const double h = b->place - a.place;
  const std::vector<Factored>&from = factors(a), &to = factors(*b);
  bool same = true;
  b->least = HUGE_VAL;
  for (int k = 0; k < plan_.blocks; ++k) {
    double danger = 0.0;
    same = (has_band(k) ? is_regular_band(k, a.jacobian.data(), half_way, b->jacobian.data(), &danger, &b->singular[k])
                        : is_regular_segment(from[k], block_matrix(half_way, k), to[k], limits_.radius, &danger,
                                             &b->singular[k])) && same;
    b->danger[k] = danger / std::fabs(h), b->least = lesser(b->least, b->singular[k]);
  }
  return same;
}

bool Stepper::turned_too_far(const Node& a, const Node& b) const {
  const double cosine = tangent_product(a, b) / std::sqrt(tangent_product(a, a) * tangent_product(b, b));
  return !(cosine >= limits_.turn_cosine);
}

// Prediction of a from b: a place on another branch does not look back at where it was predicted from.
bool Stepper::looks_back(const Node& a, const Node& b, double tolerance) {
  predict(b, a.place - b.place, &back_);
  for (int s = 0; s < plan_.states; ++s)
    if (!(std::fabs(back_[s] - a.state[s]) <= tolerance)) return false;
  return true;
}

// Whether rounding leaves a node on its branch: pivots of a triangle may hide that it is singular, and the unknowns of a
// block are as wrong as those that it hangs on make them.
bool Stepper::is_told(const Node& node) {
  const double square = limits_.pivot * limits_.pivot;
  for (double s : node.singular)
    if (!(s >= limits_.pivot)) return false;
  if (node.least * node.least * node.least >= square) return true;
  if (upstream_.empty()) upstream_ = upstream_blocks(plan_, unit_);
  for (int k = 0; k < plan_.blocks; ++k) {
    double product = node.singular[k] * node.singular[k];
    for (int other = 0; other < plan_.blocks; ++other)
      if (upstream_[k * plan_.blocks + other] && node.singular[other] < NARROW) product *= node.singular[other];
    if (!(product >= square)) return false;
  }
  return true;
}

bool Stepper::judge(const Node& a, Node* b) { return judge_by(a, b, nullptr); }

bool Stepper::judge_by(const Node& a, Node* b, const double* half_way) {
  const double length = std::fabs(b->place - a.place) * std::sqrt(tangent_product(a, a));
  if (!(b->correction <= limits_.jump * length)) return false;
  for (double p : b->pivot)
    if (!(p >= limits_.pivot)) return false;
  return !turned_too_far(a, *b) && looks_back(a, *b, limits_.jump * length) &&
         (half_way ? same_side(a, b, half_way) : same_side(a, b)) && is_told(*b);
}

// What the prediction of a step from a to b would have had to be corrected by.
double Stepper::missed(const Node& a, const Node& b) {
  predict(a, b.place - a.place, &ahead_);
  double most = 0.0;
  for (int k = 0; k < plan_.links; ++k) {
    const TreeJoint& j = plan_.joints[k];
    const TreeType& type = unit_.tree_types[j.type];
    // a quaternion's numbers change by half the angle
    const double part = type.states == type.freedoms ? 1.0 : 2.0;
    for (int s = j.state; s < j.state + type.states; ++s) {
      const double miss = part * std::fabs(b.state[s] - ahead_[s]);
      if (!(miss <= most)) most = miss;  // what is no number wins
    }
  }
  return most;
}

bool Stepper::judge_ahead(const Node& a, NodesAhead* ahead) {
  Node* const b = ahead->node[ahead->next];
  b->correction = missed(a, *b);
  return judge_by(a, b, ahead->half_way.data() + ahead->next * entries_);
}
