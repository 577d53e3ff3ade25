#include "text/checksum.hpp"

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace {

constexpr std::uint32_t POLYNOMIAL = 0xEDB88320;  // the highest power in the lowest bit

// The remainder of each byte.
struct Remainders {
  std::uint32_t of[256] = {};
  constexpr Remainders() {
    for (std::uint32_t b = 0; b < 256; ++b) {
      std::uint32_t rest = b;
      for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ (rest & 1 ? POLYNOMIAL : 0);
      of[b] = rest;
    }
  }
};

constexpr Remainders REMAINDERS;

#if defined(__x86_64__)

constexpr std::size_t STEP = 64;

bool has_products() {
  unsigned a, b, c, d;
  return __get_cpuid(1, &a, &b, &c, &d) && (c & 2u);
}

__attribute__((target("pclmul"))) inline __m128i sixteen(const std::uint8_t* bytes) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
}

// Moves a remainder over the bytes that the powers stand for, and adds what lies there.
__attribute__((target("pclmul"))) inline __m128i folded(__m128i rest, __m128i powers, __m128i there) {
  const __m128i low = _mm_clmulepi64_si128(rest, powers, 0x00), high = _mm_clmulepi64_si128(rest, powers, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), there);
}

// Of whole groups of sixteen bytes, STEP at least.
__attribute__((target("pclmul"))) std::uint32_t by_products(const std::uint8_t* bytes, std::size_t count, std::uint32_t rest) {
  // remainders of the powers 4*128+-32, 128+-32 and 64, and the polynomial with its reciprocal, mirrored (section 4 there)
  const __m128i over_four = _mm_set_epi64x(0x1c6e41596, 0x154442bd4), over_one = _mm_set_epi64x(0x0ccaa009e, 0x1751997d0);
  const __m128i over_half = _mm_set_epi64x(0, 0x163cd6124), reduction = _mm_set_epi64x(0x1f7011641, 0x1db710641);
  __m128i x[4];
  for (int k = 0; k < 4; ++k) x[k] = sixteen(bytes + 16 * k);
  x[0] = _mm_xor_si128(x[0], _mm_cvtsi32_si128((int)rest));
  for (bytes += STEP, count -= STEP; count >= STEP; bytes += STEP, count -= STEP)
    for (int k = 0; k < 4; ++k) x[k] = folded(x[k], over_four, sixteen(bytes + 16 * k));
  for (int k = 1; k < 4; ++k) x[0] = folded(x[0], over_one, x[k]);
  for (; count >= 16; bytes += 16, count -= 16) x[0] = folded(x[0], over_one, sixteen(bytes));
  // to 96 bits, to 64, and by the reciprocal to 32
  const __m128i low_words = _mm_set_epi32(0, -1, 0, -1);
  __m128i y = _mm_xor_si128(_mm_srli_si128(x[0], 8), _mm_clmulepi64_si128(x[0], over_one, 0x10));
  y = _mm_xor_si128(_mm_srli_si128(y, 4), _mm_clmulepi64_si128(_mm_and_si128(y, low_words), over_half, 0x00));
  __m128i quotient = _mm_clmulepi64_si128(_mm_and_si128(y, low_words), reduction, 0x10);
  quotient = _mm_clmulepi64_si128(_mm_and_si128(quotient, low_words), reduction, 0x00);
  return (std::uint32_t)_mm_cvtsi128_si32(_mm_srli_si128(_mm_xor_si128(y, quotient), 4));
}

#endif

}  // namespace

bool has_fast_checksum() {
#if defined(__x86_64__)
  static const bool found = has_products();
  return found;
#else
  return false;
#endif
}

std::uint32_t checksum(const std::uint8_t* bytes, std::size_t count, std::uint32_t before) {
  std::uint32_t rest = ~before;
#if defined(__x86_64__)
  if (has_fast_checksum() && count >= STEP) {
    const std::size_t whole = count - count % 16;
    rest = by_products(bytes, whole, rest);
    bytes += whole, count -= whole;
  }
#endif
  for (; count; ++bytes, --count) rest = rest >> 8 ^ REMAINDERS.of[(rest ^ *bytes) & 0xFF];
  return ~rest;
}
