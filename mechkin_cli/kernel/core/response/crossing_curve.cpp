#include "response/crossing_curve.hpp"

#include <algorithm>
#include <cmath>

namespace {

// cos((2 k + 1) pi / 32) and sin of it: nodes over -1 ... 1 with their barycentric weights; none is near the middle.
constexpr int HALF = 8, NODES = 2 * HALF;
constexpr double NODE[HALF] = {0.99518472667219693, 0.95694033573220886, 0.88192126434835503, 0.77301045336273696,
                               0.63439328416364549, 0.47139673682599764, 0.29028467725446236, 0.098017140329560604};
constexpr double SINE[HALF] = {0.098017140329560604, 0.29028467725446236, 0.47139673682599764, 0.63439328416364549,
                               0.77301045336273696, 0.88192126434835503, 0.95694033573220886, 0.99518472667219693};
// Places between nodes at which the polynomial is compared, in parts of the width.
constexpr double BETWEEN[6] = {-0.92, -0.7, -0.2, 0.2, 0.7, 0.92};

// A branch point is looked at from this far (rad, parts of the size), and from the least distance at which the closed
// places before it are known to a hundredth of theirs.
constexpr double FARTHEST_PLACE = 0.25, NEAREST_PLACE = 1e-6;
// Half of the way that is interpolated: wide enough that rounding, which grows as the inverse of the distance, leaves the
// nodes exact, narrow enough that the polynomial is.
constexpr double WIDTHS[5] = {0.25, 0.1, 0.03, 0.01, 0.003};
// What polynomial and closed places may differ by, which is a rounding over the distance: states, their derivatives, and
// what goes to zero. Angles after many turns round by more, in parts of the largest; loops in a row by the sum of
// theirs: two to six times what was measured for every five unknowns, from 20 to 80 of them. Beyond these more loops
// have larger errors each, too, which they take over from those before: four times what was measured for 320.
constexpr double SAME_STATE = 1e-12, SAME_FIRST = 1e-11, SAME_SECOND = 1e-8, SAME_REGULAR = 1e-3, FEW_UNKNOWNS = 5.0;
constexpr double MANY_UNKNOWNS = 80.0;
// Of the way to the branch point: how far a place may lie from its guess. Another branch lies off by about all of it.
constexpr double MISSED_GUESS = 0.1;
// Least slope of what goes to zero, at the nodes next to it, in parts of that at the others: a tenth where the pole is of
// second order.
constexpr double LEAST_SLOPE = 0.5;
constexpr double CLEAR = 0.5;  // of the width
constexpr int DEGREE = 5;      // of guesses: places that they are made of

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = std::fabs(a[i] - b[i]);
    most = off <= most ? most : off;  // a NaN wins
  }
  return most;
}

double largest(const std::vector<double>& a) { return largest_difference(a, std::vector<double>(a.size(), 0.0)); }

double node_at(int k) { return k < HALF ? -NODE[k] : NODE[NODES - 1 - k]; }

// Barycentric interpolation at x of values(k) at the nodes (Berrut and Trefethen 2004, 4.2).
template <class Value>
double between_nodes(double x, Value&& value) {
  double above = 0.0, below = 0.0;
  for (int k = 0; k < NODES; ++k) {
    const double off = x - node_at(k);
    if (off == 0.0) return value(k);
    const double part = (k % 2 ? -1.0 : 1.0) * SINE[k < HALF ? k : NODES - 1 - k] / off;
    above += part * value(k), below += part;
  }
  return above / below;
}

}  // namespace

bool CrossingCurve::is_clear(double s) const { return std::fabs(s - at_) >= CLEAR * width_; }

void CrossingCurve::place(double s, double* state, double* tangent, double* bend) const {
  const double x = (s - middle_) / width_;
  double part[NODES], sum = 0.0;
  for (int k = 0; k < NODES; ++k) {
    part[k] = between_nodes(x, [&](int other) { return other == k ? 1.0 : 0.0; });
    sum += part[k];
  }
  const auto mix = [&](std::vector<double> CurvePlace::*of, double* to) {
    const std::size_t count = (nodes_[0].*of).size();
    for (std::size_t i = 0; i < count; ++i) {
      // differences from one node: what does not move stays as it is
      const double base = (nodes_[HALF].*of)[i];
      double value = 0.0;
      for (int k = 0; k < NODES; ++k) value += part[k] * ((nodes_[k].*of)[i] - base);
      to[i] = base + value / sum;
    }
  };
  mix(&CurvePlace::state, state), mix(&CurvePlace::tangent, tangent), mix(&CurvePlace::bend, bend);
}

// By Neville's scheme from known places.
std::vector<double> CrossingCurve::guess(double s, const std::vector<const CurvePlace*>& known) const {
  std::vector<const CurvePlace*> nearest = known;
  std::stable_sort(nearest.begin(), nearest.end(), [&](const CurvePlace* a, const CurvePlace* b) {
    return std::fabs(a->s - s) < std::fabs(b->s - s);
  });
  if (nearest.size() > DEGREE) nearest.resize(DEGREE);
  std::vector<std::vector<double>> q;
  for (const CurvePlace* place : nearest) q.push_back(place->state);
  const int n = (int)q.size();
  for (int order = 1; order < n; ++order)
    for (int i = n - 1; i >= order; --i) {
      const double a = nearest[i - order]->s, b = nearest[i]->s;
      for (std::size_t k = 0; k < q[i].size(); ++k) q[i][k] += (q[i][k] - q[i - 1][k]) * ((s - b) / (b - a));
    }
  return q[n - 1];
}

