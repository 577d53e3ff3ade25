// Numbers as text, the same on every machine.
//
// Shortest digits that read back as the same double. Plain notation for 1e-5 <= |x| < 1e16, integers
// without a point; otherwise an exponent of at least two digits, as C and Python write it: `1e-06`,
// `2.5e+16`. Zero is `0`, never `-0`; what is not finite is empty text.
#pragma once

#include <cstddef>
#include <cstdint>

// Room for the longest number, `-0.000012345678901234567`.
constexpr std::size_t NUMBER_TEXT_SIZE = 32;

// More digits than these need not survive the way through a double and back.
constexpr int MOST_SIGNIFICANT_DIGITS = 15;

// Writes x at `out` (NUMBER_TEXT_SIZE characters, no terminating zero); returns the length.
std::size_t number_text(double x, char* out);

// The shortest digits of a number without its sign, as characters.
struct NumberDigits {
  std::uint64_t near, far;  // the sixteen behind the first, in order from the lowest byte on
  char first;
  int count;  // without the zeros at the end
  int whole;  // so many stand before the point
};

// Numbers that belong together: each waits for products of its own, and those of the others fit in between.
constexpr std::size_t NUMBERS_TOGETHER = 16;

// The digits of up to NUMBERS_TOGETHER numbers; anything of zeros and of what is not finite.
void find_digits(const double* numbers, std::size_t count, NumberDigits* digits);

// As `number_text` of a number whose digits were found.
std::size_t number_text(double x, const NumberDigits& digits, char* out);

// The same for x rounded (the exact binary value, ties to even) to 1 ... MOST_SIGNIFICANT_DIGITS digits.
std::size_t number_text(double x, int significant_digits, char* out);

// The same as Python's repr, with an exponent below 1e-4 already, but whole numbers without a point as in
// JSON; `null` for what is not finite.
std::size_t json_text(double x, char* out);

// The same as a number that readers take for a double where they guess the kind of a column: whole ones end in `.0`.
std::size_t real_text(double x, char* out);

// Room for fixed_text and scientific_text: the 309 digits of the largest double, sign, point, decimals.
constexpr std::size_t decimal_text_size(int decimals) { return (std::size_t)decimals + 320; }

// x rounded likewise to a number of decimals >= 0, all of them printed; no `-0.00`.
std::size_t fixed_text(double x, int decimals, char* out);

// x with one digit, `decimals` decimals and an exponent: `-1.50000e+09`; zero is `0`.
std::size_t scientific_text(double x, int decimals, char* out);
