// The Jacobian of a charted motion's one block at a place, and how near it is to a singular one.
#pragma once

#include <utility>
#include <vector>

#include "arithmetic/band_row.hpp"
#include "arithmetic/dense.hpp"

class ChartMatrix {
 public:
  ChartMatrix() = default;
  // Full, or with the entries of a band (arithmetic/band.hpp), whose rows stay where they are.
  explicit ChartMatrix(Matrix full) : full_(std::move(full)) {}
  ChartMatrix(std::vector<double> entries, const BandRow* row, int unknowns, int border);

  int unknowns() const { return row_ ? unknowns_ : full_.columns; }
  // What goes to zero where J becomes singular, as the distance where the pole of its inverse is of first order: one over the
  // size of J^+, in Frobenius' norm, and of a band in that of its products with some fixed vectors, which is the same
  // but for a factor.
  double regularity() const;
  // The largest eigenvalue of J^+ J_0 - I.
  double largest_change(const ChartMatrix& origin) const;
  // Of a full one: whether it is told to be joined with that of the origin by regular ones.
  bool is_joined(const ChartMatrix& origin, double limit) const;

 private:
  Matrix full_;
  std::vector<double> entries_;
  const BandRow* row_ = nullptr;
  int unknowns_ = 0, border_ = 0;
};
