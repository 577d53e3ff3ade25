// The smooth way over a branch point, where the equations that closed places are found by are singular: states and rates on
// a line through a chart (chart.hpp), of coordinate s, interpolated between closed places on both sides. Of several freedoms
// and driven inputs there is such a line through each place.
//
// On a smooth branch q(s) the inverse of the matrix J(s) = [f_q; t] has a pole of first order at the branch point if and only
// if W^T D2F[t, N] is regular for t the tangent and N the other null vectors, W the left ones: the branch is then alone
// in its direction (W^T D2F[t, t] = 0 holds along any smooth branch). Both are read off the closed places: the size of the
// inverse goes as 1/|s - s*| on both sides, and one polynomial leads through all of them, as it leads through others
// that it has not been made of. Another branch lies off by about |s - s*| and leaves no polynomial.
#pragma once

#include <functional>
#include <vector>

#include "response/chart_matrix.hpp"

// A closed place of the line; `tangent` and `bend` as in StageFound.
struct CurvePlace {
  double s = 0.0;
  std::vector<double> state, tangent, bend;
  ChartMatrix jacobian;
};

// Closes a place of the line from a guess of its states, of the chart's own where empty; false if it does not close.
using LookAt = std::function<bool(double s, const std::vector<double>& guess, CurvePlace* found)>;

class CrossingCurve {
 public:
  // The way over the branch point at some s > 0, about `probe` or some times as far from s = 0; false where there is none
  // within reach, or no smooth way over it. `pace`: the square of the rates at its places.
  bool find(const LookAt& look, double probe, double pace);

  double at() const { return at_; }  // the branch point
  bool covers(double s) const { return s > at_ - width_ && s < at_ + width_; }
  // Whether a place lies as far from the branch point as another chart can begin.
  bool is_clear(double s) const;
  void place(double s, double* state, double* tangent, double* bend) const;

 private:
  double distance_ahead(const LookAt& look, double probe);
  bool interpolate(const LookAt& look, double ahead, double width);
  bool holds_between(const LookAt& look, double pace) const;
  bool locate();
  std::vector<double> guess(double s, const std::vector<const CurvePlace*>& known) const;

  CurvePlace origin_;
  double at_ = 0.0, middle_ = 0.0, width_ = 0.0;
  std::vector<CurvePlace> nodes_;
  std::vector<double> regular_;  // nodes: what goes to zero at the branch point, with its sign
};
