#include "stepping/row_curve.hpp"

#include <algorithm>
#include <cmath>

double InputRows::distance(long one, long other) const {
  double square = 0.0;
  for (int i = 0; i < inputs; ++i) square += (at(i, other) - at(i, one)) * (at(i, other) - at(i, one));
  return std::sqrt(square);
}

double InputRows::turn_cosine(long row) const {
  double product = 0.0;
  for (int i = 0; i < inputs; ++i) product += (at(i, row) - at(i, row - 1)) * (at(i, row + 1) - at(i, row));
  const double lengths = distance(row - 1, row) * distance(row, row + 1);
  return lengths == 0.0 ? 1.0 : product / lengths;
}

RowCurve::RowCurve(const Plan& plan, const InputRows& rows, long first, long last, double knot)
    : plan_(plan), rows_(rows), first_(first), last_(last), largest_knot_(knot), knot_(knot),
      length_(last - first + 1, 0.0) {
  for (long row = first + 1; row <= last; ++row)
    length_[row - first] = length_[row - 1 - first] + rows.distance(row - 1, row);
}

void RowCurve::read_for_step(double h) {
  // an eighth of a step tells its curve; at a thousandth of the knot, 1e-5, rounding of the inputs comes to 1e-6 of a
  // second derivative, and no nearer row is read
  knot_ = std::fmin(largest_knot_, std::fmax(h / 8.0, 1e-3 * largest_knot_));
}

long RowCurve::row_before(double sigma) const {
  const auto beyond = std::upper_bound(length_.begin(), length_.end(), sigma);
  return first_ + std::max<long>(0, beyond - length_.begin() - 1);
}

// The first row at least `distance` away, or the last of the stretch in that direction.
long RowCurve::away(long row, int direction, double distance) const {
  if (direction > 0) {
    const auto at = std::lower_bound(length_.begin() + (row + 1 - first_), length_.end(), length(row) + distance);
    return std::min(last_, first_ + (long)(at - length_.begin()));
  }
  return std::max(first_, row_before(length(row) - distance));
}

void RowCurve::at(double sigma, PathPoint* point) const {
  const long row = row_before(sigma);
  long one = away(row, -1, knot_), other = away(row, 1, knot_);
  // at an end both others lie on one side, the nearer of them no nearer than half way
  if (row == first_) {
    other = std::max(row + 2, away(row, 1, 2.0 * knot_));
    one = std::max(row + 1, std::min(row_before(0.5 * length(other)), other - 1));
  } else if (row == last_) {
    one = std::min(row - 2, away(row, -1, 2.0 * knot_));
    other = std::max(one + 1, std::min(row_before(0.5 * (length(one) + length(row))), row - 1));
  }
  const double a = length(one) - length(row), b = length(other) - length(row), t = sigma - length(row);
  const int n = rows_.inputs;
  point->inputs.resize(n), point->first.resize(n), point->second.resize(n);
  for (int i = 0; i < n; ++i) {
    const double here = rows_.at(i, row);
    const double to_one = (rows_.at(i, one) - here) / a, to_other = (rows_.at(i, other) - here) / b;
    const double bend = (to_other - to_one) / (b - a), slope = to_one - a * bend;
    point->inputs[i] = here + t * (slope + t * bend);
    point->first[i] = slope + 2.0 * t * bend;
    point->second[i] = 2.0 * bend;
  }
}
