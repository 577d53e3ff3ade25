#include "tape/tape_store.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "new_array.hpp"
#include "plan/requirements.hpp"
#include "rows/units.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

constexpr std::size_t LONGEST = 1 << 30;  // registers, outputs and guards are counted by int

template <class Number>
using Row = nb::ndarray<const Number, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
template <class Number>
using Rows = nb::ndarray<const Number, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

template <class Number>
using Blocks = nb::ndarray<const Number, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

template <class Number>
std::vector<Number> copy_of(const Row<Number>& a) {
  return {a.data(), a.data() + a.shape(0)};
}
template <class Number>
std::vector<Number> copy_of(const Rows<Number>& a) {
  if (a.shape(1) != 3) throw nb::value_error("three numbers an entry");
  return {a.data(), a.data() + 3 * a.shape(0)};
}

// inputs x count to (outputs (count, outputs), verdicts (count,) of TapeVerdict).
nb::tuple replay(const TapeStore& store, Rows<double> inputs, int lanes) {
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
nb::tuple replay_precise(const TapeStore& store, Blocks<double> inputs, std::optional<Row<double>> second, int lanes) {
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
nb::object jets(const TapeStore& store, Rows<double> inputs, Row<double> ways) {
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

int TapeStore::switches() const {
  int count = 0;
  for (std::uint8_t o : operations_)
    count += o == TAPE_MAGNITUDE || o == TAPE_SIGN || o == TAPE_LARGER || o == TAPE_SMALLER ||
             (o >= TAPE_LESS && o <= TAPE_WHOLE);
  return count;
}

TapeStore::TapeStore(int inputs, std::vector<double> constants, std::vector<std::uint8_t> operations,
                     std::vector<std::int32_t> operands, std::vector<std::int32_t> outputs,
                     std::vector<std::int32_t> guards, std::vector<std::uint8_t> expected,
                     std::vector<std::uint8_t> advice)
    : constants_(std::move(constants)), operations_(std::move(operations)), operands_(std::move(operands)),
      outputs_(std::move(outputs)), guards_(std::move(guards)), expected_(std::move(expected)),
      advice_(std::move(advice)) {
  require(inputs > 0, "a tape has inputs");
  for (std::size_t size : {constants_.size(), operations_.size(), outputs_.size(), expected_.size()})
    require(size < LONGEST, "the tape is too long");
  require(operands_.size() == 3 * operations_.size(), "three operands an instruction");
  require(guards_.size() == 3 * expected_.size() && advice_.size() == expected_.size(), "three numbers a guard");
  const long first = inputs + (long)constants_.size(), last = first + (long)operations_.size();
  require(last < (long)LONGEST, "the tape is too long");
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    require(operations_[i] < TAPE_OPERATIONS, "unknown operation");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t r = operands_[3 * i + k];
      require(r >= 0 && r < first + (long)i, "an operand lies before its instruction");
    }
  }
  for (std::int32_t r : outputs_) require(r >= 0 && r < last, "unknown register");
  for (std::size_t g = 0; g < expected_.size(); ++g) {
    const int condition = guards_[3 * g];
    require(condition >= TAPE_LESS && condition <= TAPE_EQUAL, "a guard asks for a comparison");
    for (int k = 1; k < 3; ++k) require(guards_[3 * g + k] >= 0 && guards_[3 * g + k] < last, "unknown register");
  }
  tape_ = {inputs, (int)constants_.size(), (int)operations_.size(), (int)outputs_.size(), (int)expected_.size(),
           constants_.data(), operations_.data(), operands_.data(), outputs_.data(), guards_.data(), expected_.data(),
           advice_.data()};
}

void bind_tape(nb::module_& m) {
  nb::class_<TapeStore>(m, "Tape")
      .def("__init__",
           [](TapeStore* self, int inputs, Row<double> constants, Row<std::uint8_t> operations,
              Rows<std::int32_t> operands, Row<std::int32_t> outputs, Rows<std::int32_t> guards,
              Row<std::uint8_t> expected, Row<std::uint8_t> advice) {
             new (self) TapeStore(inputs, copy_of(constants), copy_of(operations), copy_of(operands), copy_of(outputs),
                                  copy_of(guards), copy_of(expected), copy_of(advice));
           },
           "inputs"_a, "constants"_a, "operations"_a, "operands"_a, "outputs"_a, "guards"_a, "expected"_a, "advice"_a)
      .def("replay", &replay, "inputs"_a, "lanes"_a = 0)
      .def("replay_precise", &replay_precise, "inputs"_a, "second"_a = nb::none(), "lanes"_a = 0)
      .def("jets", &jets, "inputs"_a, "ways"_a);
}
