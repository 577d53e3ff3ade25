// How rows are reached: at rest, on a line, on a smooth curve through them, or along their course.
#pragma once

#include "stepping/course.hpp"
#include "stepping/row_curve.hpp"

enum class Way { rest, line, curve, course };

// Rows (first, last] that are reached one way from row `first`.
struct Piece {
  Way way;
  long first, last;
  long number = -1;  // of the course's piece
};

class RowPieces {
 public:
  // Rows, limits and course must outlive it.
  RowPieces(const InputRows& rows, const StepLimits& limits, const Course* course);
  std::vector<Piece> pieces(bool every_row) const;
  // Direction from a row to the next, its largest part 1 (or -1), and which part that is; false where they coincide but
  // for roundings of the inputs, which are no way to go.
  bool direction_from(long row, std::vector<double>* u, int* leading) const;

 private:
  long end_of_line(long first, long end, const std::vector<double>& u, int leading) const;

  const InputRows& rows_;
  const StepLimits& limits_;
  const Course* course_;
  std::vector<double> scale_;
};
