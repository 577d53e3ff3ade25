#include "rows/closed.hpp"

namespace {

// How many are so, which a compiler counts side by side: none with nan.
bool are_within(const double* numbers, const double* limits, long count) {
  long found = 0;
  for (long i = 0; i < count; ++i) found += numbers[i] <= limits[i];
  return found == count;
}
bool are_within(const double* numbers, double limit, long count) {
  long found = 0;
  for (long i = 0; i < count; ++i) found += numbers[i] <= limit;
  return found == count;
}
bool are_equal(const double* numbers, long count) {
  long found = 0;
  for (long i = 0; i < count; ++i) found += numbers[i] == numbers[0];
  return found == count;
}

}  // namespace

bool all_closed(const Request& r, int blocks, const RowLimits& limits, long begin, long end) {
  unsigned char other = 0;
  for (long i = begin; i < end; ++i) other |= (unsigned char)(r.flags[i] ^ ROW_GOOD);
  const long count = end - begin;
  bool closed = !other && are_within(r.correction + begin, limits.correction + begin, count);
  if (r.condition) closed = closed && are_within(r.condition + begin, limits.condition, count);
  for (int b = 0; closed && b < blocks; ++b) closed = are_equal(r.side + b * r.rows + begin, count);
  return closed;
}

bool on_one_side(const Request& r, int blocks, long row, long other) {
  for (int b = 0; b < blocks; ++b)
    if (!(r.side[b * r.rows + row] == r.side[b * r.rows + other])) return false;
  return true;
}
