#include "text/shortest.hpp"

namespace {

using Wide = unsigned __int128;

constexpr int LEAST_POWER = -292, MOST_POWER = 324;

// The leading 128 bits of a power of ten, rounded up.
struct Power {
  std::uint64_t high, low;
};

// A power of ten from 256 bits, the highest of them set: what is cut off of up to 324 factors is below 2^-246 of it,
// and no power but the exact ones has so many equal bits behind its 128th.
struct LongPower {
  std::uint64_t parts[4];

  constexpr void times_ten() {
    Wide carry = 0;
    for (int i = 3; i >= 0; --i) {
      carry += (Wide)parts[i] * 10;
      parts[i] = (std::uint64_t)carry;
      carry >>= 64;
    }
    const int shift = carry < 8 ? 3 : 4;
    for (std::uint64_t& part : parts) {
      const std::uint64_t own = part;
      part = ((std::uint64_t)carry << (64 - shift)) | own >> shift;
      carry = own;
    }
  }

  constexpr void by_ten() {
    const int shift = parts[0] >= 0xA000000000000000u ? 3 : 4;
    std::uint64_t rest = parts[0] >> (64 - shift);
    for (int i = 0; i < 4; ++i) {
      const std::uint64_t behind = i < 3 ? parts[i + 1] >> (64 - shift) : 0;
      const Wide part = (Wide)rest << 64 | (parts[i] << shift | behind);
      parts[i] = (std::uint64_t)(part / 10);
      rest = (std::uint64_t)(part % 10);
    }
  }

  constexpr Power rounded_up() const {
    const bool exact = parts[2] == 0 && parts[3] == 0;
    const std::uint64_t low = parts[1] + !exact;
    return {parts[0] + (!exact && low == 0), low};
  }
};

struct PowerTable {
  Power of[MOST_POWER - LEAST_POWER + 1] = {};

  constexpr PowerTable() {
    constexpr std::uint64_t one = (std::uint64_t)1 << 63;
    LongPower power = {{one, 0, 0, 0}};
    for (int k = 0; k <= MOST_POWER; ++k, power.times_ten()) of[k - LEAST_POWER] = power.rounded_up();
    power = {{one, 0, 0, 0}};
    for (int k = 0; k >= LEAST_POWER; --k, power.by_ten())
      if (k < 0) of[k - LEAST_POWER] = power.rounded_up();
  }
};

constexpr PowerTable POWERS;

// A product of 192 bits with a power of ten.
struct Product {
  Wide upper;
  std::uint64_t lowest;

