// The entries of a unit that computes in double-double: PARTS of numbers, high and low, on rows of their own (pack.hpp).
#pragma once

#include "tape.hpp"

struct DoubleDoubleUnit {
  int lanes;
  long (*replay_size)(const Tape&);
  void (*replay)(const Tape&, const TapeRequest&, char* workspace);
};

extern "C" {
const DoubleDoubleUnit* mechkin_double_double_sse2();
const DoubleDoubleUnit* mechkin_double_double_avx512();
}

// The widest that the machine has, or the widest of at most `lanes`; nothing that it computes depends on it.
const DoubleDoubleUnit& double_double_unit(int lanes = 0);
