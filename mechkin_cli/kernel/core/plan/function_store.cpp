#include "plan/function_store.hpp"

#include "plan/frozen_plan.hpp"
#include "tape/tape.hpp"

namespace {

constexpr std::size_t LONGEST_FUNCTION = 1 << 24;  // of each list: registers are counted by int

// Whether counts up to each order rise to the whole.
bool are_ends(const std::vector<int>& ends, std::size_t whole) {
  if (ends.size() != FUNCTION_ORDERS || ends[0] < 0 || (std::size_t)ends.back() != whole) return false;
  for (int k = 1; k < FUNCTION_ORDERS; ++k)
    if (ends[k] < ends[k - 1]) return false;
  return true;
}

Refusal check_curve(const FunctionCurveRecord& c, int arguments) {
  REQUIRE(c.over >= 0 && c.over < arguments, "a curve runs over an argument");
  REQUIRE(!c.knots.empty() && c.knots.size() < LONGEST_FUNCTION, "a curve has points, and not too many");
  REQUIRE(!c.repeats || c.knots.size() > 1, "a curve that repeats itself has a span");
  for (std::size_t k = 0; k < c.knots.size(); ++k) {
    const Knot& at = c.knots[k];
    const double numbers[] = {at.x, at.y, at.b, at.c, at.d};
    REQUIRE(all_finite(numbers, 5), "a curve's numbers must be finite");
    REQUIRE(k == 0 || at.x > c.knots[k - 1].x, "a curve's points rise");
  }
  return {};
}

}  // namespace

Refusal FunctionStore::check(const FunctionRecord& r) const {
  REQUIRE(r.arguments >= 1, "a function has an argument");
  for (const std::vector<std::size_t>& sizes :
       {std::vector<std::size_t>{r.constants.size(), constant_.size()}, {r.operations.size(), operation_.size()},
        {r.outputs.size(), output_.size()}, {r.curves.size(), curve_.size()}})
    REQUIRE(sizes[0] + sizes[1] < LONGEST_FUNCTION, "the functions are too long");
  for (const FunctionCurveRecord& c : r.curves) CHECK(check_curve(c, r.arguments));
  REQUIRE(all_finite(r.constants.data(), r.constants.size()), "a function's numbers must be finite");
  REQUIRE(r.operands.size() == 3 * r.operations.size(), "three operands an instruction");
  REQUIRE(are_ends(r.instructions, r.operations.size()), "instructions are counted up to each order");
  REQUIRE(!r.outputs.empty() && are_ends(r.output_ends, r.outputs.size()), "outputs are counted up to each order");
  const long first = r.arguments + FUNCTION_ORDERS * (long)r.curves.size() + (long)r.constants.size();
  for (std::size_t i = 0; i < r.operations.size(); ++i) {
    REQUIRE(r.operations[i] < TAPE_OPERATIONS, "unknown operation");
    for (int k = 0; k < 3; ++k) {
      const std::int32_t operand = r.operands[3 * i + k];
      REQUIRE(operand >= 0 && operand < first + (long)i, "an operand lies before its instruction");
    }
  }
  for (int order = 0; order < FUNCTION_ORDERS; ++order)
    for (int k = order ? r.output_ends[order - 1] : 0; k < r.output_ends[order]; ++k)
      REQUIRE(r.outputs[k] >= 0 && r.outputs[k] < first + r.instructions[order], "an output is computed up to its order");
  return {};
}

Result<int> FunctionStore::add(const FunctionRecord& r) {
  CHECK(check(r));
  Function f = {};
  f.arguments = r.arguments;
  f.curve_begin = (int)curve_.size(), f.constant_begin = (int)constant_.size();
  f.instruction_begin = (int)operation_.size(), f.output_begin = (int)output_.size();
  for (const FunctionCurveRecord& c : r.curves) {
    const int begin = (int)knot_.size();
    knot_.insert(knot_.end(), c.knots.begin(), c.knots.end());
    curve_.push_back({c.over, begin, (int)knot_.size(), c.repeats});
  }
  constant_.insert(constant_.end(), r.constants.begin(), r.constants.end());
  operation_.insert(operation_.end(), r.operations.begin(), r.operations.end());
  operand_.insert(operand_.end(), r.operands.begin(), r.operands.end());
  output_.insert(output_.end(), r.outputs.begin(), r.outputs.end());
  f.curve_end = (int)curve_.size(), f.constant_end = (int)constant_.size();
  for (int k = 0; k < FUNCTION_ORDERS; ++k) f.instructions[k] = r.instructions[k], f.outputs[k] = r.output_ends[k];
  if (f.registers() > registers_) registers_ = f.registers();
  function_.push_back(f);
  return (int)function_.size() - 1;
}

bool FunctionStore::has_shape(int number, int arguments, int components) const {
  const Function& f = function_[number];
  int outputs = 0, derivatives = 1;  // of an order: as many as ways to choose its arguments
  for (int k = 0; k < FUNCTION_ORDERS; ++k) {
    outputs += components * derivatives;
    if (f.outputs[k] != outputs) return false;
    derivatives = derivatives * (arguments + k) / (k + 1);
  }
  return f.arguments == arguments;
}

FunctionTable FunctionStore::view() const {
  FunctionTable t = {};
  t.functions = (int)function_.size(), t.curves = (int)curve_.size(), t.knots = (int)knot_.size();
  t.constants = (int)constant_.size(), t.instructions = (int)operation_.size(), t.outputs = (int)output_.size();
  t.registers = registers_;
  t.function = function_.data(), t.curve = curve_.data();
  t.operation = operation_.data(), t.operand = operand_.data(), t.output = output_.data();
  return t;
}
