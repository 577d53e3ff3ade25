// What the rows between two nodes get: quintic Hermite interpolation of values, first and second derivatives.
#include <algorithm>
#include <cmath>

#include "rows/units.hpp"
#include "stepping/orbit.hpp"
#include "stepping/row_curve.hpp"

namespace {

// What the quintic polynomial through the nodes' values misses at the node before them, where three of these tell it
// well; see Hermite.
class ThirdNode {
 public:
  // `place`: in parts of the step.
  explicit ThirdNode(double place) : place_(place) {
    const double t = place, t2 = t * t, t3 = t2 * t, left = 1.0 - t;
    value_[0] = 1.0 - t3 * (10.0 - t * (15.0 - 6.0 * t)), value_[3] = 1.0 - value_[0];
    value_[1] = t - t3 * (6.0 - t * (8.0 - 3.0 * t)), value_[4] = -t3 * (4.0 - t * (7.0 - 3.0 * t));
    value_[2] = 0.5 * t2 * (1.0 - t * (3.0 - t * (3.0 - t))), value_[5] = 0.5 * t3 * (1.0 - t * (2.0 - t));
    first_[3] = 30.0 * t2 * left * left, first_[0] = -first_[3];
    first_[1] = 1.0 - t2 * (18.0 - t * (32.0 - 15.0 * t)), first_[4] = -t2 * (12.0 - t * (28.0 - 15.0 * t));
    first_[2] = t * (1.0 - t * (4.5 - t * (6.0 - 2.5 * t))), first_[5] = t2 * (1.5 - t * (4.0 - 2.5 * t));
    second_[3] = 60.0 * t * left * (1.0 - 2.0 * t), second_[0] = -second_[3];
    second_[1] = -t * (36.0 - t * (96.0 - 60.0 * t)), second_[4] = -t * (24.0 - t * (84.0 - 60.0 * t));
    second_[2] = 1.0 - t * (9.0 - t * (18.0 - 10.0 * t)), second_[5] = t * (3.0 - t * (12.0 - 10.0 * t));
    // t^3 (1 - t)^3 and its derivatives
    both_ = t3 * left * left * left, both_first_ = 3.0 * t2 * left * left * (1.0 - 2.0 * t);
    both_second_ = 6.0 * t * left * (1.0 - 5.0 * t + 5.0 * t2);
    inverse_ = 1.0 / both_;
  }
  double place() const { return place_; }
  // `ends`: as in Hermite; value, first and second derivative at the third node; all by the step as unit.
  void find(const double* ends, double h, double value, double first, double second, double* rest) const {
    const double unit[6] = {ends[0], h * ends[1], h * h * ends[2], ends[3], h * ends[4], h * h * ends[5]};
    value -= sum(value_, unit), first = h * first - sum(first_, unit), second = h * h * second - sum(second_, unit);
    rest[0] = value * inverse_, rest[1] = (first - both_first_ * rest[0]) * inverse_;
    rest[2] = 0.5 * (second - both_second_ * rest[0] - 2.0 * both_first_ * rest[1]) * inverse_;
  }

 private:
  static double sum(const double* weight, const double* unit) {
    double found = 0.0;
    for (int k = 0; k < 6; ++k) found += weight[k] * unit[k];
    return found;
  }

  double place_, value_[6], first_[6], second_[6], both_, both_first_, both_second_, inverse_;
};
// Where that node must stand, in parts of the step before it: nearer ones tell rounding, farther ones another curve.
constexpr double NEAREST_THIRD = 0.4, FARTHEST_THIRD = 2.5;

// Columns of the rows between two nodes, which the widest unit interpolates some at a time.
class RowsBetween {
 public:
  RowsBetween(const Node& a, const Node& b, const double* place, long rows)
      : curve_{a.place, b.place - a.place, rows, place, 0, ends_, out_, whole_, counted_, nullptr, 0.0} {}
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
  // The last one added meets the node before these, too: each of a round does, or none.
  void add(const ThirdNode& third, double value, double first, double second) {
    const int k = curve_.columns - 1;
    third.find(ends_ + 6 * k, curve_.step, value, first, second, rest_ + 3 * k);
    curve_.rest = rest_, curve_.third = third.place();
  }
  // What was added since the last time.
  void interpolate() {
    if (curve_.columns) kernel_unit()->interpolate(curve_);
    curve_.columns = 0, curve_.rest = nullptr;
  }

 private:
  static constexpr int MOST_COLUMNS = 16;

  double ends_[6 * MOST_COLUMNS], counted_[MOST_COLUMNS], rest_[3 * MOST_COLUMNS];
  double *out_[MOST_COLUMNS], *whole_[MOST_COLUMNS];
  Hermite curve_;
};

// The same orientation by the opposite quaternion.
void negate(Node* node, int slot) {
  for (Node::Few* values : {&node->turn, &node->turn_first, &node->turn_second})
    for (int i = slot; i < slot + 4; ++i) (*values)[i] = -(*values)[i];
}

}  // namespace

void infill(const Stepper& stepper, const Node& a, const Node& b, const double* place, long begin, long end,
            const RowGuesses& out, const Chosen* chosen, const Node* before) {
  const int states = stepper.plan().states;
  double distance = b.place - a.place;
  for (int s = 0; s < states; ++s) distance = greater(distance, std::fabs(b.state[s] - a.state[s]));
  // a row nearer to a singular place than eight times its correction may have crossed it
  const double limit = std::fmin(stepper.limits().infill * distance, 0.125 * std::fmin(a.least, b.least));
  std::fill(out.limit + begin, out.limit + end, limit);
  if (begin == end) return;
  RowsBetween rows(a, b, place, end - begin);
  const double way = before ? (a.place - before->place) / (b.place - a.place) : 0.0;
  const bool is_told = way >= NEAREST_THIRD && way <= FARTHEST_THIRD;
  const ThirdNode third(is_told ? -way : -1.0);
  for (int s = 0; s < states; ++s) {
    if (chosen && !chosen->state[s]) continue;
    const int slot = out.turn ? stepper.turn_of_state()[s] : -1;
    rows.add(a.state[s], a.state_first[s], a.state_second[s], b.state[s], b.state_first[s], b.state_second[s],
             out.guess + s * out.rows + begin, slot < 0 ? nullptr : out.turn + slot * out.rows + begin,
             slot < 0 ? 0.0 : a.turn[slot]);
    if (!is_told) continue;
    // angles that were reduced in between
    const double turned = slot < 0 ? 0.0 : FULL_TURN * (before->turn[slot] - a.turn[slot]);
    rows.add(third, before->state[s] + turned, before->state_first[s], before->state_second[s]);
  }
  rows.interpolate();
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
