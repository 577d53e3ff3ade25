// The shortest decimal digits that read back as the same double, and of those the ones nearest to it.
//
// As std::to_chars finds them, but sooner: R. Giulietti, The Schubfach way to render doubles (2020), section 9.
// Every digit that is compared comes from one product with a power of ten of 128 bits; where its first 64 bits behind the
// point do not decide, from all of them, rounded to odd.
#pragma once

#include <cstdint>

constexpr int MOST_DIGITS = 17;  // of the shortest that a double needs

// A number by MOST_DIGITS digits, of which the first is not zero; so many of them stand before the point.
struct DecimalNumber {
  std::uint64_t digits;
  int whole;
};

// Of a finite number above zero by its bits.
DecimalNumber shortest_decimal(std::uint64_t bits);
