// The arithmetic and functions of intervals over arrays, behind one plain C function for the tests.
#include "arithmetic/elementary.hpp"

namespace {

template <class F>
void each(const double* x, const double* y, double* out, long n, const F& f) {
  for (long row = 0; row < n; row += LANES) {
    const auto at = [&](const double* from) {
      return Interval(DoubleDouble(load(from + row), load(from + n + row)), load(from + 2 * n + row));
    };
    const Interval z = f(at(x), at(y));
    store(out + row, z.midpoint.high), store(out + n + row, z.midpoint.low), store(out + 2 * n + row, z.radius);
  }
}

}  // namespace

// x, y, out: high parts of midpoints (n), low parts (n), then radii (n); n a multiple of the lanes.
extern "C" __attribute__((visibility("default"))) void enclose(int operation, const double* x, const double* y,
                                                               double* out, long n) {
  switch (operation) {
    case 0: return each(x, y, out, n, [](Interval a, Interval b) { return a + b; });
    case 1: return each(x, y, out, n, [](Interval a, Interval b) { return a - b; });
    case 2: return each(x, y, out, n, [](Interval a, Interval b) { return a * b; });
    case 3: return each(x, y, out, n, [](Interval a, Interval b) { return a / b; });
    case 4: return each(x, y, out, n, [](Interval a, Interval) { return sqrt(a); });
    case 5: return each(x, y, out, n, [](Interval a, Interval) { return square(a); });
    case 6: return each(x, y, out, n, [](Interval a, Interval) { return sin(a); });
    case 7: return each(x, y, out, n, [](Interval a, Interval) { return cos(a); });
    case 8: return each(x, y, out, n, [](Interval a, Interval) { return tan(a); });
    case 9: return each(x, y, out, n, [](Interval a, Interval b) { return atan2(a, b); });
    case 10: return each(x, y, out, n, [](Interval a, Interval) { return atan(a); });
    case 11: return each(x, y, out, n, [](Interval a, Interval) { return asin(a); });
    case 12: return each(x, y, out, n, [](Interval a, Interval) { return acos(a); });
    case 13: return each(x, y, out, n, [](Interval a, Interval) { return exp(a); });
    case 14: return each(x, y, out, n, [](Interval a, Interval) { return log(a); });
    case 15: return each(x, y, out, n, [](Interval a, Interval b) { return pow(a, b); });
    case 16: return each(x, y, out, n, [](Interval a, Interval b) { return hull(a, b); });
    case 17: return each(x, y, out, n, [](Interval a, Interval b) {
      add_product(a, a, b);
      return a;
    });
    case 18: return each(x, y, out, n, [](Interval a, Interval b) { return sum_of_products(a, b, b, b, -a, a); });
    case 19: return each(x, y, out, n, [](Interval a, Interval b) { return difference_of_products(a, b, b, b); });
    case 20: return each(x, y, out, n, [](Interval a, Interval b) { return principal_angle(a, b); });
  }
}
