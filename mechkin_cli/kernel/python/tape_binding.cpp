// Python's view of tapes.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>

#include <optional>
#include <vector>

#include "bindings.hpp"
#include "new_array.hpp"
#include "refusals.hpp"
#include "rows/units.hpp"
#include "tape/tape_store.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

template <class Number>
using List = nb::ndarray<const Number, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class Number>
using Lists = nb::ndarray<const Number, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

template <class Number>
using Blocks = nb::ndarray<const Number, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

template <class Number>
std::vector<Number> entries_of(const List<Number>& a) {
  return {a.data(), a.data() + a.shape(0)};
}
template <class Number>
std::vector<Number> entries_of(const Lists<Number>& a) {
  if (a.shape(1) != 3) throw nb::value_error("three numbers an entry");
  return {a.data(), a.data() + 3 * a.shape(0)};
}

// inputs x count to (outputs (count, outputs), verdicts (count,) of TapeVerdict).
nb::tuple replay(const TapeStore& store, Lists<double> inputs, int lanes) {
  const Tape& t = store.view();
  const KernelUnit* const unit = kernel_unit(lanes);
  if (!unit) throw nb::value_error("this width is not available on this machine; 0 asks for the widest");
  if (inputs.shape(0) != (std::size_t)t.inputs) throw nb::value_error("one row of numbers per input of the tape");
  const std::size_t count = inputs.shape(1);
  double* outputs;
  std::uint8_t* verdicts;
  auto out = new_array<double>(&outputs, {count, (std::size_t)t.outputs});
  auto verdict = new_array<std::uint8_t>(&verdicts, {count});
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    std::vector<char> memory(unit->replay_size(t));
    unit->replay(t, {(long)count, inputs.data(), outputs, verdicts}, memory.data());
  }
  return nb::make_tuple(out, verdict);
}

// The same in double-double: inputs x 2 x count, high and low, to (outputs (count, outputs, 2), verdicts (count,)).
// `second` (constants,): low parts of the tape's constants.
nb::tuple replay_precise(const TapeStore& store, Blocks<double> inputs, std::optional<List<double>> second, int lanes) {
  const Tape& t = store.view();
  const DoubleDoubleUnit& unit = double_double_unit(lanes);
  if (inputs.shape(0) != (std::size_t)t.inputs || inputs.shape(1) != 2)
    throw nb::value_error("two rows of numbers, high and low, per input of the tape");
  if (second && second->shape(0) != (std::size_t)t.constants)
    throw nb::value_error("one low part for each constant of the tape");
  const std::size_t count = inputs.shape(2);
  double* outputs;
  std::uint8_t* verdicts;
  auto out = new_array<double>(&outputs, {count, (std::size_t)t.outputs, 2});
  auto verdict = new_array<std::uint8_t>(&verdicts, {count});
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    std::vector<char> memory(unit.replay_size(t));
    unit.replay(t, {(long)count, inputs.data(), outputs, verdicts, second ? second->data() : nullptr}, memory.data());
  }
  return nb::make_tuple(out, verdict);
}

// inputs x count and the ways of the switches to outputs with first and second derivatives by the first input
// (count, outputs, 3).
nb::object jets(const TapeStore& store, Lists<double> inputs, List<double> ways) {
  const Tape& t = store.view();
  if (inputs.shape(0) != (std::size_t)t.inputs) throw nb::value_error("one row of numbers per input of the tape");
  if (ways.shape(0) != (std::size_t)store.switches()) throw nb::value_error("one way for each switch of the tape");
  const std::size_t count = inputs.shape(1);
  double* out;
  auto found = new_array<double>(&out, {count, (std::size_t)t.outputs, 3});
  {
    nb::gil_scoped_release released;
    FloatingPointState state;
    const KernelUnit& unit = *kernel_unit(2);
    std::vector<char> memory(unit.jets_size(t));
    std::vector<double> given(t.inputs);
    for (std::size_t k = 0; k < count; ++k) {
      for (int i = 0; i < t.inputs; ++i) given[i] = inputs.data()[i * count + k];
      unit.replay_jets(t, given.data(), ways.data(), out + k * 3 * t.outputs, memory.data());
    }
  }
  return nb::cast(found);
}

}  // namespace

void bind_tape(nb::module_& m) {
  nb::class_<TapeStore>(m, "Tape")
      .def("__init__",
           [](TapeStore* self, int inputs, List<double> constants, List<std::uint8_t> operations,
              Lists<std::int32_t> operands, List<std::int32_t> outputs, Lists<std::int32_t> guards,
              List<std::uint8_t> expected, List<std::uint8_t> advice) {
             new (self) TapeStore(value_of(TapeStore::make(inputs, entries_of(constants), entries_of(operations),
                                                           entries_of(operands), entries_of(outputs), entries_of(guards),
                                                           entries_of(expected), entries_of(advice))));
           },
           "inputs"_a, "constants"_a, "operations"_a, "operands"_a, "outputs"_a, "guards"_a, "expected"_a, "advice"_a)
      .def("replay", &replay, "inputs"_a, "lanes"_a = 0)
      .def("replay_precise", &replay_precise, "inputs"_a, "second"_a = nb::none(), "lanes"_a = 0)
      .def("jets", &jets, "inputs"_a, "ways"_a);
}
