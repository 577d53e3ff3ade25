// What the rows between two nodes get: quintic Hermite interpolation of values, first and second derivatives.
#include <cmath>

#include "tracker.hpp"

namespace {

// Weights of the values and derivatives at both ends (0: from, 1: to) at a part t of a step of length 1.
struct Hermite {
  double value0, value1, first0, first1, second0, second1;
  explicit Hermite(double t) {
    const double t2 = t * t, t3 = t2 * t;
    value0 = 1 - t3 * (10 - t * (15 - 6 * t)), first0 = t - t3 * (6 - t * (8 - 3 * t));
    second0 = 0.5 * t2 * (1 - t * (3 - t * (3 - t))), value1 = 1 - value0;
    first1 = -t3 * (4 - t * (7 - 3 * t)), second1 = 0.5 * t3 * (1 - t * (2 - t));
  }
};

// A value with its first and second derivative at both ends of a step h, for all rows between.
struct Ends {
  double from[3], to[3];
};
void interpolate(const std::vector<Hermite>& weights, double h, const Ends& e, double* out) {
  const std::size_t count = weights.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Hermite& w = weights[i];
    out[i] = w.value0 * e.from[0] + w.value1 * e.to[0] + h * (w.first0 * e.from[1] + w.first1 * e.to[1]) +
             h * h * (w.second0 * e.from[2] + w.second1 * e.to[2]);
  }
}

std::vector<Hermite> weights_of(const Node& a, const Node& b, const double* place, long count) {
  std::vector<Hermite> weights;
  weights.reserve(count);
  for (long i = 0; i < count; ++i) weights.emplace_back((place[i] - a.place) / (b.place - a.place));
  return weights;
}

constexpr double HALF_TURN = 3.14159265358979323846;

// The same orientation by the opposite quaternion.
void negate(Node* node, int slot) {
  for (std::vector<double>* values : {&node->turn, &node->turn_first, &node->turn_second})
    for (int i = slot; i < slot + 4; ++i) (*values)[i] = -(*values)[i];
}

}  // namespace

void infill(const Stepper& stepper, const Node& a, const Node& b, const double* place, long begin, long end,
            const RowGuesses& out) {
  const int states = stepper.plan().states;
  const double h = b.place - a.place;
  double distance = h;
  for (int s = 0; s < states; ++s) distance = std::fmax(distance, std::fabs(b.state[s] - a.state[s]));
  for (long row = begin; row < end; ++row) out.limit[row] = stepper.limits().infill * distance;
  const std::vector<Hermite> weights = weights_of(a, b, place, end - begin);
  for (int s = 0; s < states; ++s)
    interpolate(weights, h, {{a.state[s], a.state_first[s], a.state_second[s]},
                             {b.state[s], b.state_first[s], b.state_second[s]}},
                out.guess + s * out.rows + begin);
  for (long row = begin; row < end; ++row) stepper.normalise_quaternions(out.guess + row, out.rows);
  if (!out.turn) return;
  for (int s = 0; s < stepper.turn_slots(); ++s)
    interpolate(weights, h, {{a.turn[s], a.turn_first[s], a.turn_second[s]},
                             {b.turn[s], b.turn_first[s], b.turn_second[s]}},
                out.turn + s * out.rows + begin);
}

double stray(const Stepper& stepper, const Node& a, const Node& b, const double* place, long count,
             const double* inputs, long stride) {
  const Plan& plan = stepper.plan();
  const std::vector<Hermite> weights = weights_of(a, b, place, count);
  std::vector<double> along(count);
  double worst = 0.0;
  for (int i = 0; i < plan.inputs; ++i) {
    const int c = plan.input_column[i];
    interpolate(weights, b.place - a.place,
                {{a.inputs[i], a.first[c], a.second[c]}, {b.inputs[i], b.first[c], b.second[c]}}, along.data());
    for (long k = 0; k < count; ++k) worst = std::fmax(worst, std::fabs(along[k] - inputs[i * stride + k]));
  }
  return worst;
}

void put_row(const Node& node, double limit, long row, const RowGuesses& out) {
  for (std::size_t s = 0; s < node.state.size(); ++s) out.guess[s * out.rows + row] = node.state[s];
  out.limit[row] = limit;
  if (!out.turn) return;
  for (std::size_t s = 0; s < node.turn.size(); ++s) out.turn[s * out.rows + row] = node.turn[s];
}

void adopt_turns(const Stepper& stepper, const std::vector<double>& turn, Node* node) {
  for (const ClosingTurn& t : stepper.turns()) {
    const int s = t.slot;
    if (t.width == 1) {
      node->turn[s] += 2.0 * HALF_TURN * std::rint((turn[s] - node->turn[s]) / (2.0 * HALF_TURN));
      continue;
    }
    double product = 0.0;
    for (int i = 0; i < 4; ++i) product += turn[s + i] * node->turn[s + i];
    if (product < 0.0) negate(node, s);
  }
}

// An angle's change over a step follows from its first and second derivatives at both ends (the integral of their
// Hermite polynomial, wrong by h^5 / 720 of the fifth derivative); a quaternion's sign from its prediction.
bool continue_turns(const Stepper& stepper, const Node& a, Node* b) {
  const double h = b->place - a.place, most = stepper.limits().angle_miss;
  bool sure = true;
  for (const ClosingTurn& t : stepper.turns()) {
    const int s = t.slot;
    if (t.width == 1) {
      const double ahead = a.turn[s] + 0.5 * h * (a.turn_first[s] + b->turn_first[s]) +
                           h * h / 12.0 * (a.turn_second[s] - b->turn_second[s]);
      b->turn[s] += 2.0 * HALF_TURN * std::rint((ahead - b->turn[s]) / (2.0 * HALF_TURN));
      sure = sure && std::fabs(b->turn[s] - ahead) <= most;
      continue;
    }
    double product = 0.0, square = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double ahead = a.turn[s + i] + h * a.turn_first[s + i] + 0.5 * h * h * a.turn_second[s + i];
      product += ahead * b->turn[s + i], square += ahead * ahead;
    }
    if (product < 0.0) negate(b, s);
    // the cosine of half the angle by which the prediction missed
    sure = sure && std::fabs(product) >= (1.0 - 0.125 * most * most) * std::sqrt(square);
  }
  return sure;
}
