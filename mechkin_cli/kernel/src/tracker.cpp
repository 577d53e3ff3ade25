#include "tracker.hpp"

#include <cmath>
#include <cstring>

namespace {

// Runs single positions on the narrowest unit, whose latency is the least.
class Stepper {
 public:
  Stepper(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, const TrackLimits& limits)
      : plan_(plan), unit_(unit), x0_(x0), u_(u), limits_(limits), memory_(unit.workspace_size(plan)),
        inputs_(plan.inputs), zeros_(plan.inputs, 0.0) {
    for (int b = 0; b < plan.blocks; ++b) {
      entries_ += plan.block[b].rows * plan.block[b].size;
      overconstrained_ = overconstrained_ || plan.block[b].rows > plan.block[b].size;
    }
  }

  // Whether no overconstrained block passed a singular place between two nodes: det(A^T B) of its Jacobians there
  // changes its sign where one direction of the unknowns loses its equations and gets them back reversed. (Square
  // blocks have the sign of their determinant.)
  bool same_side(const Node& a, const Node& b) const {
    if (!overconstrained_) return true;
    const double *one = a.jacobian.data(), *other = b.jacobian.data();
    for (int k = 0; k < plan_.blocks; ++k) {
      const int m = plan_.block[k].rows, n = plan_.block[k].size;
      if (m > n && !(product_determinant(one, other, m, n) > 0.0)) return false;
      one += m * n, other += m * n;
    }
    return true;
  }

  // Closes the loops at sigma from a guess; false if they do not close.
  bool close(double sigma, const double* guess, Node* node, double* correction) {
    for (int i = 0; i < plan_.inputs; ++i) inputs_[i] = x0_[i] + sigma * u_[i];
    node->sigma = sigma;
    node->state.resize(plan_.states);
    node->first.resize(plan_.columns);
    node->second.resize(plan_.columns);
    node->jacobian.resize(entries_);
    double residual = 0;
    unsigned char flags = 0;
    Request r = {};
    r.rows = 1;
    r.inputs = inputs_.data(), r.rates = u_, r.accelerations = zeros_.data();
    r.guess = guess;
    r.states = node->state.data();
    r.velocities = node->first.data(), r.second = node->second.data();
    r.residual = &residual, r.correction = correction, r.orientation = &node->orientation;
    r.jacobian = overconstrained_ ? node->jacobian.data() : nullptr;
    r.pivot = &node->pivot, r.flags = &flags;
    r.demand = DEMAND_VELOCITY | DEMAND_ACCELERATION;
    r.iterations = limits_.iterations;
    r.tight = limits_.tight, r.coarse = limits_.coarse, r.accept = limits_.accept;
    unit_.run(plan_, r, memory_.data());
    if (flags != 0) return false;
    for (double d : node->first) if (!std::isfinite(d)) return false;
    for (double d : node->second) if (!std::isfinite(d)) return false;
    differentiate_states(node);
    return true;
  }

  // Second-order prediction of the states a step h away.
  void predict(const Node& n, double h, std::vector<double>* guess) const {
    guess->resize(plan_.states);
    for (int s = 0; s < plan_.states; ++s)
      (*guess)[s] = n.state[s] + h * n.state_first[s] + 0.5 * h * h * n.state_second[s];
    normalise_quaternions(guess->data(), 1);
  }

  void normalise_quaternions(double* state, long stride) const {
    for (int k = 0; k < plan_.links; ++k) {
      if (plan_.joints[k].type != TREE_S) continue;
      double* q = state + plan_.joints[k].state * stride;
      const double n = std::sqrt(q[0] * q[0] + q[stride] * q[stride] + q[2 * stride] * q[2 * stride] +
                                 q[3 * stride] * q[3 * stride]);
      for (int i = 0; i < 4; ++i) q[i * stride] /= n;
    }
  }

