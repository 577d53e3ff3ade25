#include "rows/units.hpp"

#if MECHKIN_X86
#include <cpuid.h>
#include <xmmintrin.h>
#endif

namespace {

#if MECHKIN_WIDE
// The lanes whose instructions the processor has and whose registers the operating system saves (XCR0). Asked of the
// processor itself: what `__builtin_cpu_supports` reads is not linked with Clang on Windows.
int widest_lanes() {
  unsigned a, b, c, d, saved, upper;
  constexpr unsigned OSXSAVE = 1u << 27, AVX = 1u << 28;
  if (!__get_cpuid(1, &a, &b, &c, &d) || (c & (OSXSAVE | AVX)) != (OSXSAVE | AVX)) return 2;
  __asm__ volatile("xgetbv" : "=a"(saved), "=d"(upper) : "c"(0));
  if (!__get_cpuid_count(7, 0, &a, &b, &c, &d)) return 2;
  constexpr unsigned AVX2 = 1u << 5, AVX512 = 1u << 16 | 1u << 17 | 1u << 31;  // F, DQ, VL
  constexpr unsigned YMM = 0x06, ZMM = 0xe6;
  if ((saved & YMM) != YMM || !(b & AVX2)) return 2;
  return (saved & ZMM) == ZMM && (b & AVX512) == AVX512 ? 8 : 4;
}
#endif

const KernelUnit* widest() {
#if MECHKIN_WIDE
  const int lanes = widest_lanes();
  if (lanes == 8) return mechkin_unit_avx512();
  if (lanes == 4) return mechkin_unit_avx2();
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

const char* instructions([[maybe_unused]] int lanes) {
#if MECHKIN_X86
  return lanes == 8 ? "AVX-512" : lanes == 4 ? "AVX2" : "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#elif defined(__wasm_simd128__)
  return "SIMD128";
#else
  return "baseline";
#endif
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
#elif defined(__aarch64__)
// 0 in FPCR: round to nearest, no flush-to-zero, NaNs as they are
FloatingPointState::FloatingPointState() : saved_(0) {
  unsigned long long state;
  __asm__ volatile("mrs %0, fpcr" : "=r"(state));
  saved_ = (unsigned)state;
  state = 0;
  __asm__ volatile("msr fpcr, %0" ::"r"(state) : "memory");
}
FloatingPointState::~FloatingPointState() {
  const unsigned long long state = saved_;
  __asm__ volatile("msr fpcr, %0" ::"r"(state) : "memory");
}
#else
FloatingPointState::FloatingPointState() : saved_(0) {}
FloatingPointState::~FloatingPointState() {}
#endif
