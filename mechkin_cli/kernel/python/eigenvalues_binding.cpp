// Eigenvalues of small matrices.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>

#include "arithmetic/eigenvalues.hpp"
#include "bindings.hpp"
#include "new_array.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Square = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

int size_of(const Square& a) {
  if (a.shape(0) != a.shape(1)) throw nb::value_error("a matrix that is not square has no eigenvalues");
  return (int)a.shape(0);
}

nb::object array_of(const std::vector<double>& from, std::initializer_list<std::size_t> shape) {
  double* data;
  auto made = new_array<double>(&data, shape);
  std::copy(from.begin(), from.end(), data);
  return nb::cast(made);
}

nb::object symmetric(const Square& a, const Square& b) {
  const int n = size_of(a);
  if (size_of(b) != n) throw nb::value_error("two matrices of different sizes");
  SymmetricEigen found;
  bool good;
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    good = symmetric_eigen(n, a.data(), b.data(), &found);
  }
  if (!good) return nb::none();
  const std::size_t size = (std::size_t)n;
  return nb::make_tuple(array_of(found.values, {size}), array_of(found.vectors, {size, size}));
}

nb::object general(const Square& a) {
  const int n = size_of(a);
  GeneralEigen found;
  bool good;
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    good = general_eigen(n, a.data(), &found);
  }
  if (!good) return nb::none();
  const std::size_t size = (std::size_t)n;
  return nb::make_tuple(array_of(found.real, {size}), array_of(found.imaginary, {size}),
                        array_of(found.vectors_real, {size, size}), array_of(found.vectors_imaginary, {size, size}));
}

}  // namespace

void bind_eigenvalues(nb::module_& m) {
  m.def("symmetric_eigen", &symmetric, "a"_a, "b"_a);
  m.def("eigen", &general, "a"_a);
}
