// Arrays that a call gives to Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <new>

// An array of some shape for Python, and where its numbers go; std::bad_alloc where no memory holds so many.
template <class Number>
nanobind::ndarray<nanobind::numpy, Number> new_array(Number** data, std::initializer_list<std::size_t> shape) {
  std::size_t size = 1;
  for (std::size_t n : shape)
    if (__builtin_mul_overflow(size, n, &size)) throw std::bad_alloc();
  *data = new Number[size ? size : 1];
  nanobind::capsule owner(*data, [](void* p) noexcept { delete[] static_cast<Number*>(p); });
  return nanobind::ndarray<nanobind::numpy, Number>(*data, shape, owner);
}
