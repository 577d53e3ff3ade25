#include "text/shortest.hpp"

#include <cstring>

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

}  // namespace

DecimalNumber shortest_decimal(double magnitude) {
  std::uint64_t bits;
  std::memcpy(&bits, &magnitude, sizeof bits);
  const int raised = (int)(bits >> 52);
  const std::uint64_t fraction = bits & (((std::uint64_t)1 << 52) - 1);
  const std::uint64_t c = raised ? fraction | (std::uint64_t)1 << 52 : fraction;
  const int q = (raised ? raised : 1) - 1075;  // magnitude = c 2^q
  if (q <= 0 && q > -53 && (c & (((std::uint64_t)1 << -q) - 1)) == 0) return {c >> -q, 0};
  // four times the ends of what reads back as this double; below a power of two its neighbour is nearer
  const bool is_near_below = fraction == 0 && raised > 1;
  const int k = is_near_below ? floor_log10_of_three_quarters(q) : floor_log10_of_power_of_two(q);
  const int h = q + floor_log2_of_power_of_ten(-k) + 1;
  const Power& power = POWERS.of[-k - LEAST_POWER];
  const Product at = product(power, 4 * c << h);
  const std::uint64_t value = at.rounded_to_odd(), odd = c & 1;  // the ends belong to even ones
  const std::uint64_t lower = at.minus(shifted(power, h + !is_near_below)).rounded_to_odd() + odd;
  const std::uint64_t upper = at.plus(shifted(power, h + 1)).rounded_to_odd() - odd;
  // with a digit less, where one of its two neighbours alone lies inside; chosen without a branch, which would be
  // guessed wrong for every third number
  const std::uint64_t s = value / 4, tenth = s / 10, middle = 4 * s + 2;
  const bool low_tenth = lower <= 40 * tenth, high_tenth = 40 * tenth + 40 <= upper;
  const bool low = lower <= 4 * s, high = 4 * s + 4 <= upper;
  const bool is_shorter = (s >= 10) & (low_tenth != high_tenth);
  const bool is_nearer = (value > middle) | ((value == middle) & (s & 1));
  const std::uint64_t longer = s + (low != high ? high : is_nearer);
  return {is_shorter ? tenth + high_tenth : longer, k + is_shorter};
}
