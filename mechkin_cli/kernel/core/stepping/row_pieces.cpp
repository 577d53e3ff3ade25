#include "stepping/row_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace {
constexpr double ROUNDING = 0x1p-50;  // some units in the last place
}

RowPieces::RowPieces(const InputRows& rows, const StepLimits& limits, const Course* course)
    : rows_(rows), limits_(limits), course_(course), scale_(rows.inputs, 0.0) {
  for (int i = 0; i < rows.inputs; ++i) {
    double size[4] = {};  // one after the other they would wait for each other
    rows.each(i, 0, rows.rows, [&size](long row, double x) {
      double& most = size[row % 4];
      most = std::fabs(x) > most ? std::fabs(x) : most;
      return true;
    });
    scale_[i] = greater(greater(size[0], size[1]), greater(size[2], size[3]));
  }
}

bool RowPieces::direction_from(long row, std::vector<double>* u, int* leading) const {
  u->assign(rows_.inputs, 0.0), *leading = 0;
  double size = 0.0;
  bool moves = false;
  for (int i = 0; i < rows_.inputs; ++i) {
    (*u)[i] = rows_.at(i, row + 1) - rows_.at(i, row);
    moves = moves || !(std::fabs((*u)[i]) <= ROUNDING * scale_[i]);
    if (std::fabs((*u)[i]) > size) size = std::fabs((*u)[i]), *leading = i;
  }
  if (size == 0.0 || !moves) return false;
  for (double& part : *u) part /= size;
  return true;
}

// The last row that lies on the straight way from `first` through the row after it.
long RowPieces::end_of_line(long first, long end, const std::vector<double>& u, int leading) const {
  double before = 0.0;
  long row = first + 1;
  if (rows_.inputs == 1) {
    const double begin = rows_.at(0, first), sense = u[0];
    rows_.each(0, row, end + 1, [&](long, double x) {
      const double along = (x - begin) * sense;
      if (!(along > before)) return false;
      before = along, ++row;
      return true;
    });
    return std::max(row - 1, first + 1);
  }
  for (; row <= end; ++row) {
    const double along = (rows_.at(leading, row) - rows_.at(leading, first)) * u[leading];
    bool onward = along > before;
    for (int i = 0; onward && i < rows_.inputs; ++i) {
      const double off = rows_.at(i, row) - (rows_.at(i, first) + u[i] * along);
      onward = std::fabs(off) <= limits_.same_line * (1.0 + scale_[i]);
    }
    if (!onward) break;
    before = along;
  }
  return std::max(row - 1, first + 1);
}

std::vector<Piece> RowPieces::pieces(bool every_row) const {
  std::vector<Piece> found;
  std::vector<double> u;
  int leading = 0;
  long next = 0;  // piece of the course
  const long courses = course_ ? (long)course_->pieces().size() : 0;
  for (long first = 0, last = 0; first + 1 < rows_.rows; first = last) {
    if (next < courses && course_->pieces()[next].first == first) {
      last = course_->pieces()[next].last;
      found.push_back({Way::course, first, last, next});
      ++next;
      continue;
    }
    last = first + 1;
    Way way = Way::rest;
    if (direction_from(first, &u, &leading)) {
      const long end = next < courses ? course_->pieces()[next].first : rows_.rows - 1;
      if (!every_row) last = end_of_line(first, end, u, leading);
      const bool whole = first == 0 && last == rows_.rows - 1;
      const bool far = last > first + 1 && rows_.distance(first, last) >= limits_.knot;
      way = every_row || whole || far || rows_.inputs == 1 ? Way::line : Way::curve;
    }
    if (way == Way::curve && !found.empty() && found.back().way == Way::curve)
      found.back().last = last;
    else
      found.push_back({way, first, last});
  }
  return found;
}
