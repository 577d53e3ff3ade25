#include "rows/units.hpp"

#if MECHKIN_X86
#include <xmmintrin.h>
#endif

namespace {

const KernelUnit* widest() {
#if MECHKIN_WIDE
  // these builtins ask both cpuid and XCR0: the operating system must save the wide registers
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return mechkin_unit_avx512();
  if (__builtin_cpu_supports("avx2")) return mechkin_unit_avx2();
#endif
  return mechkin_unit_sse2();
}

}  // namespace

const MotionUnit* motion_unit(int lanes) {
  const KernelUnit* const unit = kernel_unit(lanes);
  if (!unit) return nullptr;
#if MECHKIN_WIDE
  if (unit->lanes == 8) return mechkin_motion_avx512();
  if (unit->lanes == 4) return mechkin_motion_avx2();
#endif
  return mechkin_motion_sse2();
}

const KernelUnit* kernel_unit(int lanes) {
  static const KernelUnit* const best = widest();
  if (lanes == 0 || lanes == best->lanes) return best;
  if (lanes == 2) return mechkin_unit_sse2();
#if MECHKIN_WIDE
  if (lanes == 4 && best->lanes > 4) return mechkin_unit_avx2();
#endif
  return nullptr;
}

const DoubleDoubleUnit& double_double_unit([[maybe_unused]] int lanes) {
#if MECHKIN_WIDE
  if ((lanes == 0 || lanes >= 8) && kernel_unit()->lanes == 8) return *mechkin_double_double_avx512();
#endif
  return *mechkin_double_double_sse2();
}

const EnclosingUnit& enclosing_unit([[maybe_unused]] int lanes) {
#if MECHKIN_WIDE
  if ((lanes == 0 || lanes >= 8) && kernel_unit()->lanes == 8) return *mechkin_enclosing_avx512();
#endif
  return *mechkin_enclosing_sse2();
}

#if MECHKIN_X86
// 0x1f80: all exceptions masked, round to nearest, no flush-to-zero, no denormals-are-zero
FloatingPointState::FloatingPointState() : saved_(_mm_getcsr()) { _mm_setcsr(0x1f80); }
FloatingPointState::~FloatingPointState() { _mm_setcsr(saved_); }
#else
FloatingPointState::FloatingPointState() : saved_(0) {}
FloatingPointState::~FloatingPointState() {}
#endif
