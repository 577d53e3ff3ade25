// What the plan's parts must be, said as exceptions.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>

// Rows of a table that has no columns may be any number, and take no memory where they come from.
constexpr long MOST_ROWS = 100000000;

inline void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(message);
}

template <std::size_t N>
void check_finite(const std::array<double, N>& numbers) {
  for (double x : numbers) require(std::isfinite(x), "a plan's numbers must be finite");
}
inline void check_finite(double x) { require(std::isfinite(x), "a plan's numbers must be finite"); }
