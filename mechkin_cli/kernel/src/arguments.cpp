#include "arguments.hpp"

#include <cmath>
#include <cstring>
#include <type_traits>

namespace nb = nanobind;

namespace {

using Reading = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Writing = nb::ndarray<double, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<unsigned char, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

[[noreturn]] void refuse(const char* name, const std::string& what) {
  throw nb::value_error((std::string(name) + ": " + what).c_str());
}
[[noreturn]] void refuse_type(const char* name, const char* what) {
  throw nb::type_error((std::string(name) + ": " + what).c_str());
}

template <class Array>
Array array_of(nb::handle object, const char* name, const char* kind) {
  Array array;
  if (!nb::try_cast(object, array, false)) refuse_type(name, kind);
  return array;
}

}  // namespace

nb::object Arguments::find(const char* name) {
  names_.push_back(name);
  PyObject* const value = PyDict_GetItemString(given_.ptr(), name);
  if (!value) return nb::none();
  ++found_;
  return nb::borrow(value);
}

template <class Array>
void Arguments::check_shape(const Array& array, const char* name, long columns) {
  const bool flags = std::is_same_v<Array, Flags>;
  const int parts = flags ? 1 : parts_;
  const std::size_t dimensions = (columns == ONE_PER_ROW ? 1 : 2) + (parts > 1);
  if (array.ndim() != dimensions)
    refuse(name, std::to_string(array.ndim()) + " dimensions instead of " + std::to_string(dimensions));
  const long rows = (long)array.shape(dimensions - 1);
  if (rows_ < 0) rows_ = rows;
  if (rows != rows_) refuse(name, std::to_string(rows) + " rows instead of " + std::to_string(rows_));
  if (parts > 1 && (long)array.shape(dimensions - 2) != parts)
    refuse(name, std::to_string(array.shape(dimensions - 2)) + " parts of a number instead of " + std::to_string(parts));
  if (columns != ONE_PER_ROW && (long)array.shape(0) != columns)
    refuse(name, std::to_string(array.shape(0)) + " columns instead of " + std::to_string(columns));
}

const double* Arguments::read(const char* name, long columns) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const auto array = array_of<Reading>(object, name, "not a C-contiguous array of float64");
  check_shape(array, name, columns);
  const char* const begin = reinterpret_cast<const char*>(array.data());
  ranges_.push_back({begin, begin + array.nbytes(), name, false});
  kept_.push_back(object);
  return array.data();
}

const double* Arguments::numbers(const char* name, std::size_t count) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const auto array = array_of<Reading>(object, name, "not a C-contiguous array of float64");
  if (array.ndim() != 1 || array.shape(0) != count)
    refuse(name, std::to_string(array.size()) + " numbers instead of " + std::to_string(count));
  const char* const begin = reinterpret_cast<const char*>(array.data());
  ranges_.push_back({begin, begin + array.nbytes(), name, false});
  kept_.push_back(object);
  return array.data();
}

double* Arguments::write(const char* name, long columns) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const auto array = array_of<Writing>(object, name, "not a writable C-contiguous array of float64");
  check_shape(array, name, columns);
  const char* const begin = reinterpret_cast<const char*>(array.data());
  ranges_.push_back({begin, begin + array.nbytes(), name, true});
  kept_.push_back(object);
  return array.data();
}

unsigned char* Arguments::write_flags(const char* name) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const auto array = array_of<Flags>(object, name, "not a writable array of uint8, one per row");
  check_shape(array, name, ONE_PER_ROW);
  const char* const begin = reinterpret_cast<const char*>(array.data());
  ranges_.push_back({begin, begin + array.nbytes(), name, true});
  kept_.push_back(object);
  return array.data();
}

const double* Arguments::read_required(const char* name, long columns) {
  const std::size_t kept = kept_.size();
  const double* const data = read(name, columns);
  if (kept_.size() == kept) refuse_type(name, "missing");
  return data;
}

double* Arguments::write_required(const char* name, long columns) {
  const std::size_t kept = kept_.size();
  double* const data = write(name, columns);
  if (kept_.size() == kept) refuse_type(name, "missing");
  return data;
}

unsigned char* Arguments::write_flags_required(const char* name) {
  const std::size_t kept = kept_.size();
  unsigned char* const data = write_flags(name);
  if (kept_.size() == kept) refuse_type(name, "missing");
  return data;
}

long Arguments::integer(const char* name, long least, long most, long otherwise) {
  nb::object object = find(name);
  if (object.is_none()) return otherwise;
  long value = 0;
  if (!nb::try_cast(object, value, true)) refuse_type(name, "not a whole number");
  if (value < least || value > most)
    refuse(name, std::to_string(value) + " is not from " + std::to_string(least) + " to " + std::to_string(most));
  return value;
}

std::vector<double> Arguments::limits(const char* name, std::size_t count) {
  nb::object object = find(name);
  std::vector<double> values;
  if (!nb::isinstance<nb::tuple>(object) || nb::len(object) != count)
    refuse_type(name, ("not a tuple of " + std::to_string(count) + " numbers").c_str());
  for (nb::handle item : nb::borrow<nb::tuple>(object)) {
    double value = 0.0;
    if (!nb::try_cast(item, value, true)) refuse_type(name, "not a number");
    if (!(value >= 0.0)) refuse(name, "a limit is a number from 0 on");
    values.push_back(value);
  }
  return values;
}

nb::object Arguments::other(const char* name) { return find(name); }

void Arguments::finish() const {
  if (found_ != given_.size())
    for (auto [key, value] : given_) {
      bool known = false;
      for (const char* name : names_) known = known || std::strcmp(nb::cast<const char*>(key), name) == 0;
      if (!known) refuse_type(nb::cast<const char*>(key), "no such argument");
    }
  for (const Range& a : ranges_)
    for (const Range& b : ranges_)
      if (&a != &b && a.written && a.begin < b.end && b.begin < a.end)
        refuse(a.name, std::string("shares memory with ") + b.name);
}
