// The arithmetic and functions of Taylor models, behind one plain C function for the tests.
#include "arithmetic/elementary.hpp"

extern "C" __attribute__((visibility("default"))) int parts() { return PARTS; }

// a, b, out: parts of one number, the same in all lanes.
extern "C" __attribute__((visibility("default"))) void model(int operation, const double* a, const double* b, double* out) {
  Real part[PARTS];
  for (int k = 0; k < PARTS; ++k) part[k] = a[k];
  const Taylor x = from_parts(part);
  for (int k = 0; k < PARTS; ++k) part[k] = b[k];
  const Taylor y = from_parts(part);
  Taylor s, c;
  sincos(x, s, c);
  const Taylor results[] = {x + y, x - y, x * y, x / y, sqrt(x), s, c, atan2(x, y)};
  for (int k = 0; k < PARTS; ++k) out[k] = lane(part_of(results[operation], k), 0);
}
