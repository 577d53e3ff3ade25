// The smooth curve of the inputs through a stretch of rows, by the length of the chords between them.
#pragma once

#include <vector>

#include "stepping/stepper.hpp"

// Rows of a table of inputs, column after column; angles may stand without their whole turns.
struct InputRows {
  const double* values;
  const double* whole;  // of each value; null: none
  int inputs;
  long rows;
  std::vector<char> still;  // inputs that move no loop: where they go does not matter to what is followed
  double at(int input, long row) const {
    return true_at(input, still[input] ? 0 : row);
  }
  double true_at(int input, long row) const {
    const long k = input * rows + row;
    return whole ? values[k] + FULL_TURN * whole[k] : values[k];
  }
  // Calls use(row, value) for rows [begin, end) of an input, in order, until it says no.
  template <class Use>
  void each(int input, long begin, long end, Use&& use) const {
    const double *const value = values + input * rows, *const turn = whole ? whole + input * rows : nullptr;
    if (still[input] || turn) {
      for (long row = begin; row < end && use(row, at(input, row)); ++row) {
      }
      return;
    }
    for (long row = begin; row < end && use(row, value[row]); ++row) {
    }
  }
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
