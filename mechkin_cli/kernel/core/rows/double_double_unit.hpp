// The entries of a unit that computes in double-double: PARTS of numbers, high and low, on rows of their own (pack.hpp).
#pragma once

#include "plan/plan.hpp"
#include "tape/tape.hpp"

struct DoubleDoubleUnit {
  int lanes;
  // Bytes of the plan of high and low constants, each a plan of one structure (null: no low ones); writes it, where there
  // is memory.
  long (*join)(const PlanOf<double>& high, const PlanOf<double>* low, char* memory);
  long (*workspace_size)(const char* plan);
  // Rows [begin, end) alone; what a row gets does not depend on the cut. Arrays of numbers have two rows of doubles each.
  void (*run_rows)(const char* plan, const Request&, long begin, long end, char* workspace);
  long (*replay_size)(const Tape&);
  void (*replay)(const Tape&, const TapeRequest&, char* workspace);
};

extern "C" {
const DoubleDoubleUnit* mechkin_double_double_sse2();
const DoubleDoubleUnit* mechkin_double_double_avx512();
}

// The widest that the machine has, or the widest of at most `lanes`; nothing that it computes depends on it.
const DoubleDoubleUnit& double_double_unit(int lanes = 0);
