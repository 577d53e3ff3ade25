#include "text/number_text.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>

#include "text/shortest.hpp"

namespace {

bool is_finite(double x) { return x - x == 0; }

// Pairs of digits, "00" to "99".
struct Pairs {
  char text[200] = {};
  constexpr Pairs() {
    for (int i = 0; i < 100; ++i) {
      text[2 * i] = (char)('0' + i / 10);
      text[2 * i + 1] = (char)('0' + i % 10);
    }
  }
};

constexpr Pairs PAIRS;

void put_pair(std::uint32_t pair, char* out) { std::memcpy(out, PAIRS.text + 2 * pair, 2); }

void put_eight(std::uint32_t number, char* out) {
  const std::uint32_t high = number / 10000, low = number % 10000;
  put_pair(high / 100, out);
  put_pair(high % 100, out + 2);
  put_pair(low / 100, out + 4);
  put_pair(low % 100, out + 6);
}

constexpr int MOST_DIGITS = 17;  // of the shortest that a double needs

struct PowersOfTen {
  std::uint64_t of[MOST_DIGITS + 1] = {};
  constexpr PowersOfTen() {
    std::uint64_t power = 1;
    for (std::uint64_t& one : of) {
      one = power;
      power *= 10;
    }
  }
};

constexpr PowersOfTen POWERS_OF_TEN;

// Digits of a number from 1 to below 10^17.
int digit_count(std::uint64_t number) {
  const int below = (64 - __builtin_clzll(number)) * 1233 >> 12;  // bits times log10(2)
  return below + (number >= POWERS_OF_TEN.of[below]);
}

// All MOST_DIGITS places of a number with `count` digits, from the first one on; behind its digits are zeros.
void put_digits(std::uint64_t number, int count, char* out) {
  const std::uint64_t places = number * POWERS_OF_TEN.of[MOST_DIGITS - count];
  const std::uint64_t high = places / 100000000;
  *out = (char)('0' + high / 100000000);
  put_eight((std::uint32_t)(high % 100000000), out + 1);
  put_eight((std::uint32_t)(places % 100000000), out + 9);
}

// A point behind some of the digits at `out`.
void put_point(char* out, int digits) {
  std::memmove(out + digits + 1, out + digits, MOST_DIGITS - 1);
  out[digits] = '.';
}

// Without the zeros that end it.
DecimalNumber trimmed(DecimalNumber decimal) {
  if (decimal.digits % 10) return decimal;
  for (; decimal.digits % 10000 == 0; decimal.exponent += 4) decimal.digits /= 10000;
  for (; decimal.digits % 10 == 0; ++decimal.exponent) decimal.digits /= 10;
  return decimal;
}

std::size_t put_plain(const DecimalNumber& decimal, int count, char* out) {
  const int whole = count + decimal.exponent;  // digits before the point
  if (whole <= 0) {
    std::memcpy(out, "0.000000", 8);  // no plain number has more than four zeros behind its point
    put_digits(decimal.digits, count, out + 2 - whole);
    return (std::size_t)(2 - whole + count);
  }
  put_digits(decimal.digits, count, out);
  if (decimal.exponent >= 0) return (std::size_t)whole;
  put_point(out, whole);
  return (std::size_t)count + 1;
}

std::size_t put_scientific(const DecimalNumber& decimal, int count, char* out) {
  put_digits(decimal.digits, count, out);
  char* at = out + count;
  if (count > 1) {
    put_point(out, 1);
    ++at;
  }
  const int power = count - 1 + decimal.exponent;
  *at++ = 'e';
  *at++ = power < 0 ? '-' : '+';
  const auto size = (std::uint32_t)(power < 0 ? -power : power);
  if (size >= 100) *at++ = (char)('0' + size / 100);
  put_pair(size % 100, at);
  return (std::size_t)(at + 2 - out);
}

// Shortest digits, without an exponent for least <= |x| < 1e16.
std::size_t shortest(double x, double least, char* out) {
  const double magnitude = x < 0 ? -x : x;
  if (magnitude == 0) {
    *out = '0';
    return 1;
  }
  const DecimalNumber decimal = trimmed(shortest_decimal(magnitude));
  const int count = digit_count(decimal.digits);
  const bool sign = x < 0;
  *out = '-';
  const bool plain = magnitude >= least && magnitude < 1e16;
  return (plain ? put_plain : put_scientific)(decimal, count, out + sign) + sign;
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

std::size_t real_text(double x, char* out) {
  const std::size_t size = json_text(x, out);
  if (!(x > -1e16 && x < 1e16) || x != (double)(long long)x) return size;
  std::memcpy(out + size, ".0", 2);
  return size + 2;
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