// How far ahead the chart's matrix becomes singular, seen from places nearer and nearer to it: where eigenvalues of J^+ J_0
// are largest they are the distance from the origin over the distance from there.
double CrossingCurve::distance_ahead(const LookAt& look, double probe) {
  std::vector<CurvePlace> known = {origin_};
  double s = probe, distance = HUGE_VAL;
  constexpr double PARTS[4] = {0.4, 0.7, 0.85, 0.9};
  for (int step = 0;; ++step) {
    std::vector<const CurvePlace*> all;
    for (const CurvePlace& place : known) all.push_back(&place);
    CurvePlace found;
    if (!look(s, step ? guess(s, all) : std::vector<double>(), &found)) return HUGE_VAL;
    const double radius = found.jacobian.largest_change(origin_.jacobian);
    const double seen = s * (1.0 + radius) / radius;
    if (!(seen >= NEAREST_PLACE && seen <= FARTHEST_PLACE)) return HUGE_VAL;
    if (step == 4) return std::fabs(seen - distance) <= MISSED_GUESS * seen ? seen : HUGE_VAL;
    distance = seen, s = PARTS[step] * seen;
    known.push_back(found);
  }
}

bool CrossingCurve::interpolate(const LookAt& look, double ahead, double width) {
  middle_ = ahead, width_ = width;
  nodes_.assign(NODES, CurvePlace());
  // first the nodes on this side, from the origin on, then those on the other from the branch point on
  std::vector<int> order;
  for (int k = 0; k < NODES; ++k) order.push_back(k);
  const auto rank = [&](int k) {
    const double s = middle_ + width_ * node_at(k);
    return s > ahead ? 4.0 * width_ + (s - ahead) : std::fabs(s);
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return rank(a) < rank(b); });
  std::vector<const CurvePlace*> known = {&origin_};
  for (int k : order) {
    const double s = middle_ + width_ * node_at(k);
    const std::vector<double> from = known.size() > 1 ? guess(s, known) : std::vector<double>();
    if (!look(s, from, &nodes_[k])) return false;
    if (!from.empty() && !(largest_difference(from, nodes_[k].state) <= MISSED_GUESS * std::fabs(s - ahead))) return false;
    known.push_back(&nodes_[k]);
  }
  return true;
}

// Where the inverse of J has its pole, and that it is of first order.
bool CrossingCurve::locate() {
  regular_.clear();
  for (int k = 0; k < NODES; ++k)
    regular_.push_back((k < HALF ? -1.0 : 1.0) * nodes_[k].jacobian.regularity());
  const auto value = [&](int k) { return regular_[k]; };
  double low = -NODE[HALF - 1], high = NODE[HALF - 1];
  for (int i = 0; i < 60; ++i) {
    const double x = 0.5 * (low + high);
    (between_nodes(x, value) < 0.0 ? low : high) = x;
  }
  const double x = 0.5 * (low + high);
  at_ = middle_ + width_ * x;
  double inner = HUGE_VAL, outer = 0.0;
  for (int k = 0; k < NODES; ++k) {
    const double slope = regular_[k] / (node_at(k) - x);
    if (k == HALF - 1 || k == HALF) inner = std::fmin(inner, slope);
    outer = std::fmax(outer, slope);
  }
  return inner >= LEAST_SLOPE * outer;
}

bool CrossingCurve::holds_between(const LookAt& look, double pace) const {
  CurvePlace told = nodes_[0], seen;
  const double place_size = std::fmax(1.0, largest(nodes_[HALF].state));
  const double size = place_size * std::fmax(1.0, largest(nodes_[HALF].tangent));
  const double second_size = size * std::fmax(pace, largest(nodes_[HALF].bend));
  const int unknowns = origin_.jacobian.unknowns();
  const double loops = std::fmax(1.0, unknowns / FEW_UNKNOWNS) * std::fmax(1.0, unknowns / MANY_UNKNOWNS);
  double most = 0.0;
  for (double m : regular_) most = std::fmax(most, std::fabs(m));
  for (double x : BETWEEN) {
    const double s = middle_ + width_ * x;
    place(s, told.state.data(), told.tangent.data(), told.bend.data());
    if (!look(s, told.state, &seen)) return false;
    const double regular = (x < 0.0 ? -1.0 : 1.0) * seen.jacobian.regularity();
    const double expected = between_nodes(x, [&](int k) { return regular_[k]; });
    const bool same = largest_difference(told.state, seen.state) <= loops * SAME_STATE * place_size &&
                      largest_difference(told.tangent, seen.tangent) <= loops * SAME_FIRST * size &&
                      largest_difference(told.bend, seen.bend) <= loops * SAME_SECOND * second_size &&
                      std::fabs(regular - expected) <= SAME_REGULAR * most;
    if (!same) return false;
  }
  return true;
}

bool CrossingCurve::find(const LookAt& look, double probe, double pace) {
  if (!look(0.0, {}, &origin_)) return false;
  const double distance = distance_ahead(look, probe);
  if (!(distance <= FARTHEST_PLACE)) return false;
  double tried = 0.0;
  for (double least : WIDTHS) {
    const double width = std::fmax(least, distance);
    if (width == tried) break;
    tried = width;
    if (interpolate(look, distance, width) && locate() && holds_between(look, pace)) return true;
  }
  return false;
}
