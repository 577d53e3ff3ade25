// Numbers as text, the same on every machine, and whole tables of them as CSV.
//
// Shortest digits that read back as the same double. Plain notation for 1e-5 <= |x| < 1e16, integers
// without a point; otherwise an exponent of at least two digits, as C and Python write it: `1e-06`,
// `2.5e+16`. Zero is `0`, never `-0`; what is not finite is empty text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace nanobind {
class module_;
}

// Room for the longest number, `-0.000012345678901234567`.
constexpr std::size_t NUMBER_TEXT_SIZE = 32;

// More digits than these need not survive the way through a double and back.
constexpr int MOST_SIGNIFICANT_DIGITS = 15;

// Writes x at `out` (NUMBER_TEXT_SIZE characters, no terminating zero); returns the length.
std::size_t number_text(double x, char* out);

// The same for x rounded (the exact binary value, ties to even) to 1 ... MOST_SIGNIFICANT_DIGITS digits.
std::size_t number_text(double x, int significant_digits, char* out);

// x rounded likewise to a number of decimals >= 0, all of them printed; no `-0.00`.
std::string fixed_text(double x, int decimals);

// A field of RFC 4180: in quotes where it holds a comma, a quote or a line break.
std::string csv_field(std::string_view text);

// One column of a table: `numbers`, or, where that is nullptr, fields[codes[row]].
struct CsvColumn {
  const double* numbers = nullptr;
  const std::int32_t* codes = nullptr;
  std::vector<std::string> fields;
};

// Header line (fields already as `csv_field`) and one line per row, LF endings. `missing`, row-major rows x
// columns, or nullptr, empties cells. significant_digits: 0 for shortest round trip.
std::string csv_text(const char* header, std::size_t header_size, const std::vector<CsvColumn>& columns,
                     std::size_t rows, const unsigned char* missing, int significant_digits);

void bind_text(nanobind::module_& m);
