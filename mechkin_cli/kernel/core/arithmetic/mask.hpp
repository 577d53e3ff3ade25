// Lanes of doubles as a compiler vector, and masks of lanes.
//
// A mask is what the instruction set compares into: eight bits where there are mask registers (AVX-512), else a vector
// with all bits of a lane set or none.
#pragma once

#include <cstdint>
#include <cstring>

#ifndef MECHKIN_LANES
#error "MECHKIN_LANES must be defined by the build (2, 4 or 8)"
#endif

#if !defined(__GNUC__)
#error "the kernel needs the vector extensions of GCC >= 11 or Clang >= 16"
#endif
#define MECHKIN_INLINE inline __attribute__((always_inline))

#if MECHKIN_LANES == 8 && defined(__AVX512DQ__)
#define MECHKIN_MASK_REGISTERS
#include <immintrin.h>
#elif MECHKIN_LANES == 4 && defined(__AVX__)
#define MECHKIN_MASK_BITS  // of a vector, all at once
#include <immintrin.h>
#endif

namespace {

constexpr int LANES = MECHKIN_LANES;

typedef double Doubles __attribute__((vector_size(8 * LANES)));
typedef std::int64_t Words __attribute__((vector_size(8 * LANES)));
typedef std::uint64_t Naturals __attribute__((vector_size(8 * LANES)));

#ifdef MECHKIN_MASK_REGISTERS

struct Mask {
  __mmask8 bits;  // bit i: lane i
  friend MECHKIN_INLINE Mask operator&(Mask a, Mask b) { return {(__mmask8)(a.bits & b.bits)}; }
  friend MECHKIN_INLINE Mask operator|(Mask a, Mask b) { return {(__mmask8)(a.bits | b.bits)}; }
  friend MECHKIN_INLINE Mask operator~(Mask a) { return {(__mmask8)~a.bits}; }
};
MECHKIN_INLINE Mask is_less(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ)}; }
MECHKIN_INLINE Mask is_at_most(Doubles a, Doubles b) {
  return {_mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ)};
}
MECHKIN_INLINE Mask is_equal(Doubles a, Doubles b) { return {_mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_EQ_OQ)}; }
MECHKIN_INLINE Doubles choose(Mask c, Doubles a, Doubles b) {
  return (Doubles)_mm512_mask_blend_pd(c.bits, (__m512d)b, (__m512d)a);
}
MECHKIN_INLINE Words words(Mask m) { return (Words)_mm512_movm_epi64(m.bits); }
MECHKIN_INLINE Mask mask_of(Words w) { return {_mm512_movepi64_mask((__m512i)w)}; }
MECHKIN_INLINE bool lane(Mask m, int i) { return m.bits >> i & 1; }
MECHKIN_INLINE Mask all_lanes(bool value) { return {(__mmask8)-(int)value}; }
MECHKIN_INLINE bool any(Mask m) { return m.bits != 0; }
MECHKIN_INLINE bool all(Mask m) { return m.bits == 0xff; }

#else

struct Mask {
  Words w;
  friend MECHKIN_INLINE Mask operator&(Mask a, Mask b) { return {a.w & b.w}; }
  friend MECHKIN_INLINE Mask operator|(Mask a, Mask b) { return {a.w | b.w}; }
  friend MECHKIN_INLINE Mask operator~(Mask a) { return {~a.w}; }
};
MECHKIN_INLINE Mask is_less(Doubles a, Doubles b) { return {(Words)(a < b)}; }
MECHKIN_INLINE Mask is_at_most(Doubles a, Doubles b) { return {(Words)(a <= b)}; }
MECHKIN_INLINE Mask is_equal(Doubles a, Doubles b) { return {(Words)(a == b)}; }
MECHKIN_INLINE Words words(Mask m) { return m.w; }
MECHKIN_INLINE bool lane(Mask m, int i) { return m.w[i] != 0; }
MECHKIN_INLINE Mask all_lanes(bool value) { return {Words{} - (std::int64_t)value}; }
MECHKIN_INLINE Mask mask_of(Words w) { return {w}; }

#ifdef MECHKIN_MASK_BITS

MECHKIN_INLINE Doubles choose(Mask c, Doubles a, Doubles b) {
  return (Doubles)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)c.w);
}
MECHKIN_INLINE bool any(Mask m) { return _mm256_movemask_pd((__m256d)m.w) != 0; }
MECHKIN_INLINE bool all(Mask m) { return _mm256_movemask_pd((__m256d)m.w) == 0xf; }

#else

MECHKIN_INLINE Doubles choose(Mask c, Doubles a, Doubles b) { return (Doubles)(((Words)a & c.w) | ((Words)b & ~c.w)); }
MECHKIN_INLINE bool any(Mask m) {
  std::int64_t r = 0;
  for (int i = 0; i < LANES; ++i) r |= m.w[i];
  return r != 0;
}
MECHKIN_INLINE bool all(Mask m) {
  std::int64_t r = -1;
  for (int i = 0; i < LANES; ++i) r &= m.w[i];
  return r != 0;
}

#endif
#endif

}  // namespace
