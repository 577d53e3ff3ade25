// The shortest decimal digits that read back as the same double, and of those the ones nearest to it.
//
// As std::to_chars finds them, but sooner: R. Giulietti, The Schubfach way to render doubles (2020), section 9.
// Every digit that is compared comes from one product with a power of ten of 128 bits, rounded to odd.
#pragma once

#include <cstdint>

// digits * 10^exponent; the last digit may be zero.
struct DecimalNumber {
  std::uint64_t digits;
  int exponent;
};

// Of a finite magnitude above zero.
DecimalNumber shortest_decimal(double magnitude);
