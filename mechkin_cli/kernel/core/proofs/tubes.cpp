#include "proofs/tubes.hpp"

#include <algorithm>
#include <cmath>

namespace {

constexpr double WHOLE_TURN = 2.0 * 3.14159265358979323846;
// Roundings of a cubic's value and of a difference of angles by whole turns, in parts of their size.
constexpr double SLACK = 0x1p-46;
// A longer tube is tried after one that was proven, a shorter one after one that was not.
constexpr double LONGER = 1.4, SHORTER = 0.6;
constexpr double FIRST_LENGTH = 0.5;  // rad, or lengths of the plan

// A cubic on [-1, 1] by values and derivatives at its ends.
void cubic(double a, double slope_a, double b, double slope_b, double* c) {
  c[0] = 0.5 * (a + b) + 0.25 * (slope_a - slope_b);
  c[1] = 0.75 * (b - a) - 0.25 * (slope_a + slope_b);
  c[2] = 0.25 * (slope_b - slope_a);
  c[3] = 0.25 * (slope_a + slope_b) - 0.25 * (b - a);
}
double value(const double* c, double t) { return ((c[3] * t + c[2]) * t + c[1]) * t + c[0]; }
double size(const double* c) { return std::fabs(c[0]) + std::fabs(c[1]) + std::fabs(c[2]) + std::fabs(c[3]); }

// Derivative of a quaternion, omega q / 2.
void quaternion_rate(const double* q, const double* omega, double scale, double* rate) {
  const double x = 0.5 * scale * omega[0], y = 0.5 * scale * omega[1], z = 0.5 * scale * omega[2];
  rate[0] = -x * q[1] - y * q[2] - z * q[3];
  rate[1] = x * q[0] + y * q[3] - z * q[2];
  rate[2] = y * q[0] + z * q[1] - x * q[3];
  rate[3] = z * q[0] + x * q[2] - y * q[1];
}

}  // namespace

TubeProver::TubeProver(const Plan& plan, const Plan* radii, const ProvingUnit& unit)
    : plan_(plan), radii_(radii), unit_(unit), parts_(unit.parts), memory_(unit.workspace_size(plan)),
      turns_(plan.states, false), ball_(plan.columns, -1), curve_((long)unit.parts * plan.states),
      least_(plan.columns), radius_(plan.columns) {
  for (int k = 0; k < plan.links; ++k) {
    const TreeJoint& j = plan.joints[k];
    if (j.type == TREE_R || j.type == TREE_C) turns_[j.state] = true;
    if (j.type == TREE_S) ball_[j.column] = j.state;
  }
}

// The curve's coefficients, and how far the inputs of rows on the way are off it.
void TubeProver::lay_curve(const WayOfRows& way, long from, long to) {
  const double half = 0.5 * (way.place[to] - way.place[from]);
  const auto at = [&](const double* base, long number, long row) { return base[number * way.rows + row]; };
  std::fill(curve_.begin(), curve_.end(), 0.0);
  for (int c = 0; c < plan_.columns; ++c) {
    const int s = plan_.column_state[c];
    if (s < 0 || plan_.column_block[c] < 0) continue;
    const double a = at(way.states, s, from), slope_a = half * at(way.after, c, from);
    double b = at(way.states, s, to);
    const double slope_b = half * at(way.before, c, to);
    if (turns_[s]) b += WHOLE_TURN * std::nearbyint((a + slope_a + slope_b - b) / WHOLE_TURN);
    cubic(a, slope_a, b, slope_b, coefficient(s));
  }
  for (int c = 0; c < plan_.columns; ++c) {
    const int s = ball_[c];
    if (s < 0) continue;
    double a[4], b[4], omega_a[3], omega_b[3], rate_a[4], rate_b[4], along = 0.0;
    for (int i = 0; i < 4; ++i) a[i] = at(way.states, s + i, from), b[i] = at(way.states, s + i, to), along += a[i] * b[i];
    for (int i = 0; i < 4; ++i) b[i] = along < 0 ? -b[i] : b[i];
    for (int i = 0; i < 3; ++i) omega_a[i] = at(way.after, c + i, from), omega_b[i] = at(way.before, c + i, to);
    quaternion_rate(a, omega_a, half, rate_a);
    quaternion_rate(b, omega_b, half, rate_b);
    for (int i = 0; i < 4; ++i) cubic(a[i], rate_a[i], b[i], rate_b[i], coefficient(s + i));
  }
  for (int i = 0; i < plan_.inputs; ++i) {
    double* const c = coefficient(plan_.column_state[plan_.input_column[i]]);
    const double a = at(way.inputs, i, from), b = at(way.inputs, i, to);
    c[0] = 0.5 * (a + b), c[1] = 0.5 * (b - a);
    double off = 0.0;
    for (long row = from; row <= to; ++row) {
      const double t = half > 0 ? (way.place[row] - way.place[from]) / half - 1.0 : 0.0;
      off = std::max(off, std::fabs(at(way.inputs, i, row) - (c[0] + t * c[1])) + at(way.off, i, row));
    }
    c[parts_ - 1] = off + SLACK * (std::fabs(c[0]) + std::fabs(c[1]));
  }
}

