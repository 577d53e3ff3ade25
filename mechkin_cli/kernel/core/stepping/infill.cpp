// What the rows between two nodes get: quintic Hermite interpolation of values, first and second derivatives.
#include <cmath>

#include "stepping/orbit.hpp"
#include "stepping/row_curve.hpp"

// The turns of the loop behind it share no memory.
#if defined(__clang__)
#define MECHKIN_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define MECHKIN_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace {

// A value with its first and second derivative at both ends of a step h.
struct Ends {
  double from[3], to[3];
};

// Weights of the values and derivatives at both ends (0: from, 1: to) at parts t of a step of length 1, one row after the
// other for each weight.
class Hermite {
 public:
  Hermite(const Node& a, const Node& b, const double* place, long count) : count_(count), weight_(6 * count) {
    const double begin = a.place, step = b.place - a.place;
    double *const value0 = part(0), *const value1 = part(1), *const first0 = part(2), *const first1 = part(3),
           *const second0 = part(4), *const second1 = part(5);
    MECHKIN_INDEPENDENT
    for (long i = 0; i < count; ++i) {
      const double t = (place[i] - begin) / step, t2 = t * t, t3 = t2 * t;
      value0[i] = 1 - t3 * (10 - t * (15 - 6 * t)), first0[i] = t - t3 * (6 - t * (8 - 3 * t));
      second0[i] = 0.5 * t2 * (1 - t * (3 - t * (3 - t))), value1[i] = 1 - value0[i];
      first1[i] = -t3 * (4 - t * (7 - 3 * t)), second1[i] = 0.5 * t3 * (1 - t * (2 - t));
    }
  }
  void interpolate(double h, const Ends& e, double* out) const {
    const double *const value0 = part(0), *const value1 = part(1), *const first0 = part(2), *const first1 = part(3),
                 *const second0 = part(4), *const second1 = part(5);
    const Ends ends = e;
    MECHKIN_INDEPENDENT
    for (long i = 0; i < count_; ++i)
      out[i] = value0[i] * ends.from[0] + value1[i] * ends.to[0] +
               h * (first0[i] * ends.from[1] + first1[i] * ends.to[1]) +
               h * h * (second0[i] * ends.from[2] + second1[i] * ends.to[2]);
  }

 private:
  double* part(int k) { return weight_.data() + k * count_; }
  const double* part(int k) const { return weight_.data() + k * count_; }

  long count_;
  std::vector<double> weight_;
};

// The same orientation by the opposite quaternion.
void negate(Node* node, int slot) {
  for (std::vector<double>* values : {&node->turn, &node->turn_first, &node->turn_second})
    for (int i = slot; i < slot + 4; ++i) (*values)[i] = -(*values)[i];
}

}  // namespace

void infill(const Stepper& stepper, const Node& a, const Node& b, const double* place, long begin, long end,
            const RowGuesses& out, const Chosen* chosen) {
  const int states = stepper.plan().states;
  const double h = b.place - a.place;
  double distance = h;
  for (int s = 0; s < states; ++s) distance = std::fmax(distance, std::fabs(b.state[s] - a.state[s]));
  // a row nearer to a singular place than eight times its correction may have crossed it
  const double limit = std::fmin(stepper.limits().infill * distance, 0.125 * std::fmin(a.least, b.least));
  for (long row = begin; row < end; ++row) out.limit[row] = limit;
  const Hermite rows(a, b, place, end - begin);
  for (int s = 0; s < states; ++s)
    if (!chosen || chosen->state[s])
      rows.interpolate(h, {{a.state[s], a.state_first[s], a.state_second[s]},
                           {b.state[s], b.state_first[s], b.state_second[s]}},
                       out.guess + s * out.rows + begin);
  stepper.normalise_quaternions(out.guess + begin, out.rows, end - begin);
  if (!out.turn) return;
  for (const ClosingTurn& t : stepper.turns())
    for (int s = t.slot; s < t.slot + t.width; ++s)
      if (!chosen || chosen->slot[s])
        rows.interpolate(h, {{a.turn[s], a.turn_first[s], a.turn_second[s]},
                             {b.turn[s], b.turn_first[s], b.turn_second[s]}},
                         out.turn + s * out.rows + begin);
  for (const TreeTurn& t : stepper.tree_turns()) {
    if (chosen && !chosen->slot[t.slot]) continue;
    for (long row = begin; row < end; ++row) {
      double& state = out.guess[t.state * out.rows + row];
      const double whole = std::rint(state / FULL_TURN);
      state -= FULL_TURN * whole;
      out.turn[t.slot * out.rows + row] = a.turn[t.slot] + whole;
    }
  }
}

