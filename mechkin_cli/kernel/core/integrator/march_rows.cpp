// Rows: steps end on them; where they are denser than the steps would be, they are interpolated.
#include <algorithm>
#include <cmath>

#include "integrator/march.hpp"

namespace {

constexpr double STRETCH = 1.01;  // of a step that reaches a row with it
constexpr double SAME_TIME = 2e-15;  // in parts of the time or the duration: between a row and a step that ended for more
                                     // than it

}  // namespace

// Apart from `at`, which is asked several times a row.
double RowTimes::between(int lane, long row) const {
  if (part.has_last && row == count - 1) return part.last;
  const long whole = row / part.parts, inner = row % part.parts + 1;
  const double to = given(lane, whole);
  if (inner == part.parts) return to;
  const double from = whole ? given(lane, whole - 1) : part.begin;
  return from + (to - from) * ((double)inner / part.parts);
}

// Where a step of about this length ends.
double March::cut_for_rows(int lane, double step) {
  const LaneControl& c = control_[lane];
  const double time = states_.time[lane];
  const double next = row_time(lane, c.next_row), reach = time + STRETCH * step;
  // the last step but one is half of what is left, so that none is tiny
  if (next > reach) return next - time < 2.0 * step ? time + 0.5 * (next - time) : time + step;
  const long deep = c.next_row + states_.settings.dense_rows - 1;
  if (deep >= rows_.count || row_time(lane, deep) > reach) return next;
  long last = deep;
  while (last + 1 < rows_.count && row_time(lane, last + 1) <= reach) ++last;
  return row_time(lane, last);
}

// The rows within the steps of these lanes, before their ends are taken.
void March::rows_inside(Method& method, Flags* mask) {
  const int lanes = states_.lanes;
  const auto is_inside = [&](int i) {
    return (*mask)[i] && has_row(control_[i]) && row_time(i, control_[i].next_row) < states_.until[i];
  };
  Flags here(lanes);
  for (int i = 0; i < lanes; ++i) here[i] = is_inside(i);
  if (!any(here)) return;
  const Flags asked = here;
  method.prepare_dense(states_, &here);
  for (int i = 0; i < lanes; ++i)
    if (asked[i] && !here[i]) {
      shorten_for_fault(i);
      (*mask)[i] = 0;
    }
  for (;;) {
    for (int i = 0; i < lanes; ++i) {
      here[i] = is_inside(i);
      if (!here[i]) continue;
      row_[i] = control_[i].next_row++;
      states_.report[i].rows = control_[i].next_row;
      at_[i] = row_time(i, row_[i]);
      part_[i] = (at_[i] - states_.time[i]) / states_.step[i];
    }
    if (!any(here)) return;
    method.dense(states_, here, part_.data(), place_.data());
    states_.motion.row(here.data(), row_.data(), at_.data(), place_.data(), true);
  }
}

// The rows at the places where the lanes stand, or no step before them.
void March::rows_here(const Flags& mask) {
  Flags here(states_.lanes, 0);
  for (int i = 0; i < states_.lanes; ++i) {
    LaneControl& c = control_[i];
    const double rounding = SAME_TIME * std::max(std::fabs(states_.time[i]), states_.duration[i]);
    here[i] = mask[i] && has_row(c) && row_time(i, c.next_row) - states_.time[i] <= rounding;
    if (!here[i]) continue;
    row_[i] = c.next_row++;
    states_.report[i].rows = c.next_row;
    states_.time[i] = at_[i] = row_time(i, row_[i]);
  }
  if (any(here)) states_.motion.row(here.data(), row_.data(), at_.data(), states_.y.data(), false);
}
