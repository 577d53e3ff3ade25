// Ways in which joints at rest can begin to slip, and the directions of slips that have several (docs/friction.md, Motions).
#include <algorithm>
#include <cmath>

#include "response/charted_motion.hpp"

namespace {

// Rows of slips, in parts of the largest, that are rounding.
constexpr double NO_ROW = 1e-8;
// What stays of a slip's derivative, in parts of that by the largest wrench, that is rounding.
constexpr double NO_REST = 1e-12;
// Directions in which slips begin: rounds, and what the last may yet change.
constexpr int AIM_ROUNDS = 1000;
constexpr double AIM_TIGHT = 1e-14, AIM_ACCEPT = 1e-9;
// Ways to slip that are tried: six joints, each forth, back or at rest.
constexpr std::size_t MOST_WAYS = 729;

}  // namespace

// A slip in several directions begins in that of its own acceleration. With what friction holds, h, the force f on the circle
// of its limit is found by f := that of f + step * slip's derivative which lies on the circle: a gradient's way to the one
// place where the derivative lies along f (Moreau, On unilateral constraints, friction and plasticity, 1974). It starts
// along h, or against it where the way says so. False where none is found for these joints, which have their senses.
bool ChartedMotion::aim(int lane, const std::vector<int>& joints, const Signs& way, const double* place, const double* rate,
                        Stage* found) {
  if (!joints.empty()) {
    for (int k : joints) sense(lane, k) = 0.0;
    evaluate(place, rate, found);
  }
  std::vector<double> steps;
  for (int k : joints) {
    const int begin = slips_.first[k], end = slips_.first[k + 1];
    const double force = slip_size(found->slip.force, lane, k), fastest = at(found->slip.answer, k, lane);
    for (int c = begin; c < end; ++c) {
      const double none = c == begin ? way[k] : 0.0;
      slips_.aim[(std::size_t)c * lanes_ + lane] = force > 0.0 ? way[k] * at(found->slip.force, c, lane) / force : none;
    }
    steps.push_back(fastest > 0.0 ? 1.0 / ((end - begin) * fastest) : 0.0);
    sense(lane, k) = 1.0;
  }
  double change = 0.0;
  for (int round = 0; round < AIM_ROUNDS; ++round) {
    evaluate(place, rate, found);
    change = 0.0;
    for (std::size_t number = 0; number < joints.size(); ++number)
      change = std::max(change, turn_aim(lane, joints[number], steps[number], *found));
    if (change <= AIM_TIGHT) return true;
  }
  for (int k : joints) slips_.doubtful[lane] = {k};
  return change <= AIM_ACCEPT;
}

// One round of it for a joint; by how much its direction has turned.
double ChartedMotion::turn_aim(int lane, int k, double step, const Stage& found) {
  const int begin = slips_.first[k], end = slips_.first[k + 1];
  const double limit = slip_size(found.slip.force, lane, k);
  std::vector<double> to;
  double square = 0.0, change = 0.0;
  for (int c = begin; c < end; ++c) {
    to.push_back(limit * at(slips_.aim, c, lane) + step * at(found.slip.second, c, lane));
    square += to.back() * to.back();
  }
  if (!(square > 0.0)) return 0.0;
  for (int c = begin; c < end; ++c) {
    double& now = slips_.aim[(std::size_t)c * lanes_ + lane];
    const double next = to[c - begin] / std::sqrt(square);
    change = std::max(change, std::fabs(next - now)), now = next;
  }
  return change;
}

