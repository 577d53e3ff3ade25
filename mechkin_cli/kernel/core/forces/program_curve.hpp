// The value of a program's curve.
#pragma once

#include "rows/outputs.hpp"

namespace {

// The piece from the last knot that is not above lane i of x.
inline const Knot& piece_at(const Knot* first, int count, Pack x, int i) {
  const double leading = lane(part_of(x, 0), i), rest = PARTS == 1 ? 0.0 : lane(part_of(x, PARTS - 1), i);
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high + 1) / 2;
    if (first[middle].x < leading || (first[middle].x == leading && rest >= 0.0))
      low = middle;
    else
      high = middle - 1;
  }
  return first[low];
}

inline Pack curve_value(const ProgramCurve& c, const Knot* knot, Pack at) {
  const Knot* const first = knot + c.begin;
  const int count = c.end - c.begin;
  const Pack start = first->x, end = first[count - 1].x;
  const Mask inside = (at >= Pack(c.low)) & (at <= Pack(c.high));
  const Pack within = select(at < start, start, select(at > end, end, at));
  Knot piece[LANES];
  for (int i = 0; i < LANES; ++i) piece[i] = piece_at(first, count, within, i);
  const auto field = [&piece](double Knot::*of) {
    double values[LANES];
    for (int i = 0; i < LANES; ++i) values[i] = piece[i].*of;
    return Pack(load(values));
  };
  const Pack u = within - field(&Knot::x);
  const Pack value = field(&Knot::y) + u * (field(&Knot::b) + u * (field(&Knot::c) + u * field(&Knot::d)));
  return select(inside, value, Pack(__builtin_nan("")));
}

}  // namespace