double stray(const Stepper& stepper, const Node& a, const Node& b, const double* place, long count,
             const double* inputs, long stride) {
  const Plan& plan = stepper.plan();
  const Hermite rows(a, b, place, count);
  std::vector<double> along(count);
  double worst = 0.0;
  for (int i = 0; i < plan.inputs; ++i) {
    const int c = plan.input_column[i];
    rows.interpolate(b.place - a.place,
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
  for (const TreeTurn& t : stepper.tree_turns()) node->turn[t.slot] = turn[t.slot];
  for (const ClosingTurn& t : stepper.turns()) {
    const int s = t.slot;
    if (t.width == 1) {
      node->turn[s] += FULL_TURN * std::rint((turn[s] - node->turn[s]) / FULL_TURN);
      continue;
    }
    double product = 0.0;
    for (int i = 0; i < 4; ++i) product += turn[s + i] * node->turn[s + i];
    if (product < 0.0) negate(node, s);
  }
}

namespace {

// The change of an angle over a step, from its first and second derivatives at both ends: the integral of the rate's
// cubic, wrong by h^5 / 720 of the fifth derivative. `bend`: the part that the second derivatives have in it.
struct Change {
  double whole, bend;
};
Change change_of(const Node& a, const Node& b, int slot) {
  const double h = b.place - a.place;
  const double bend = h * h / 12.0 * (a.turn_second[slot] - b.turn_second[slot]);
  return {0.5 * h * (a.turn_first[slot] + b.turn_first[slot]) + bend, bend};
}

}  // namespace

// An angle goes on where the integral of its rate says. Whole turns are sure where that integral misses the angle by
// little and hardly depends on the rate's derivatives; else the integrals over both halves of the step have to agree
// with it. A quaternion's sign is that of its prediction.
bool continue_turns(Stepper& stepper, const Node& a, Node* b) {
  const StepLimits& limits = stepper.limits();
  const double h = b->place - a.place;
  Node middle;
  bool sure = true, halved = false;
  for (const TreeTurn& t : stepper.tree_turns()) b->turn[t.slot] = a.turn[t.slot];
  for (const ClosingTurn& t : stepper.turns()) {
    const int s = t.slot;
    if (t.width == 1) {
      Change change = change_of(a, *b, s);
      if (std::fabs(change.bend) > limits.angle_bend) {
        halved = halved || stepper.close_middle(a, *b, &middle);
        sure = sure && halved;
        if (halved) {
          const double halves = change_of(a, middle, s).whole + change_of(middle, *b, s).whole;
          sure = sure && std::fabs(halves - change.whole) <= limits.angle_bend;
          change.whole = halves;
        }
      }
      const double ahead = a.turn[s] + change.whole;
      b->turn[s] += FULL_TURN * std::rint((ahead - b->turn[s]) / FULL_TURN);
      sure = sure && std::fabs(b->turn[s] - ahead) <= limits.angle_miss;
      continue;
    }
    double product = 0.0, square = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double ahead = a.turn[s + i] + h * a.turn_first[s + i] + 0.5 * h * h * a.turn_second[s + i];
      product += ahead * b->turn[s + i], square += ahead * ahead;
    }
    if (product < 0.0) negate(b, s);
    // the cosine of half the angle by which the prediction missed; a sign needs no more than a quarter of a turn
    sure = sure && std::fabs(product) >= 0.875 * std::sqrt(square);
  }
  return sure;
}
