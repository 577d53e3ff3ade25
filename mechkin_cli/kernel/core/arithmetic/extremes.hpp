// How far the numbers of a column reach, in one pass over them.
#pragma once

#include <cstddef>

// Numbers that are there (no nan), those of them that are infinite, the largest and the smallest: -inf and inf of none.
struct Extremes {
  std::size_t cells, infinite;
  double largest, smallest;
};

Extremes extremes(const double* numbers, std::size_t count);
