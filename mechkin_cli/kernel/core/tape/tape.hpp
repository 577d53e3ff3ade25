// A tape: the arithmetic from a few numbers given to the numbers computed of them, as plain data that every compiled
// unit replays (tape/tape.py says what the operations are).
#pragma once

#include <cstdint>

enum TapeOperation : std::uint8_t {
  TAPE_ADD = 0,
  TAPE_SUBTRACT,
  TAPE_MULTIPLY,
  TAPE_DIVIDE,
  TAPE_NEGATE,
  TAPE_MAGNITUDE,
  TAPE_SQUARE_ROOT,
  TAPE_LARGER,   // b where b > a, else a
  TAPE_SMALLER,  // b where b < a, else a
  TAPE_CHOOSE,   // b where a is not zero, else c
  TAPE_LESS,
  TAPE_NOT_MORE,
  TAPE_EQUAL,
  TAPE_POWER_OF_TWO,  // next to a > 0
  TAPE_WHOLE,         // nearest whole number, |a| < 2^51
  TAPE_SIN,
  TAPE_COS,
  TAPE_TAN,
  TAPE_ASIN,
  TAPE_ACOS,
  TAPE_ATAN,
  TAPE_ATAN2,
  TAPE_EXP,
  TAPE_LOG,
  TAPE_POWER,
  TAPE_SIGN,  // 1 where a > 0, -1 where a < 0, else a
  TAPE_OPERATIONS
};

// Register k holds input k, then constant k - inputs, then the result of instruction k - inputs - constants.
struct Tape {
  int inputs, constants, instructions, outputs, guards;
  const double* constant;         // constants
  const std::uint8_t* operation;  // instructions
  const std::int32_t* operand;    // instructions x 3: registers that lie before
  const std::int32_t* output;     // registers
  const std::int32_t* guard;      // guards x 3: TAPE_LESS, TAPE_NOT_MORE or TAPE_EQUAL, and two registers
  const std::uint8_t* expected;   // guards: what each found when the tape was recorded
  const std::uint8_t* advice;     // guards: whether only a warning hangs on it
  int registers() const { return inputs + constants + instructions; }
};

// What the guards say of one set of inputs: as recorded, but for a warning, or another way of computing.
enum TapeVerdict : std::uint8_t { TAPE_SAME = 0, TAPE_OTHER_ADVICE = 1, TAPE_OTHER_WAY = 2 };

// Replays over many sets of inputs; numbers of the unit's arithmetic, of PARTS parts (pack.hpp).
struct TapeRequest {
  long count;            // sets of inputs
  const double* inputs;  // inputs x PARTS x count
  double* outputs;       // count x outputs x PARTS
  std::uint8_t* verdict;  // count
  const double* second = nullptr;  // constants: their second parts, where numbers have two; null: zero
};
