// What the rows between two nodes get: quintic Hermite interpolation of values, first and second derivatives.
#include <algorithm>
#include <cmath>

#include "rows/units.hpp"
#include "stepping/orbit.hpp"
#include "stepping/row_curve.hpp"

namespace {

// Columns of the rows between two nodes, which the widest unit interpolates some at a time.
class RowsBetween {
 public:
  RowsBetween(const Node& a, const Node& b, const double* place, long rows)
      : curve_{a.place, b.place - a.place, rows, place, 0, ends_, out_, whole_, counted_} {}
  RowsBetween(const RowsBetween&) = delete;
  // A value with its first and second derivative at both nodes; `out`: rows. `whole`, `counted`: as in Hermite.
  void add(double value0, double first0, double second0, double value1, double first1, double second1, double* out,
           double* whole = nullptr, double counted = 0.0) {
    if (curve_.columns == MOST_COLUMNS) interpolate();
    const int k = curve_.columns++;
    double* const ends = ends_ + 6 * k;
    ends[0] = value0, ends[1] = first0, ends[2] = second0, ends[3] = value1, ends[4] = first1, ends[5] = second1;
    out_[k] = out, whole_[k] = whole, counted_[k] = counted;
  }
  // What was added since the last time.
  void interpolate() {
    if (curve_.columns) kernel_unit()->interpolate(curve_);
    curve_.columns = 0;
  }

 private:
  static constexpr int MOST_COLUMNS = 16;

  double ends_[6 * MOST_COLUMNS], counted_[MOST_COLUMNS];
  double *out_[MOST_COLUMNS], *whole_[MOST_COLUMNS];
  Hermite curve_;
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
  double distance = b.place - a.place;
  for (int s = 0; s < states; ++s) distance = greater(distance, std::fabs(b.state[s] - a.state[s]));
  // a row nearer to a singular place than eight times its correction may have crossed it
  const double limit = std::fmin(stepper.limits().infill * distance, 0.125 * std::fmin(a.least, b.least));
  std::fill(out.limit + begin, out.limit + end, limit);
  if (begin == end) return;
  RowsBetween rows(a, b, place, end - begin);
  for (int s = 0; s < states; ++s) {
    if (chosen && !chosen->state[s]) continue;
    const int slot = out.turn ? stepper.turn_of_state()[s] : -1;
    rows.add(a.state[s], a.state_first[s], a.state_second[s], b.state[s], b.state_first[s], b.state_second[s],
             out.guess + s * out.rows + begin, slot < 0 ? nullptr : out.turn + slot * out.rows + begin,
             slot < 0 ? 0.0 : a.turn[slot]);
  }
  for (const ClosingTurn& t : stepper.turns())
    for (int s = t.slot; out.turn && s < t.slot + t.width; ++s)
      if (!chosen || chosen->slot[s])
        rows.add(a.turn[s], a.turn_first[s], a.turn_second[s], b.turn[s], b.turn_first[s], b.turn_second[s],
                 out.turn + s * out.rows + begin);
  rows.interpolate();
  stepper.normalise_quaternions(out.guess + begin, out.rows, end - begin);
}

double stray(const Stepper& stepper, const Node& a, const Node& b, const double* place, long count,
             const double* inputs, long stride) {
  const Plan& plan = stepper.plan();
  std::vector<double> along(plan.inputs * count);
  RowsBetween rows(a, b, place, count);
  for (int i = 0; i < plan.inputs; ++i) {
    const int c = plan.input_column[i];
    rows.add(a.inputs[i], a.first[c], a.second[c], b.inputs[i], b.first[c], b.second[c], &along[i * count]);
  }
  rows.interpolate();
  double worst = 0.0;
  for (int i = 0; i < plan.inputs; ++i)
    for (long k = 0; k < count; ++k) worst = greater(worst, std::fabs(along[i * count + k] - inputs[i * stride + k]));
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
