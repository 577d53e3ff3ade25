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
  explicit Arguments(const nanobind::kwargs& given, int parts = 1);

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
  struct Given {
    const char* name;
    PyObject* value;
  };
  // An array's memory and shape.
  struct Memory {
    void* data;
    std::size_t bytes, dimensions, shape[3];
  };
  nanobind::object find(const char* name);
  template <class Array>
  static Memory memory_of(nanobind::handle object, const char* name, const char* kind);
  void check_shape(const Memory& array, const char* name, long columns, int parts);
  void keep(nanobind::object object, const Memory& array, const char* name, bool written);

  int parts_;
  std::vector<Given> given_;
  std::size_t next_ = 0;  // of those given: behind the last one asked for
  std::size_t found_ = 0;
  long rows_ = -1;
  std::vector<const char*> names_;
  std::vector<nanobind::object> kept_;
  std::vector<Range> ranges_;
};
