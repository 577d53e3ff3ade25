#include "stepping/branch_point.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/dense.hpp"

namespace {

// Ways before the last node over which the matrix is read, at parts of them: at the place itself numbers are lost in
// rounding. The one whose extrapolation is surest counts.
constexpr double SPANS[3] = {0.1, 0.03, 0.01};
// (1 + cos((2 k + 1) pi / 18)) / 2
constexpr double CHEBYSHEV[9] = {0.99240387650610404, 0.93301270189221932, 0.82139380484326968, 0.67101007166283444,
                                 0.5,                 0.32898992833716562, 0.17860619515673035, 0.066987298107780688,
                                 0.0075961234938959606};
// Change of the extrapolated place by its last order; at branch points of parallelograms 1e-12 is met.
constexpr double DOUBT = 1e-8;
// How far from the last node it may lie, and how far in parts of the way over which it was extrapolated: steps end where the
// least singular value is the root of a rounding, which it is the farther off the more loops lie singular at once.
constexpr double NEAR = 1e-5, NEAR_PART = 1e-3;
// Loops that lie singular at once from which on it is so much farther off: 2e-5 with 27 of them, 9e-5 and 1.5e-4 with 81.
constexpr double FEW_LOOPS = 16.0;
// Ways beyond this (arclength, rad and parts of the size) make it no farther: what runs away has long ones.
constexpr double LONG = 0.1;
// Way before it from which its states are predicted: the third order leaves 1e-13, rounding over the way 1e-12.
constexpr double NEAR_STATE = 1e-4;
// Singular values below this part of the largest are zero at the extrapolated place, which is known to some 1e-8.
constexpr double SINGULAR = 1e-5;
// A matrix of one equation vanishes as a whole; those of others are about 1, with lengths in parts of the mechanism.
constexpr double LEAST_SIZE = 0.1;
// Parts of the second derivatives' size up to which a condition holds, and from which a matrix of them has full rank.
constexpr double HOLDS = 1e-3, FULL_RANK = 1e-3;
// Way from the branch point to the nodes on both sides of it.
constexpr double STRIDE = 1e-2;
// Corrections and looks back across it, in parts of the way: another branch lies off by about the way itself.
constexpr double MISS = 1e-3;

// p as a function of m, at m = 0, by Neville's scheme; `doubt` the last change.
double inverse_zero(const std::vector<double>& p, const std::vector<double>& m, double* doubt) {
  const int n = (int)p.size();
  std::vector<double> q = p;
  double before = q[n - 1];
  for (int order = 1; order < n; ++order) {
    for (int i = n - 1; i >= order; --i) q[i] = (m[i] * q[i - 1] - m[i - order] * q[i]) / (m[i] - m[i - order]);
    *doubt = std::fabs(q[n - 1] - before);
    before = q[n - 1];
  }
  return before;
}

// The root of a number that is not negative, by arithmetic alone, which has the same bits on every machine: Newton's method
// on y^order = x from above, where it falls until it stands.
double root(double x, int order) {
  if (order == 1 || !(x > 0.0)) return x;
  if (order == 2) return std::sqrt(x);
  int power = 0;
  std::frexp(x, &power);  // x < 2^power
  double y = std::ldexp(1.0, power > 0 ? (power + order - 1) / order : power / order);
  for (;;) {
    double rest = x;
    for (int k = 1; k < order; ++k) rest /= y;
    const double next = ((order - 1) * y + rest) / order;
    if (!(next < y)) return y;
    y = next;
  }
}

}  // namespace

namespace {

// The extrapolated place as seen from a base before it, at Chebyshev's places over a span.
double place_over(Arc& arc, const Node& base, double span, BranchPointAhead* found) {
  const Matrix bordered = arc.bordered(base);
  const LeastSquares reference(bordered);
  std::vector<double> places, sigmas, values;
  for (double part : CHEBYSHEV) {
    Node at;
    if (!arc.close_from(base, span * part, &at)) return HUGE_VAL;
    places.push_back(span * part), sigmas.push_back(at.sigma);
    values.push_back(std::fabs(determinant(reference.solve(arc.bordered(at)))));
  }
  double best = HUGE_VAL;
  // the zero has the order of the branches that meet, summed over the loops in which they meet at once
  for (int order = 1; order <= bordered.columns; ++order) {
    std::vector<double> roots = values;
    for (double& x : roots) x = root(x, order);
    double doubt = HUGE_VAL, sigma_doubt = HUGE_VAL;
    const double place = inverse_zero(places, roots, &doubt), sigma = inverse_zero(sigmas, roots, &sigma_doubt);
    if (doubt < best) best = doubt, *found = {base, place, sigma, order};
  }
  return best;
}

}  // namespace