  // The highest 64 bits, the last of them set where anything lies below.
  std::uint64_t rounded_to_odd() const { return (std::uint64_t)(upper >> 64) | ((std::uint64_t)upper > 1); }
  Product plus(const Product& other) const {
    const std::uint64_t sum = lowest + other.lowest;
    return {upper + other.upper + (sum < lowest), sum};
  }
  Product minus(const Product& other) const {
    return {upper - other.upper - (lowest < other.lowest), lowest - other.lowest};
  }
};

Product product(const Power& power, std::uint64_t factor) {
  const Wide below = (Wide)power.low * factor;
  return {(Wide)power.high * factor + (std::uint64_t)(below >> 64), (std::uint64_t)below};
}

// With 2^shift, from 1 on.
Product shifted(const Power& power, int shift) {
  return {(Wide)power.high << shift | power.low >> (64 - shift), power.low << shift};
}

// Exact for all exponents of doubles.
int floor_log2_of_power_of_ten(int k) { return (k * 1741647) >> 19; }
int floor_log10_of_power_of_two(int q) { return (q * 1262611) >> 22; }
int floor_log10_of_three_quarters(int q) { return (q * 1262611 - 524031) >> 22; }

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

// digits * 10^exponent, from 1 to MOST_DIGITS digits.
DecimalNumber decimal_of(std::uint64_t digits, int exponent) {
  const int below = (64 - __builtin_clzll(digits)) * 1233 >> 12;  // bits times log10(2)
  const int count = below + (digits >= POWERS_OF_TEN.of[below]);
  return {digits * POWERS_OF_TEN.of[MOST_DIGITS - count], count + exponent};
}

// Of the double c 2^q; below a power of two its neighbour is nearer.
__attribute__((noinline, cold)) DecimalNumber decided_exactly(std::uint64_t c, int q, bool is_near_below) {
  // four times the ends of what reads back as this double
  const int k = is_near_below ? floor_log10_of_three_quarters(q) : floor_log10_of_power_of_two(q);
  const int h = q + floor_log2_of_power_of_ten(-k) + 1;
  const Power& power = POWERS.of[-k - LEAST_POWER];
  const Product at = product(power, 4 * c << h);
  const std::uint64_t value = at.rounded_to_odd(), odd = c & 1;  // the ends belong to even ones
  const std::uint64_t lower = at.minus(shifted(power, h + !is_near_below)).rounded_to_odd() + odd;
  const std::uint64_t upper = at.plus(shifted(power, h + 1)).rounded_to_odd() - odd;
  // with a digit less, where one of its two neighbours alone lies inside
  const std::uint64_t s = value / 4, tenth = s / 10, middle = 4 * s + 2;
  const bool low_tenth = lower <= 40 * tenth, high_tenth = 40 * tenth + 40 <= upper;
  const bool low = lower <= 4 * s, high = 4 * s + 4 <= upper;
  const bool is_nearer = value > middle || (value == middle && (s & 1));
  if (s >= 10 && low_tenth != high_tenth) return decimal_of(tenth + high_tenth, k + 1);
  return decimal_of(s + (low != high ? high : is_nearer), k);
}

// Whether two numbers differ by no more than what was cut off of both.
bool is_close(std::uint64_t a, std::uint64_t b) { return a - b + 4 <= 8; }

}  // namespace

DecimalNumber shortest_decimal(std::uint64_t bits) {
  const int raised = (int)(bits >> 52);
  const std::uint64_t fraction = bits & (((std::uint64_t)1 << 52) - 1);
  const std::uint64_t c = raised ? fraction | (std::uint64_t)1 << 52 : fraction;
  const int q = (raised ? raised : 1) - 1075;  // c 2^q
  if (q <= 0 && q > -53 && (c & (((std::uint64_t)1 << -q) - 1)) == 0) return decimal_of(c >> -q, 0);
  if (!raised || !fraction) return decided_exactly(c, q, raised > 1 && !fraction);
  // s and the 64 bits behind its point, of a number of 16 or 17 digits; the ends lie `half` to either side, from a half
  // to 5. Against a multiple of ten both are compared in parts of 2^-60.
  const int k = floor_log10_of_power_of_two(q), h = q + floor_log2_of_power_of_ten(-k) + 1;
  const Power& power = POWERS.of[-k - LEAST_POWER];
  const Wide upper = product(power, c << h).upper;
  const std::uint64_t s = (std::uint64_t)(upper >> 64), behind = (std::uint64_t)upper, unit = s % 10;
  const std::uint64_t half = power.high >> (5 - h), above = unit << 60 | behind >> 4, below = ((std::uint64_t)10 << 60) - above;
  constexpr std::uint64_t middle = (std::uint64_t)1 << 63;
  if (is_close(above, half) | is_close(below, half) | is_close(behind, middle)) return decided_exactly(c, q, false);
  // no branches, which would be guessed wrong for every third number: the ends are less than ten apart, so that one
  // multiple of ten lies between them, or none
  const bool low = above < half, high = below < half;
  const std::uint64_t is_longer = (low | high) - (std::uint64_t)1;  // all bits, or none
  const std::uint64_t digits = s + ((behind >> 63) & is_longer) + ((10 * high - unit) & ~is_longer);
  const bool is_short = digits < POWERS_OF_TEN.of[MOST_DIGITS - 1];
  return {is_short ? 10 * digits : digits, k + MOST_DIGITS - is_short};
}
