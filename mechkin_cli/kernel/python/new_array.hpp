// Arrays that a call gives to Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <new>

// What stands where nothing is written.
template <class Number>
constexpr Number NOTHING =
    std::numeric_limits<Number>::has_quiet_NaN ? std::numeric_limits<Number>::quiet_NaN() : Number{};

// An array of some shape for Python, full of nothing, and where its numbers go; std::bad_alloc where no memory holds
// so many.
template <class Number>
nanobind::ndarray<nanobind::numpy, Number> new_array(Number** data, std::initializer_list<std::size_t> shape) {
  std::size_t size = 1;
  for (std::size_t n : shape)
    if (__builtin_mul_overflow(size, n, &size)) throw std::bad_alloc();
  *data = new Number[size ? size : 1];
  std::fill_n(*data, size, NOTHING<Number>);
  nanobind::capsule owner(*data, [](void* p) noexcept { delete[] static_cast<Number*>(p); });
  return nanobind::ndarray<nanobind::numpy, Number>(*data, shape, owner);
}
