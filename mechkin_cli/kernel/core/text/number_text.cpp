#include "text/number_text.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>

namespace {

bool is_finite(double x) { return x - x == 0; }

// Shortest digits, without an exponent for least <= |x| < 1e16.
std::size_t shortest(double x, double least, char* out) {
  const double magnitude = x < 0 ? -x : x;
  if (magnitude == 0) {
    *out = '0';
    return 1;
  }
  const bool plain = magnitude >= least && magnitude < 1e16;
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  return (std::size_t)(std::to_chars(out, out + NUMBER_TEXT_SIZE, x, format).ptr - out);
}

}  // namespace

std::size_t number_text(double x, char* out) { return is_finite(x) ? shortest(x, 1e-5, out) : 0; }

std::size_t number_text(double x, int significant_digits, char* out) {
  char* const limit = out + NUMBER_TEXT_SIZE;
  const auto end = std::to_chars(out, limit, x, std::chars_format::scientific, significant_digits - 1).ptr;
  double rounded = x;  // stays so when the rounded text overflows or is not a number
  std::from_chars(out, end, rounded);
  return number_text(rounded, out);
}

std::size_t json_text(double x, char* out) {
  if (is_finite(x)) return shortest(x, 1e-4, out);
  std::memcpy(out, "null", 4);
  return 4;
}

namespace {

using Wide = unsigned __int128;

constexpr int MOST_EXACT_DECIMALS = 22;  // 53 bits times 10^22 are 127 bits
constexpr Wide LARGEST_SCALED = (Wide)1 << 64;

Wide power_of_ten(int exponent) {
  Wide power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

// |x| * 10^decimals, the exact value rounded to a whole number, ties to even; false where it is not below 2^64.
bool scaled_exactly(double magnitude, int decimals, std::uint64_t& scaled) {
  std::uint64_t bits;
  std::memcpy(&bits, &magnitude, sizeof bits);
  const int raised = (int)(bits >> 52);
  const std::uint64_t fraction = bits & (((std::uint64_t)1 << 52) - 1);
  const std::uint64_t mantissa = raised ? fraction | (std::uint64_t)1 << 52 : fraction;
  const int down = 1075 - (raised ? raised : 1);  // magnitude = mantissa / 2^down
  if (decimals > MOST_EXACT_DECIMALS || down <= 0) return false;
  const Wide product = mantissa * power_of_ten(decimals);
  if (down >= 128) {  // below a half
    scaled = 0;
    return true;
  }
  const Wide whole = product >> down, rest = product - (whole << down), half = (Wide)1 << (down - 1);
  const Wide rounded = whole + (rest > half || (rest == half && (whole & 1)));
  if (rounded >= LARGEST_SCALED) return false;
  scaled = (std::uint64_t)rounded;
  return true;
}

// The digits of `scaled`, at least decimals + 1 of them, with a point before the last `decimals`.
std::size_t with_point(std::uint64_t scaled, int decimals, char* out) {
  char digits[48];
  int count = 0;
  do {
    digits[count++] = (char)('0' + scaled % 10);
    scaled /= 10;
  } while (scaled);
  while (count <= decimals) digits[count++] = '0';
  char* at = out;
  while (count > decimals) *at++ = digits[--count];
  if (decimals) *at++ = '.';
  while (count) *at++ = digits[--count];
  return (std::size_t)(at - out);
}

}  // namespace

std::size_t fixed_text(double x, int decimals, char* out) {
  if (!is_finite(x)) return 0;
  const double magnitude = x < 0 ? -x : x;
  std::uint64_t scaled;
  if (scaled_exactly(magnitude, decimals, scaled)) {
    const bool sign = x < 0 && scaled;
    if (sign) *out = '-';
    return with_point(scaled, decimals, out + sign) + sign;
  }
  char* const end = std::to_chars(out, out + decimal_text_size(decimals), x, std::chars_format::fixed, decimals).ptr;
  char* first = out;
  while (first < end && (*first == '-' || *first == '0' || *first == '.')) ++first;
  const std::size_t size = (std::size_t)(end - out);
  if (first < end || *out != '-') return size;
  std::memmove(out, out + 1, size - 1);
  return size - 1;
}

std::size_t scientific_text(double x, int decimals, char* out) {
  if (!is_finite(x)) return 0;
  if (x == 0) {
    *out = '0';
    return 1;
  }
  char* const limit = out + decimal_text_size(decimals);
  return (std::size_t)(std::to_chars(out, limit, x, std::chars_format::scientific, decimals).ptr - out);
}