bool branch_point_ahead(Arc& arc, const std::vector<Node>& nodes, BranchPointAhead* found) {
  const double last = nodes.back().place, way = last - nodes.front().place;
  double best = HUGE_VAL;
  for (double span : SPANS) {
    const Node* base = &nodes.front();
    for (const Node& node : nodes)
      if (last - node.place >= span) base = &node;
    BranchPointAhead seen;
    const double doubt = way > 0.0 ? place_over(arc, *base, last - base->place, &seen) : HUGE_VAL;
    if (doubt < best) best = doubt, *found = seen;
  }
  const double most = std::max(NEAR, NEAR_PART * std::min(last - found->base.place, LONG)) *
                      std::max(1.0, found->order / FEW_LOOPS);
  return best <= DOUBT && std::fabs(found->base.place + found->distance - last) <= most;
}

namespace {

using Vector = std::vector<double>;

std::vector<Vector> null_vectors(const Matrix& a) {
  const Singular s = singular_vectors(a);
  std::vector<Vector> found;
  for (int j = 0; j < a.columns; ++j) {
    if (s.value[j] > SINGULAR * std::fmax(s.value[0], LEAST_SIZE)) continue;
    Vector v(a.columns);
    for (int i = 0; i < a.columns; ++i) v[i] = s.v(i, j);
    found.push_back(v);
  }
  return found;
}

// Whether the second-order conditions of the branches through a singular place isolate the tangent t.
bool goes_on_alone(Arc& arc, const Node& node, const Matrix& extended, Vector t) {
  const std::vector<Vector> right = null_vectors(extended), left = null_vectors(transposed(extended));
  if (right.size() < 2 || left.empty()) return false;
  // t by its parts in the null space: it is known to less than that is
  Vector in_space(t.size(), 0.0);
  for (const Vector& n : right)
    for (std::size_t i = 0; i < t.size(); ++i) in_space[i] += product(n, t) * n[i];
  if (product(in_space, in_space) < 1.0 - HOLDS) return false;
  t = in_space;
  const auto second = [&](double sign, const Vector& n) {
    Vector v = t;
    for (std::size_t i = 0; i < v.size(); ++i) v[i] += sign * n[i];
    return arc.second_along(node, v);
  };
  const Vector none(t.size(), 0.0), along = second(1.0, none);
  Matrix mixed((int)left.size(), (int)right.size());
  double size = std::sqrt(product(along, along));
  for (std::size_t j = 0; j < right.size(); ++j) {
    const Vector plus = second(1.0, right[j]), minus = second(-1.0, right[j]);
    Vector part(plus.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = 0.25 * (plus[i] - minus[i]);
    size = std::fmax(size, std::sqrt(product(part, part)));
    for (std::size_t w = 0; w < left.size(); ++w) mixed((int)w, (int)j) = product(left[w], part);
  }
  for (const Vector& w : left)
    if (std::fabs(product(w, along)) > HOLDS * size) return false;
  const bool wide = mixed.rows < mixed.columns;
  const Singular s = singular_vectors(wide ? transposed(mixed) : mixed);
  int rank = 0;
  for (double value : s.value) rank += value > FULL_RANK * size;
  return rank == (int)right.size() - 1;
}

}  // namespace

namespace {

Node node_at(Arc& arc, const BranchPointAhead& point, double before) {
  Node near, there;
  // the tangent's error grows towards the place, the prediction's away from it
  while (!arc.close_from(point.base, point.distance - before, &near)) {
    before *= 10.0;
    if (before >= point.distance) {
      near = point.base, before = point.distance;
      break;
    }
  }
  there = near;
  std::vector<double> state;
  arc.predict(near, before, &state);
  there.state = state;
  there.place += before, there.sigma = point.sigma;
  there.inputs = arc.inputs_at(point.sigma);
  return there;
}

}  // namespace

bool pass_straight(Arc& arc, const BranchPointAhead& point, Node* before, Node* after) {
  const double gap = std::fmin(STRIDE, point.distance);
  if (!(gap > 0.1 * STRIDE) || !arc.close_from(point.base, point.distance - gap, before)) return false;
  Node half;
  if (!arc.close_from(*before, 0.5 * gap, &half)) return false;
  // the tangent at the place from two before it
  Vector t = arc.tangent(*before);
  const Vector nearer = arc.tangent(half);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 2.0 * nearer[i] - t[i];
  const double size = std::sqrt(product(t, t));
  for (double& x : t) x /= size;
  const Node there = node_at(arc, point, NEAR_STATE);
  if (!goes_on_alone(arc, there, arc.extended_at(there, there.state, there.sigma), t)) return false;
  if (!arc.close_from(*before, 2.0 * gap, after) || !(after->correction <= MISS * gap)) return false;
  // backwards: the other side looks back at where it was reached from
  Node back;
  if (!arc.close_from(*after, -2.0 * gap, &back) || !(back.correction <= MISS * gap)) return false;
  for (std::size_t s = 0; s < back.state.size(); ++s)
    if (!(std::fabs(back.state[s] - before->state[s]) <= MISS * gap)) return false;
  return product(arc.tangent(*before), arc.tangent(*after)) > 0.9;
}

Node branch_point_node(Arc& arc, const BranchPointAhead& point) { return node_at(arc, point, NEAR_STATE); }
