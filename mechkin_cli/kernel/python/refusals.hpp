// What the core refuses, as Python's ValueError.
#pragma once

#include <nanobind/nanobind.h>

#include <string>
#include <utility>

#include "result.hpp"

inline void need(bool holds, const std::string& message) {
  if (!holds) throw nanobind::value_error(message.c_str());
}
inline void value_of(const Refusal& refusal) {
  if (refusal) throw nanobind::value_error(refusal->c_str());
}
template <class T>
T value_of(Result<T> result) {
  value_of(result.refusal());
  return std::move(*result);
}

// A method that may be refused, as one that raises.
template <class Owner, class Returned, class... Given>
auto raising(Returned (Owner::*method)(Given...)) {
  return [method](Owner& self, Given... given) { return value_of((self.*method)(std::forward<Given>(given)...)); };
}