 private:
  // d/dsigma of the raw states: q' = w q / 2, q'' = w' q / 2 + w w q / 4 for a quaternion q whose columns
  // w are a rotation rate about the parent's axes.
  void differentiate_states(Node* n) const {
    n->state_first.assign(plan_.states, 0.0);
    n->state_second.assign(plan_.states, 0.0);
    for (int k = 0; k < plan_.links; ++k) {
      const TreeJoint& j = plan_.joints[k];
      const double *first = n->first.data() + j.column, *second = n->second.data() + j.column;
      if (j.type != TREE_S) {
        const int freedoms = unit_.tree_types[j.type].freedoms;
        for (int f = 0; f < freedoms; ++f) {
          n->state_first[j.state + f] = first[f];
          n->state_second[j.state + f] = second[f];
        }
        continue;
      }
      const double* q = &n->state[j.state];
      const double square = first[0] * first[0] + first[1] * first[1] + first[2] * first[2];
      half_product(first, q, &n->state_first[j.state]);
      half_product(second, q, &n->state_second[j.state]);
      for (int i = 0; i < 4; ++i) n->state_second[j.state + i] -= 0.25 * square * q[i];
    }
  }
  static void half_product(const double* w, const double* q, double* out) {
    out[0] = 0.5 * (-w[0] * q[1] - w[1] * q[2] - w[2] * q[3]);
    out[1] = 0.5 * (w[0] * q[0] + w[1] * q[3] - w[2] * q[2]);
    out[2] = 0.5 * (-w[0] * q[3] + w[1] * q[0] + w[2] * q[1]);
    out[3] = 0.5 * (w[0] * q[2] - w[1] * q[1] + w[2] * q[0]);
  }

  // det(A^T B) of two m x n matrices, by elimination with row exchanges.
  static double product_determinant(const double* a, const double* b, int m, int n) {
    std::vector<double> c(n * n, 0.0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < m; ++k) c[i * n + j] += a[k * n + i] * b[k * n + j];
    double determinant = 1.0;
    for (int k = 0; k < n; ++k) {
      int best = k;
      for (int i = k + 1; i < n; ++i)
        if (std::fabs(c[i * n + k]) > std::fabs(c[best * n + k])) best = i;
      if (best != k) {
        for (int j = 0; j < n; ++j) std::swap(c[k * n + j], c[best * n + j]);
        determinant = -determinant;
      }
      determinant *= c[k * n + k];
      for (int i = k + 1; i < n; ++i) {
        const double f = c[i * n + k] / c[k * n + k];
        for (int j = k; j < n; ++j) c[i * n + j] -= f * c[k * n + j];
      }
    }
    return determinant;
  }

  const Plan& plan_;
  const KernelUnit& unit_;
  const double *x0_, *u_;
  const TrackLimits& limits_;
  std::vector<char> memory_;
  std::vector<double> inputs_, zeros_;
  long entries_ = 0;
  bool overconstrained_ = false;
};

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double s = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) s += a[i] * b[i];
  return s;
}

// The inputs are columns too, so the first derivatives hold the whole tangent of the branch.
double wanted_step(const Node& n, const TrackLimits& limits) {
  const double t2 = product(n.first, n.first), b2 = product(n.second, n.second);
  if (b2 == 0.0) return limits.longest_step;
  const double along = product(n.first, n.second);
  const double across = std::sqrt(std::fmax(b2 - along * along / t2, 0.0));
  const double by_bend = limits.bend * std::sqrt(t2 / b2);
  const double by_turn = across > 0.0 ? limits.turn * std::sqrt(t2) / across : HUGE_VAL;
  return std::fmin(limits.longest_step, std::fmin(by_bend, by_turn));
}

bool turned_too_far(const Node& a, const Node& b, const TrackLimits& limits) {
  const double cosine = product(a.first, b.first) / std::sqrt(product(a.first, a.first) * product(b.first, b.first));
  return !(cosine >= limits.turn_cosine);
}

// Prediction of a from b: a place on another branch does not look back at where it was predicted from.
bool looks_back(const Stepper& stepper, const Node& a, const Node& b, double tolerance) {
  std::vector<double> back;
  stepper.predict(b, a.sigma - b.sigma, &back);
  for (std::size_t s = 0; s < back.size(); ++s)
    if (!(std::fabs(back[s] - a.state[s]) <= tolerance)) return false;
  return true;
}

