// Python's view of the kernel: arrays in, arrays out, the GIL released while it works.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "arithmetic/operations.hpp"
#include "bindings.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Values = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using NewValues = nb::ndarray<nb::numpy, double, nb::ndim<1>>;

NewValues elementwise(int operation, Values x, Values y, int lanes) {
  const KernelUnit& unit = unit_or_throw(lanes);
  const std::size_t n = x.shape(0);
  if (operation < 0 || operation >= OPERATION_COUNT) throw nb::value_error("unknown operation");
  if (y.shape(0) != n) throw nb::value_error("arguments of different length");
  double* out = new double[n ? n : 1];
  nb::capsule owner(out, [](void* data) noexcept { delete[] static_cast<double*>(data); });
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    unit.elementwise(operation, x.data(), y.data(), out, (long)n);
  }
  return NewValues(out, {n}, owner);
}

// The joint table and the tree displacements that its pairs are chains of.
nb::list joint_table() {
  nb::list table;
  for (int code = 0; code < kernel_unit()->pair_codes; ++code) {
    const PairType& t = kernel_unit()->pair_types[code];
    nb::dict entry;
    entry["letter"] = t.letter;
    entry["code"] = code;
    entry["equations"] = t.equations;
    entry["lengths"] = t.lengths;
    table.append(entry);
  }
  return table;
}

nb::list tree_table() {
  nb::list table;
  for (int code = 0; code < TREE_CODES; ++code) {
    const TreeType& t = kernel_unit()->tree_types[code];
    nb::dict entry;
    entry["code"] = code;
    entry["freedoms"] = t.freedoms;
    entry["states"] = t.states;
    entry["slides"] = t.slides;
    table.append(entry);
  }
  return table;
}

// By default glibc gives freed memory back to the system at once where there is more of it than twice the largest array
// so far, and every page of the next arrays has to be asked for anew.
void keep_freed_memory(int megabytes) {
  if (megabytes < 0) throw nb::value_error("megabytes: not negative");
#ifdef __GLIBC__
  const int largest_array = 32;  // MB: what glibc takes at most
  mallopt(M_MMAP_THRESHOLD, (megabytes < largest_array ? megabytes : largest_array) << 20);
  mallopt(M_TRIM_THRESHOLD, (megabytes < 1024 ? megabytes : 1024) << 20);
#endif
}

}  // namespace

const KernelUnit& unit_or_throw(int lanes) {
  const KernelUnit* unit = kernel_unit(lanes);
  if (!unit) throw nb::value_error("lanes: this width is not available on this machine; 0 asks for the widest");
  return *unit;
}

NB_MODULE(_kernel, m) {
  // what Python still remembers as it ends is no leak, and no word for users
  nb::set_leak_warnings(false);
  m.doc() = "Compiled core of mechkin: closure, motion and reactions of a planned mechanism, in lanes.";
  m.attr("widest") = kernel_unit()->lanes;
  nb::dict widths;
  for (int lanes : {2, 4, 8})
    if (kernel_unit(lanes)) widths[nb::int_(lanes)] = instructions(lanes);
  m.attr("instructions") = widths;
  m.def("joint_table", &joint_table);
  m.def("tree_table", &tree_table);
  m.def("keep_freed_memory", &keep_freed_memory, "megabytes"_a);
  m.def("elementwise", &elementwise, "operation"_a, "x"_a, "y"_a, "lanes"_a = 0);
  bind_text(m);
  bind_codes(m);
  bind_plan(m);
  bind_tape(m);
  bind_course(m);
  bind_eigenvalues(m);
  bind_stepper(m);
  bind_variants(m);
  bind_positions(m);
  bind_integrator(m);
  bind_response(m);
  bind_certify(m);
  bind_enclosing(m);
}
