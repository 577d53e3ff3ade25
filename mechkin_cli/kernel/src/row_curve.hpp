// The smooth curve of the inputs through a stretch of rows, by the length of the chords between them.
#pragma once

#include <vector>

#include "stepper.hpp"

// Rows of a table of inputs, column after column.
struct InputRows {
  const double* values;
  int inputs;
  long rows;
  double at(int input, long row) const { return values[input * rows + row]; }
  double distance(long one, long other) const;
  // Cosine of the turn of the path at a row between two others; 1 where it rests, NaN beside a row that is no number.
  double turn_cosine(long row) const;
};

// Three rows at least. At a row the curve has the row's inputs; its derivatives are those of the parabola through it
// and two others, at least `knot` away, so that rounding of the inputs does not count; nearer where the curve bends
// sharply.
class RowCurve : public Path {
 public:
  RowCurve(const Plan& plan, const InputRows& rows, long first, long last, double knot);
  void at(double sigma, PathPoint* point) const override;
  const Plan& plan(double) const override { return plan_; }
  // Length of the way to a row; `lengths` begins at the first one.
  double length(long row) const { return length_[row - first_]; }
  const double* lengths(long row) const { return &length_[row - first_]; }
  // Reads the derivatives over an eighth of a step, at most the knot given first and at least a thousandth of it.
  void read_for_step(double h);
  // The last row of the stretch that lies no farther than sigma.
  long row_before(double sigma) const;

 private:
  long away(long row, int direction, double distance) const;

  const Plan& plan_;
  const InputRows& rows_;
  long first_, last_;
  double largest_knot_, knot_;
  std::vector<double> length_;
};
