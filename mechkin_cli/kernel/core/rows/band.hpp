// Bands of packs: pivots are exchanged lane by lane, as in linear.hpp.
#pragma once

#include "arithmetic/band.hpp"
#include "arithmetic/linear.hpp"

namespace {

struct PackEntries {
  using Number = Pack;
  using Swap = Mask;
  static MECHKIN_INLINE Mask is_larger(const Pack& a, const Pack& b) { return abs(a) > abs(b); }
  static MECHKIN_INLINE bool any(Mask m) { return ::any(m); }
  static MECHKIN_INLINE bool is_zero(const Pack& a) { return is_passed_over<0>(a); }
  static MECHKIN_INLINE void exchange(Mask lanes, Pack& a, Pack& b) {
    const Pack x = a, y = b;
    a = select(lanes, y, x), b = select(lanes, x, y);
  }
  static MECHKIN_INLINE void subtract_product(Pack& x, const Pack& a, const Pack& b) { ::subtract_product(x, a, b); }
};
using Band = BandOf<PackEntries>;

// +1 or -1: the sign of the determinant of a factored matrix.
inline Pack determinant_sign(Band f) {
  Pack sign = 1.0;
  for (int k = 0; k < f.n; ++k) sign *= copysign(Pack(1.0), *f.in_column(k, k));
  for (int s = 0; s < f.row[f.n - 1].swaps; ++s) sign = select(f.swap[s], -sign, sign);
  return sign;
}

// As that of linear.hpp.
inline Pack least_pivot(Band f) {
  Pack largest = abs(*f.in_column(0, 0));
  for (int k = 1; k < f.n; ++k) largest = max(abs(*f.in_column(k, k)), largest);
  return Pack(1.0) / largest;
}

}  // namespace
