// Rows between two places of a curve by quintic Hermite interpolation: see Hermite.
#pragma once

#include "arithmetic/pack.hpp"
#include "rows/unit.hpp"

namespace {

MECHKIN_INLINE void put(double* at, Pack x, int count) {
  if (count == LANES) return store(at, x);
  double each[LANES];
  store(each, x);
  for (int i = 0; i < count; ++i) at[i] = each[i];
}

void interpolate(const Hermite& curve) {
  const Pack begin = curve.begin, step = curve.step, square = curve.step * curve.step;
  for (long row = 0; row < curve.rows; row += LANES) {
    const int count = curve.rows - row < LANES ? (int)(curve.rows - row) : LANES;
    double last[LANES];  // the last, partial pack repeats its last place
    for (int i = 0; count < LANES && i < LANES; ++i) last[i] = curve.place[row + (i < count ? i : count - 1)];
    const Pack t = ((count < LANES ? load(last) : load(curve.place + row)) - begin) / step, t2 = t * t, t3 = t2 * t;
    const Pack one = 1.0;
    const Pack value0 = one - t3 * (Pack(10.0) - t * (Pack(15.0) - Pack(6.0) * t));
    const Pack first0 = t - t3 * (Pack(6.0) - t * (Pack(8.0) - Pack(3.0) * t));
    const Pack second0 = Pack(0.5) * t2 * (one - t * (Pack(3.0) - t * (Pack(3.0) - t)));
    const Pack value1 = one - value0, first1 = -t3 * (Pack(4.0) - t * (Pack(7.0) - Pack(3.0) * t));
    const Pack second1 = Pack(0.5) * t3 * (one - t * (Pack(2.0) - t));
    const Pack left = one - t, both = t3 * (left * left * left), u = t - Pack(curve.third);
    for (int k = 0; k < curve.columns; ++k) {
      const double* const at = curve.ends + 6 * k;
      Pack found = value0 * Pack(at[0]) + value1 * Pack(at[3]) + step * (first0 * Pack(at[1]) + first1 * Pack(at[4])) +
                         square * (second0 * Pack(at[2]) + second1 * Pack(at[5]));
      if (curve.rest) {
        const double* const r = curve.rest + 3 * k;
        found += both * (Pack(r[0]) + u * (Pack(r[1]) + u * Pack(r[2])));
      }
      if (curve.whole[k]) {
        const Pack whole = nearest_integer(found / Pack(FULL_TURN));
        found -= Pack(FULL_TURN) * whole;
        put(curve.whole[k] + row, Pack(curve.counted[k]) + whole, count);
      }
      put(curve.out[k] + row, found, count);
    }
  }
}

}  // namespace
