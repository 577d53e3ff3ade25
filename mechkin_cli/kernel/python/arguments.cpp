#include "arguments.hpp"

#include <cmath>
#include <cstring>
#include <limits>
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

// As the format of a buffer and the size of its elements say it.
template <class Array>
constexpr char format_of = std::is_same_v<typename Array::Scalar, unsigned char> ? 'B' : 'd';

}  // namespace

Arguments::Arguments(const nb::kwargs& given, int parts) : parts_(parts) {
  given_.reserve(given.size()), names_.reserve(given.size()), kept_.reserve(given.size()), ranges_.reserve(given.size());
  for (auto [key, value] : given) given_.push_back({nb::cast<const char*>(key), value.ptr()});
}

// Arguments are mostly given in the order in which they are asked for.
nb::object Arguments::find(const char* name) {
  names_.push_back(name);
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const std::size_t at = next_ + k < given_.size() ? next_ + k : next_ + k - given_.size();
    // a call of the library costs as much as all else here, and what is left out is held against every name
    if (given_[at].name[0] != name[0] || std::strcmp(given_[at].name, name) != 0) continue;
    next_ = at + 1;
    ++found_;
    return nb::borrow(given_[at].value);
  }
  return nb::none();
}

// Through the buffer that an array offers, which takes a third of the time of its capsule; what offers none, or another,
// is nanobind's to judge.
template <class Array>
Arguments::Memory Arguments::memory_of(nb::handle object, const char* name, const char* kind) {
  constexpr bool written = !std::is_const_v<typename Array::Scalar>;
  Memory r = {};
  Py_buffer buffer;
  if (PyObject_CheckBuffer(object.ptr())) {
    if (PyObject_GetBuffer(object.ptr(), &buffer, PyBUF_ND | PyBUF_FORMAT | (written ? PyBUF_WRITABLE : 0)) == 0) {
      const bool fits = buffer.format && buffer.format[0] == format_of<Array> && !buffer.format[1] && buffer.ndim <= 3;
      r = {buffer.buf, (std::size_t)buffer.len, (std::size_t)buffer.ndim, {}};
      for (int i = 0; fits && i < buffer.ndim; ++i) r.shape[i] = (std::size_t)buffer.shape[i];
      PyBuffer_Release(&buffer);
      if (fits) return r;
    } else {
      PyErr_Clear();
    }
  }
  Array array;
  if (!nb::try_cast(object, array, false)) refuse_type(name, kind);
  r = {(void*)array.data(), array.nbytes(), array.ndim(), {}};
  for (std::size_t i = 0; i < r.dimensions && i < 3; ++i) r.shape[i] = array.shape(i);
  return r;
}

void Arguments::check_shape(const Memory& array, const char* name, long columns, int parts) {
  // a `long` counts what an array holds; on Windows it has 32 bits
  if (array.bytes / sizeof(double) > (std::size_t)std::numeric_limits<long>::max())
    refuse(name, std::to_string(array.bytes / sizeof(double)) + " numbers, more than this system counts; take fewer rows");
  const std::size_t dimensions = (columns == ONE_PER_ROW ? 1 : 2) + (parts > 1);
  if (array.dimensions != dimensions)
    refuse(name, std::to_string(array.dimensions) + " dimensions instead of " + std::to_string(dimensions));
  const long rows = (long)array.shape[dimensions - 1];
  if (rows_ < 0) rows_ = rows;
  if (rows != rows_) refuse(name, std::to_string(rows) + " rows instead of " + std::to_string(rows_));
  if (parts > 1 && (long)array.shape[dimensions - 2] != parts)
    refuse(name, std::to_string(array.shape[dimensions - 2]) + " parts of a number instead of " + std::to_string(parts));
  if (columns != ONE_PER_ROW && (long)array.shape[0] != columns)
    refuse(name, std::to_string(array.shape[0]) + " columns instead of " + std::to_string(columns));
}

void Arguments::keep(nb::object object, const Memory& array, const char* name, bool written) {
  const char* const begin = static_cast<const char*>(array.data);
  ranges_.push_back({begin, begin + array.bytes, name, written});
  kept_.push_back(std::move(object));
}

const double* Arguments::read(const char* name, long columns) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const Memory array = memory_of<Reading>(object, name, "not a C-contiguous array of float64");
  check_shape(array, name, columns, parts_);
  keep(std::move(object), array, name, false);
  return static_cast<const double*>(array.data);
}

const double* Arguments::numbers(const char* name, std::size_t count) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const Memory array = memory_of<Reading>(object, name, "not a C-contiguous array of float64");
  if (array.dimensions != 1 || array.shape[0] != count)
    refuse(name, std::to_string(array.bytes / sizeof(double)) + " numbers instead of " + std::to_string(count));
  keep(std::move(object), array, name, false);
  return static_cast<const double*>(array.data);
}

double* Arguments::write(const char* name, long columns) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const Memory array = memory_of<Writing>(object, name, "not a writable C-contiguous array of float64");
  check_shape(array, name, columns, parts_);
  keep(std::move(object), array, name, true);
  return static_cast<double*>(array.data);
}

unsigned char* Arguments::write_flags(const char* name) {
  nb::object object = find(name);
  if (object.is_none()) return nullptr;
  const char* const kind = "not a writable array of uint8, one per row";
  const Memory array = memory_of<Flags>(object, name, kind);
  if (array.dimensions != 1) refuse_type(name, kind);
  check_shape(array, name, ONE_PER_ROW, 1);
  keep(std::move(object), array, name, true);
  return static_cast<unsigned char*>(array.data);
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
    for (const Given& each : given_) {
      bool known = false;
      for (const char* name : names_) known = known || std::strcmp(each.name, name) == 0;
      if (!known) refuse_type(each.name, "no such argument");
    }
  for (const Range& a : ranges_)
    for (const Range& b : ranges_)
      if (&a != &b && a.written && a.begin < b.end && b.begin < a.end)
        refuse(a.name, std::string("shares memory with ") + b.name);
}
