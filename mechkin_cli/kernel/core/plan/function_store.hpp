// Owns the functions of a plan, each checked as it is added.
#pragma once

#include <cstdint>
#include <vector>

#include "plan/functions.hpp"
#include "result.hpp"

struct FunctionCurveRecord {
  int over;
  bool repeats;
  std::vector<Knot> knots;  // x rising
};
struct FunctionRecord {
  int arguments;
  std::vector<FunctionCurveRecord> curves;
  std::vector<double> constants;
  std::vector<std::uint8_t> operations;
  std::vector<std::int32_t> operands;
  std::vector<int> instructions;  // up to each order
  std::vector<std::int32_t> outputs;
  std::vector<int> output_ends;   // up to each order
};

class FunctionStore {
 public:
  // The number of the function; refuses registers that are none, and numbers that are not finite.
  Result<int> add(const FunctionRecord& record);
  FunctionTable view() const;
  // Whether a function has so many arguments and components, with all derivatives.
  bool has_shape(int number, int arguments, int components) const;
  const std::vector<double>& constants() const { return constant_; }
  const std::vector<Knot>& knots() const { return knot_; }

 private:
  Refusal check(const FunctionRecord& record) const;

  int registers_ = 0;
  std::vector<Function> function_;
  std::vector<FunctionCurve> curve_;
  std::vector<Knot> knot_;
  std::vector<double> constant_;
  std::vector<std::uint8_t> operation_;
  std::vector<std::int32_t> operand_, output_;
};