// Guesses for the rows from `row` on that lie between two nodes; returns the first row beyond.
long infill(const Plan& plan, const Stepper& stepper, const Node& a, const Node& b, long rows, const double* sigma,
            long row, double share, double* guess, double* limit) {
  const double h = b.sigma - a.sigma;
  double distance = h;
  for (int s = 0; s < plan.states; ++s) distance = std::fmax(distance, std::fabs(b.state[s] - a.state[s]));
  for (; row < rows && sigma[row] <= b.sigma; ++row) {
    const double t = (sigma[row] - a.sigma) / h, t2 = t * t, t3 = t2 * t;
    // quintic Hermite basis (values, first and second derivatives at both ends)
    const double h0 = 1 - t3 * (10 - t * (15 - 6 * t)), h1 = t - t3 * (6 - t * (8 - 3 * t)),
                 h2 = 0.5 * t2 * (1 - t * (3 - t * (3 - t))), g0 = 1 - h0,
                 g1 = -t3 * (4 - t * (7 - 3 * t)), g2 = 0.5 * t3 * (1 - t * (2 - t));
    for (int s = 0; s < plan.states; ++s)
      guess[s * rows + row] = h0 * a.state[s] + g0 * b.state[s] + h * (h1 * a.state_first[s] + g1 * b.state_first[s]) +
                              h * h * (h2 * a.state_second[s] + g2 * b.state_second[s]);
    stepper.normalise_quaternions(guess + row, rows);
    limit[row] = share * distance;
  }
  return row;
}

}  // namespace

Track follow(const Plan& plan, const KernelUnit& unit, const double* x0, const double* u, long rows,
             const double* sigma, const double* start, const TrackLimits& limits, double* guess,
             double* limit) {
  Stepper stepper(plan, unit, x0, u, limits);
  Track track = {TrackEnd::finished, 0, 0, 0, {}, 0.0};
  Node node, next;
  std::vector<double> predicted;
  double correction = 0.0;
  if (!stepper.close(0.0, start, &node, &correction)) {
    track.end = TrackEnd::start_not_closed;
    return track;
  }
  long row = 0;
  for (; row < rows && sigma[row] <= 0.0; ++row) {
    for (int s = 0; s < plan.states; ++s) guess[s * rows + row] = node.state[s];
    limit[row] = limits.jump;
  }
  const double end = rows ? sigma[rows - 1] : 0.0;
  double h = wanted_step(node, limits);
  while (node.sigma < end) {
    if (track.steps + track.rejected >= limits.most_steps) {
      track.end = TrackEnd::exhausted;
      break;
    }
    const double least = limits.least_step * std::fmax(1.0, std::fabs(node.sigma));
    // the last step ends exactly on the last row
    const bool last = node.sigma + 1.000001 * h >= end;
    const double step = last ? end - node.sigma : h;
    if (!last && step < least) {
      track.end = TrackEnd::stalled;
      track.refused_step = step;
      break;
    }
    stepper.predict(node, step, &predicted);
    const double length = step * std::sqrt(product(node.first, node.first));
    const bool good = stepper.close(last ? end : node.sigma + step, predicted.data(), &next, &correction) &&
                      correction <= limits.jump * length && next.orientation == node.orientation &&
                      next.pivot >= limits.pivot && stepper.same_side(node, next) &&
                      !turned_too_far(node, next, limits) &&
                      looks_back(stepper, node, next, limits.jump * length);
    if (!good) {
      ++track.rejected;
      h = 0.5 * step;
      if (h < least) {
        track.end = TrackEnd::stalled;
        track.refused_step = step;
        break;
      }
      continue;
    }
    ++track.steps;
    row = infill(plan, stepper, node, next, rows, sigma, row, limits.infill, guess, limit);
    h = std::fmin(wanted_step(next, limits), 4.0 * step);
    std::swap(node, next);
  }
  track.reached = row;
  track.last = node;
  return track;
}
