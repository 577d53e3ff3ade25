#include "text/number_text.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>

#include "text/shortest.hpp"

namespace {

using Wide = unsigned __int128;

constexpr std::uint64_t SIGN = (std::uint64_t)1 << 63, INFINITE_BITS = (std::uint64_t)0x7FF << 52;

std::uint64_t bits_of(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

bool is_finite(double x) { return (bits_of(x) & ~SIGN) < INFINITE_BITS; }

// Sixteen bytes as numbers of several sizes, the first one at the lowest address, and its lowest byte before the others.
typedef std::uint16_t Shorts __attribute__((vector_size(16)));
typedef std::uint32_t Words __attribute__((vector_size(16)));
typedef std::uint64_t Halves __attribute__((vector_size(16)));
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

constexpr std::uint64_t ZEROS = 0x3030303030303030;  // eight characters

void put_eight(std::uint64_t characters, char* out) { std::memcpy(out, &characters, sizeof characters); }

// The first four of eight digits, and 2^32 times the other four.
std::uint64_t in_halves(std::uint64_t eight) {
  const std::uint64_t first = eight * 3518437209 >> 45;  // the ten-thousandth part
  return (eight << 32) - first * (((std::uint64_t)10000 << 32) - 1);
}

constexpr Shorts HUNDREDS_AND_REST = {1, 65436, 1, 65436, 1, 65436, 1, 65436};  // -100

// Of eight digits that are not all zeros.
int zeros_behind(std::uint64_t digits) { return (int)((unsigned)__builtin_ctzll(__builtin_bswap64(digits)) / 8); }

__attribute__((always_inline)) inline NumberDigits digits_of(const DecimalNumber& decimal) {
  constexpr std::uint32_t eight = 100000000;
  const std::uint64_t high = decimal.digits / eight, most = high / eight;
  const std::uint64_t upper = high - most * eight, lower = decimal.digits - high * eight;
  // four digits, then two, then one in a place, of all at once
  const auto fours = (Shorts)Halves{in_halves(upper), in_halves(lower)};
  const Shorts hundreds = fours / 100;
  const Shorts both = hundreds | (Shorts)((Words)hundreds << 16);
  const Shorts pairs = (Shorts)((Words)fours << 16) + both * HUNDREDS_AND_REST;
  const Shorts tens = pairs * 103 >> 10;             // a tenth, of what is below 100
  const Shorts digits = (pairs << 8) - tens * 2559;  // the tens, and 256 times what is left of ten of them
  const std::uint64_t near = ((Halves)digits)[0], far = ((Halves)digits)[1];
  const int count = far ? MOST_DIGITS - zeros_behind(far) : near ? MOST_DIGITS - 8 - zeros_behind(near) : 1;
  return {near | ZEROS, far | ZEROS, (char)('0' + most), count, decimal.whole};
}

void put_behind(const NumberDigits& digits, char* out) {
  put_eight(digits.near, out);
  put_eight(digits.far, out + 8);
}

std::size_t put_plain(const NumberDigits& digits, char* out) {
  const int whole = digits.whole, before = whole - 1;  // the point stands behind `before` of those behind the first
  if (whole <= 0) {
    std::memcpy(out, "0.000000", 8);  // no plain number has more than four zeros behind its point
    out += 2 - whole;
    *out = digits.first;
    put_behind(digits, out + 1);
    return (std::size_t)(2 - whole + digits.count);
  }
  *out = digits.first;
  if (before < 8) {
    const std::uint64_t mask = ((std::uint64_t)1 << 8 * before) - 1;
    put_behind(digits, out + 2);
    put_eight((digits.near & mask) | (std::uint64_t)'.' << 8 * before | (digits.near & ~mask) << 8, out + 1);
  } else {
    put_behind(digits, out + 1);
    out[whole] = '.';
    put_eight(digits.far >> 8 * (before - 8), out + whole + 1);
  }
  return (std::size_t)(digits.count <= whole ? whole : digits.count + 1);
}

std::size_t put_scientific(const NumberDigits& digits, char* out) {
  out[0] = digits.first;
  out[1] = '.';
  put_behind(digits, out + 2);
  char* at = out + digits.count + (digits.count > 1);
  const int power = digits.whole - 1;
  *at++ = 'e';
  *at++ = power < 0 ? '-' : '+';
  auto size = (std::uint32_t)(power < 0 ? -power : power);
  if (size >= 100) {
    *at++ = (char)('0' + size / 100);
    size %= 100;
  }
  *at++ = (char)('0' + size / 10);
  *at++ = (char)('0' + size % 10);
  return (std::size_t)(at - out);
}

// Digits before the point of what is below 1e16, and of 1e-5 and 1e-4.
constexpr int MOST_WHOLE = 16, LEAST_WHOLE = -4, LEAST_WHOLE_OF_JSON = -3;

// Whether a magnitude has digits: it is neither zero, nor infinite, nor not a number.
bool has_digits(std::uint64_t bits) { return bits - 1 < INFINITE_BITS - 1; }

// Shortest digits, without an exponent where the first of them stands at 10^(least - 1) or above, and the number is
// below 1e16; nothing of what is not finite. `digits` says those of a magnitude.
template <class DigitsOf>
std::size_t shortest(double x, int least, char* out, const DigitsOf& digits_of_bits) {
  const std::uint64_t bits = bits_of(x) & ~SIGN;
  if (!has_digits(bits)) {
    *out = '0';
    return bits == 0;
  }
  const NumberDigits& digits = digits_of_bits(bits);
  const bool sign = bits_of(x) >> 63;
  *out = '-';
  out += sign;
  const bool is_plain = digits.whole >= least && digits.whole <= MOST_WHOLE;
  return sign + (is_plain ? put_plain(digits, out) : put_scientific(digits, out));
}

std::size_t shortest(double x, int least, char* out) {
  return shortest(x, least, out, [](std::uint64_t bits) { return digits_of(shortest_decimal(bits)); });
}

}  // namespace

void find_digits(const double* numbers, std::size_t count, NumberDigits* digits) {
  DecimalNumber decimals[NUMBERS_TOGETHER];
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t bits = bits_of(numbers[k]) & ~SIGN;
    decimals[k] = has_digits(bits) ? shortest_decimal(bits) : DecimalNumber{};
  }
  for (std::size_t k = 0; k < count; ++k) digits[k] = digits_of(decimals[k]);
}

