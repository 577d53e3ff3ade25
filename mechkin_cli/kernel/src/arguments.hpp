// The keyword arguments of a call of the kernel, each checked: name, type, shape, range, and that no array that is
// written shares memory with another.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>
#include <vector>

class Arguments {
 public:
  // Numbers of `parts` parts stand in arrays (columns, parts, rows), or (parts, rows) for one per row.
  explicit Arguments(const nanobind::kwargs& given, int parts = 1) : given_(given), parts_(parts) {}

  // Arrays of float64, C-contiguous; null where the argument is left out or None. (columns, rows), or (rows,) for
  // `columns` ONE_PER_ROW. Rows must be `rows` of the first array asked for.
  static constexpr long ONE_PER_ROW = -1;
  const double* read(const char* name, long columns);
  double* write(const char* name, long columns);
  unsigned char* write_flags(const char* name);  // uint8, one per row
  const double* read_required(const char* name, long columns);
  double* write_required(const char* name, long columns);
  unsigned char* write_flags_required(const char* name);

  // (count,) numbers, null where they are left out.
  const double* numbers(const char* name, std::size_t count);

  long rows() const { return rows_; }
  // A whole number from least to most; `otherwise` where it is left out.
  long integer(const char* name, long least, long most, long otherwise);
  // A number >= 0 (no nan) of a tuple of `count`.
  std::vector<double> limits(const char* name, std::size_t count);
  // The object itself, or none.
  nanobind::object other(const char* name);
  // No argument may be left over, no written array overlap another. TypeError, ValueError.
  void finish() const;

 private:
  struct Range {
    const char *begin, *end, *name;
    bool written;
  };
  nanobind::object find(const char* name);
  template <class Array>
  void check_shape(const Array& array, const char* name, long columns);

  const nanobind::kwargs& given_;
  int parts_;
  std::size_t found_ = 0;
  long rows_ = -1;
  std::vector<const char*> names_;
  std::vector<nanobind::object> kept_;
  std::vector<Range> ranges_;
};
