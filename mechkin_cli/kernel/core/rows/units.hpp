// Choice of the instruction set, and the floating-point state that every entry of the kernel needs.
#pragma once

#include "proofs/enclosing_unit.hpp"
#include "response/motion_unit.hpp"
#include "rows/double_double_unit.hpp"
#include "rows/unit.hpp"

// The widest unit that the processor and the operating system support; `lanes` 2, 4 or 8 asks for that
// width. Returns nullptr if it is not available.
const KernelUnit* kernel_unit(int lanes = 0);
// The equations of motion of the same width.
const MotionUnit* motion_unit(int lanes = 0);

// What a width needs of the processor, as people call it.
const char* instructions(int lanes);

// Round to nearest, denormals kept, for the life of the object; the caller's state comes back after it.
class FloatingPointState {
 public:
  FloatingPointState();
  ~FloatingPointState();
  FloatingPointState(const FloatingPointState&) = delete;
  FloatingPointState& operator=(const FloatingPointState&) = delete;

 private:
  unsigned saved_;
};