std::size_t number_text(double x, const NumberDigits& digits, char* out) {
  return shortest(x, LEAST_WHOLE, out, [&](std::uint64_t) -> const NumberDigits& { return digits; });
}

std::size_t number_text(double x, char* out) { return shortest(x, LEAST_WHOLE, out); }

std::size_t number_text(double x, int significant_digits, char* out) {
  char* const limit = out + NUMBER_TEXT_SIZE;
  const auto end = std::to_chars(out, limit, x, std::chars_format::scientific, significant_digits - 1).ptr;
  double rounded = x;  // stays so when the rounded text overflows or is not a number
  std::from_chars(out, end, rounded);
  return number_text(rounded, out);
}

std::size_t json_text(double x, char* out) {
  if (is_finite(x)) return shortest(x, LEAST_WHOLE_OF_JSON, out);
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

constexpr int MOST_EXACT_DECIMALS = 22;  // 53 bits times 10^22 are 127 bits
constexpr Wide LARGEST_SCALED = (Wide)1 << 64;

Wide power_of_ten(int exponent) {
  Wide power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

// |x| * 10^decimals, the exact value rounded to a whole number, ties to even; false where it is not below 2^64.
bool scaled_exactly(double magnitude, int decimals, std::uint64_t& scaled) {
  const std::uint64_t bits = bits_of(magnitude);
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