// Row c of the slips, of joint k, by the chart and what stays of the slip's derivative without it, of the stage in trial_; less what lies
// along an orthonormal basis, at `place`.
ChartedMotion::SlipRow ChartedMotion::slip_row(int lane, int k, int c, const std::vector<SlipRow>& basis) const {
  const int n = plan_.charts;
  SlipRow r;
  r.rest = at(trial_.slip.second, c, lane);
  for (int i = 0; i < n; ++i) {
    r.row.push_back(at(trial_.slip.row, (long)c * n + i, lane));
    r.rest -= r.row[i] * at(trial_.chart_second, i, lane);
    r.size += r.row[i] * r.row[i];
  }
  r.size = std::sqrt(r.size);
  for (const SlipRow& b : basis) {
    double along = 0.0;
    for (int i = 0; i < n; ++i) along += r.row[i] * b.row[i];
    for (int i = 0; i < n; ++i) r.row[i] -= along * b.row[i];
    r.rest -= along * b.rest;
  }
  if (std::fabs(r.rest) <= NO_REST * at(trial_.slip.level, 0, lane) * at(trial_.slip.answer, k, lane)) r.rest = 0.0;
  return r;
}

// The rows of what sticks, orthonormal.
std::vector<ChartedMotion::SlipRow> ChartedMotion::held_rows(int lane, const std::vector<int>& joints) const {
  std::vector<SlipRow> basis;
  for (int k : joints)
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c) {
      SlipRow r = slip_row(lane, k, c, basis);
      double square = 0.0;
      for (double x : r.row) square += x * x;
      const double size = std::sqrt(square);
      if (!(size > NO_ROW * r.size)) continue;
      for (double& x : r.row) x /= size;
      r.rest /= size;
      basis.push_back(r);
    }
  return basis;
}

// Whether these joints can slip where they are to, beside all that sticks.
bool ChartedMotion::slips_beside(int lane, const Signs& way, const std::vector<int>& joints) const {
  std::vector<int> held;
  for (int k = 0; k < plan_.frictions; ++k)
    if (way[k] == 0) held.push_back(k);
  const std::vector<SlipRow> basis = held_rows(lane, held);
  const auto can = [&](int k) {
    for (int c = slips_.first[k]; c < slips_.first[k + 1]; ++c) {
      const SlipRow r = slip_row(lane, k, c, basis);
      for (double x : r.row)
        if (std::fabs(x) > NO_ROW * r.size) return true;
      if (r.rest != 0.0 && r.size == 0.0) return true;
    }
    return false;
  };
  for (int k : joints)
    if (way[k] != 0 && !can(k)) return false;
  return true;
}

// Ways that open joints could go together, the others going as they do; those in several directions begin along, or
// against, what holds them. None where they are too many. Of the stage in trial_.
std::vector<Signs> ChartedMotion::ways_of(int lane, const std::vector<int>& open, int forced) {
  std::vector<int> one, several;
  for (int k : open)
    if (k != forced) (has_sign(lane, k) ? one : several).push_back(k);
  std::size_t choices = 1;
  for (std::size_t k = 0; k < several.size() && choices <= MOST_WAYS; ++k) choices *= 3;
  Signs now = senses(lane);
  std::vector<Signs> all;
  for (std::size_t which = 0; which < choices; ++which) {
    std::vector<int> held;
    std::size_t left = which;
    for (int k : several) {
      now[k] = (signed char)(left % 3 == 2 ? -1 : left % 3);
      left /= 3;
      if (now[k] == 0) held.push_back(k);
    }
    const std::vector<SlipRow> basis = held_rows(lane, held);
    Matrix rows((int)one.size(), plan_.charts);
    std::vector<double> offset;
    for (std::size_t r = 0; r < one.size(); ++r) {
      const SlipRow row = slip_row(lane, one[r], slips_.first[one[r]], basis);
      for (int i = 0; i < plan_.charts; ++i) rows((int)r, i) = std::fabs(row.row[i]) <= NO_ROW * row.size ? 0.0 : row.row[i];
      offset.push_back(row.rest);
    }
    const std::vector<Signs> signs = sign_vectors(rows, offset, NO_ROW, MOST_WAYS);
    if (signs.empty() || all.size() + signs.size() > MOST_WAYS) return {};
    for (const Signs& each : signs) {
      for (std::size_t r = 0; r < one.size(); ++r) now[one[r]] = each[r];
      if (slips_beside(lane, now, several)) all.push_back(now);
    }
  }
  return all;
}
