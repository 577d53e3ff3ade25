// Functions of one coordinate or more as data, with their derivatives: what a term of a relation is, or a curve.
//
// A function takes its arguments in SI and gives its outputs in SI: the values of its components, then their first
// derivatives, their second and third ones. What computes the derivatives of an order stands behind what computes those
// of the orders before, so that a run to an order is the first part of the tape (plan/functions.py records it).
#pragma once

#include "plan/program.hpp"

constexpr int FUNCTION_ORDERS = 4;  // value, and three derivatives

// A curve of knots over an argument: four registers, its value and derivatives; straight beyond its ends. One that repeats
// itself has its knots' span as its period, into which arguments are taken first.
struct FunctionCurve {
  int over;        // argument
  int begin, end;  // into Plan::function_knot
  bool repeats;
};

// Registers: arguments, four of each curve, constants, results.
struct Function {
  int arguments;
  int curve_begin, curve_end;
  int constant_begin, constant_end;  // into Plan::function_constant
  int instruction_begin;
  int instructions[FUNCTION_ORDERS];  // up to each order
  int output_begin;
  int outputs[FUNCTION_ORDERS];       // up to each order
  int constants_at() const { return arguments + FUNCTION_ORDERS * (curve_end - curve_begin); }
  int results_at() const { return constants_at() + constant_end - constant_begin; }
  int registers() const { return results_at() + instructions[FUNCTION_ORDERS - 1]; }
};

// The functions of a plan, one after the other, but for their constants and knots.
struct FunctionTable {
  int functions, curves, knots, constants, instructions, outputs;
  int registers;  // of the largest
  const Function* function;
  const FunctionCurve* curve;
  const std::uint8_t* operation;
  const std::int32_t* operand;  // instructions x 3: registers
  const std::int32_t* output;   // registers
};
