// The operations of `elementwise`, by the numbers under which `kernel/functions.py` asks for them.
#pragma once

enum Operation : int {
  OPERATION_SIN = 0,
  OPERATION_COS,
  OPERATION_TAN,
  OPERATION_ASIN,
  OPERATION_ACOS,
  OPERATION_ATAN,
  OPERATION_ATAN2,  // of (y, x)
  OPERATION_EXP,
  OPERATION_LOG,
  OPERATION_POWER,  // base, exponent
  OPERATION_COUNT
};