// Whether a row's box lies in the tube; before the tube is known, makes it wide enough for that.
bool TubeProver::holds_row(const WayOfRows& way, long row, double t, bool is_box_known) {
  bool holds = true;
  const auto meet = [&](int column, double reach) {
    if (is_box_known)
      holds = holds && reach <= radius_[column];
    else
      least_[column] = std::max(least_[column], 1.01 * reach);
  };
  const auto radius = [&](int c) { return way.radius[c * way.rows + row]; };
  for (int c = 0; c < plan_.columns; ++c) {
    const int s = plan_.column_state[c];
    if (s >= 0 && plan_.column_block[c] >= 0) {
      const double* const f = coefficient(s);
      double off = way.states[s * way.rows + row] - value(f, t);
      if (turns_[s]) off -= WHOLE_TURN * std::nearbyint(off / WHOLE_TURN);
      meet(c, std::fabs(off) + radius(c) + SLACK * (WHOLE_TURN + 2 * size(f)));
    }
    if (ball_[c] < 0 || plan_.column_block[c] < 0) continue;
    // increments x of the turn q p* from the curve's orientation p to the row's q, and then those of its box
    double q[4], p[4];
    for (int i = 0; i < 4; ++i)
      q[i] = way.states[(ball_[c] + i) * way.rows + row], p[i] = value(coefficient(ball_[c] + i), t);
    const double w = q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3];
    const double x[3] = {2 * (q[1] * p[0] - q[0] * p[1] - q[2] * p[3] + q[3] * p[2]) / w,
                         2 * (q[2] * p[0] - q[0] * p[2] - q[3] * p[1] + q[1] * p[3]) / w,
                         2 * (q[3] * p[0] - q[0] * p[3] - q[1] * p[2] + q[2] * p[1]) / w};
    const double far = std::max({std::fabs(x[0]), std::fabs(x[1]), std::fabs(x[2])}),
                 wide = std::max({radius(c), radius(c + 1), radius(c + 2)});
    // (y + x + y x x / 2) / (1 - x.y / 4) for an increment y of the box behind x
    for (int i = 0; i < 3; ++i)
      meet(c + i, (std::fabs(x[i]) + radius(c + i) + 1.5 * far * wide) * (1.0 + 2.0 * far * wide) + 64 * SLACK);
    holds = holds && far * wide < 0.25;
  }
  return holds;
}

bool TubeProver::prove(const WayOfRows& way, long from, long to, double* width) {
  lay_curve(way, from, to);
  const double half = 0.5 * (way.place[to] - way.place[from]);
  const auto parameter = [&](long row) {
    return row == from ? -1.0 : row == to ? 1.0 : half > 0 ? (way.place[row] - way.place[from]) / half - 1.0 : 0.0;
  };
  std::fill(least_.begin(), least_.end(), 0.0);
  for (long row = from; row <= to; ++row)
    if (!holds_row(way, row, parameter(row), false)) return false;
  double contraction = 0.0, beyond = 0.0;
  unsigned char proven = 0;
  unit_.prove(plan_, radii_, {1, curve_.data(), least_.data(), way.follows, radius_.data(), &contraction, &beyond, &proven},
              memory_.data());
  if (!proven) return false;
  for (long row = from; row <= to; ++row)
    if (!holds_row(way, row, parameter(row), true)) return false;
  *width = *std::max_element(radius_.begin(), radius_.end());
  return true;
}

bool TubeProver::are_proven(const WayOfRows& way, long from, long to) const {
  return std::all_of(way.proven + from, way.proven + to + 1, [](unsigned char proven) { return proven != 0; });
}

void TubeProver::prove(const WayOfRows& way, Tubes* tubes) {
  tubes->count = tubes->tried = 0;
  for (long row = 0; row < way.rows; ++row) tubes->joined[row] = 0, tubes->width[row] = 0.0;
  double length = FIRST_LENGTH;
  long steps = 1;  // at least, between rows, where the tube before had fewer
  for (long from = 0; from + 1 < way.rows;) {
    long to = from + 1;
    while (to + 1 < way.rows && !way.bends[to] && (to - from < steps || way.place[to + 1] <= way.place[from] + length))
      ++to;
    double width = 0.0;
    bool found = false;
    for (;; to = from + std::max(1L, (long)(SHORTER * (double)(to - from)))) {
      const bool is_tried = are_proven(way, from, to);
      tubes->tried += is_tried;
      found = is_tried && prove(way, from, to, &width);
      length = (found ? LONGER : SHORTER) * (way.place[to] - way.place[from]);
      if (found || to == from + 1) break;
    }
    steps = found ? to - from + 1 : 1;
    if (!found) length = FIRST_LENGTH, to = from + 1;
    for (long row = from; row < to && found; ++row) tubes->joined[row] = 1, tubes->width[row] = width;
    tubes->count += found;
    from = to;
  }
}
