// Arrays of numbers that a call is given, and copies of them.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>
#include <vector>

using Row = nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
using Rows = nanobind::ndarray<const double, nanobind::ndim<2>, nanobind::c_contig, nanobind::device::cpu>;

inline std::vector<double> copy_of(const Row& a) { return {a.data(), a.data() + a.shape(0)}; }
inline std::vector<double> copy_of(const Rows& a) { return {a.data(), a.data() + a.shape(0) * a.shape(1)}; }
// ValueError unless it has so many rows.
inline std::vector<double> copy_of(const Rows& a, long rows, const char* name) {
  if ((long)a.shape(1) != rows) throw nanobind::value_error((std::string(name) + ": wrong number of rows").c_str());
  return copy_of(a);
}
