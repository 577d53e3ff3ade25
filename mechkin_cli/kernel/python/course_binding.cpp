// Python's view of a course.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "arrays.hpp"
#include "bindings.hpp"
#include "new_array.hpp"
#include "refusals.hpp"
#include "rows/units.hpp"
#include "stepping/course.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using PieceRecord = std::tuple<long, long, double, double, double, double>;

void need_piece(const Course& course, long piece) {
  if (piece < 0 || piece >= (long)course.pieces().size()) throw nb::value_error("no such piece");
}

// Inputs and their derivatives by the length of the way, (3, inputs).
nb::object at(const Course& course, long piece, double sigma) {
  need_piece(course, piece);
  PathPoint point;
  std::vector<char> memory;
  {
    FloatingPointState state;
    course.at(piece, sigma, &point, &memory);
  }
  double* data;
  auto found = new_array<double>(&data, {3, (std::size_t)course.inputs()});
  for (const auto* part : {&point.inputs, &point.first, &point.second}) data = std::copy(part->begin(), part->end(), data);
  return nb::cast(found);
}

}  // namespace

void bind_course(nb::module_& m) {
  nb::class_<Course>(m, "Course")
      .def("__init__",
           [](Course* self, const TapeStore& tape, const std::vector<PieceRecord>& pieces, Rows constants, Rows ways,
              Row units, Row parameter) {
             std::vector<CoursePiece> list;
             for (const auto& [first, last, begin, end, scale, power] : pieces)
               list.push_back({first, last, begin, end, scale, power});
             new (self) Course(value_of(make<Course>(tape, list, copy_of(constants), copy_of(ways), copy_of(units),
                                                     copy_of(parameter))));
           },
           "tape"_a, "pieces"_a, "constants"_a, "ways"_a, "units"_a, "parameter"_a, nb::keep_alive<1, 2>())
      .def("at", &at, "piece"_a, "sigma"_a)
      .def("sigma", [](const Course& c, long piece, double parameter) {
             need_piece(c, piece);
             return c.sigma(piece, parameter);
           }, "piece"_a, "parameter"_a)
      .def("parameter", [](const Course& c, long piece, double sigma) {
             need_piece(c, piece);
             return c.parameter(piece, sigma);
           }, "piece"_a, "sigma"_a);
}
