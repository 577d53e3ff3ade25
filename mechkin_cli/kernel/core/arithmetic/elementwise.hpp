// The elementary functions over arrays.
#pragma once

#include "arithmetic/elementary_apart.hpp"
#include "arithmetic/operations.hpp"

namespace {

// out[i] = function(x[i], y[i]); the last, partial pack repeats its last element.
template <class Function>
void apply(const Function& function, const double* x, const double* y, double* out, long n) {
  long row = 0;
  for (; row + LANES <= n; row += LANES) store(out + row, function(load(x + row), load(y + row)));
  if (row == n) return;
  double first[LANES], second[LANES], result[LANES];
  for (int i = 0; i < LANES; ++i) {
    const long at = row + i < n ? row + i : n - 1;
    first[i] = x[at];
    second[i] = y[at];
  }
  store(result, function(load(first), load(second)));
  for (long i = row; i < n; ++i) out[i] = result[i - row];
}

// x, y, out: n numbers each; functions of one argument don't look at y. An unknown operation leaves NaN.
void elementwise(int operation, const double* x, const double* y, double* out, long n) {
  switch (operation) {
    case OPERATION_SIN: return apply([](Pack a, Pack) { return apart::sin(a); }, x, y, out, n);
    case OPERATION_COS: return apply([](Pack a, Pack) { return apart::cos(a); }, x, y, out, n);
    case OPERATION_TAN: return apply([](Pack a, Pack) { return apart::tan(a); }, x, y, out, n);
    case OPERATION_ASIN: return apply([](Pack a, Pack) { return apart::asin(a); }, x, y, out, n);
    case OPERATION_ACOS: return apply([](Pack a, Pack) { return apart::acos(a); }, x, y, out, n);
    case OPERATION_ATAN: return apply([](Pack a, Pack) { return apart::atan(a); }, x, y, out, n);
    case OPERATION_ATAN2: return apply([](Pack a, Pack b) { return apart::atan2(a, b); }, x, y, out, n);
    case OPERATION_EXP: return apply([](Pack a, Pack) { return apart::exp(a); }, x, y, out, n);
    case OPERATION_LOG: return apply([](Pack a, Pack) { return apart::log(a); }, x, y, out, n);
    case OPERATION_POWER: return apply([](Pack a, Pack b) { return apart::pow(a, b); }, x, y, out, n);
  }
  for (long i = 0; i < n; ++i) out[i] = __builtin_nan("");
}

}  // namespace
