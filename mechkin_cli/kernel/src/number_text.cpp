#include "number_text.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <charconv>
#include <cstring>

namespace nb = nanobind;
using namespace nb::literals;

std::size_t number_text(double x, char* out) {
  const double magnitude = x < 0 ? -x : x;
  if (magnitude == 0) {
    *out = '0';
    return 1;
  }
  if (!(magnitude <= 1.7976931348623157e308)) return 0;
  const bool plain = magnitude >= 1e-5 && magnitude < 1e16;
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  return (std::size_t)(std::to_chars(out, out + NUMBER_TEXT_SIZE, x, format).ptr - out);
}

std::size_t number_text(double x, int significant_digits, char* out) {
  char* const limit = out + NUMBER_TEXT_SIZE;
  const auto end = std::to_chars(out, limit, x, std::chars_format::scientific, significant_digits - 1).ptr;
  double rounded = x;  // stays so when the rounded text overflows or is not a number
  std::from_chars(out, end, rounded);
  return number_text(rounded, out);
}

std::string fixed_text(double x, int decimals) {
  if (x - x != 0) return {};
  std::string text(decimals + 320, '\0');
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed, decimals).ptr;
  text.resize((std::size_t)(end - text.data()));
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return text;
}

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field += '"';
}

namespace {

// The most that a row can take, with its commas and line end.
std::size_t row_capacity(const std::vector<CsvColumn>& columns) {
  std::size_t capacity = 1;
  for (const CsvColumn& column : columns) {
    std::size_t longest = column.numbers ? NUMBER_TEXT_SIZE : 0;
    for (const std::string& field : column.fields)
      if (field.size() > longest) longest = field.size();
    capacity += longest + 1;
  }
  return capacity;
}

char* put_cell(const CsvColumn& column, std::size_t row, int significant_digits, char* at) {
  if (column.numbers) {
    const double x = column.numbers[row];
    return at + (significant_digits ? number_text(x, significant_digits, at) : number_text(x, at));
  }
  const std::string& field = column.fields[(std::size_t)column.codes[row]];
  std::memcpy(at, field.data(), field.size());
  return at + field.size();
}

}  // namespace

std::string csv_text(const char* header, std::size_t header_size, const std::vector<CsvColumn>& columns,
                     std::size_t rows, const unsigned char* missing, int significant_digits) {
  std::string text(header_size + 1 + rows * row_capacity(columns), '\0');
  std::memcpy(text.data(), header, header_size);
  char* at = text.data() + header_size;
  *at++ = '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c) *at++ = ',';
      if (!missing || !missing[row * columns.size() + c]) at = put_cell(columns[c], row, significant_digits, at);
    }
    *at++ = '\n';
  }
  text.resize((std::size_t)(at - text.data()));
  return text;
}

// Python's view; a text column is a pair of int32 codes and the texts they stand for.
namespace {

using Numbers = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Codes = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Missing = nb::ndarray<const bool, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

constexpr int MOST_DECIMALS = 1000;

// The columns and what keeps their memory alive.
struct Table {
  std::vector<CsvColumn> columns;
  std::vector<Numbers> numbers;
  std::vector<Codes> codes;
  std::size_t rows = 0;
};

void add_rows(Table& table, std::size_t rows) {
  if (!table.columns.empty() && rows != table.rows) throw nb::value_error("columns of different length");
  table.rows = rows;
}

void add_words(Table& table, const nb::tuple& pair) {
  if (pair.size() != 2) throw nb::value_error("a text column is a pair of codes and texts");
  const auto codes = nb::cast<Codes>(pair[0]);
  CsvColumn column;
  for (const nb::handle text : pair[1]) column.fields.push_back(csv_field(nb::cast<std::string>(text)));
  for (std::size_t i = 0; i < codes.shape(0); ++i)
    if (codes.data()[i] < 0 || (std::size_t)codes.data()[i] >= column.fields.size())
      throw nb::index_error("a code stands for none of the texts of its column");
  add_rows(table, codes.shape(0));
  column.codes = codes.data();
  table.codes.push_back(codes);
  table.columns.push_back(std::move(column));
}

void add_numbers(Table& table, nb::handle array) {
  const auto numbers = nb::cast<Numbers>(array);
  add_rows(table, numbers.shape(0));
  CsvColumn column;
  column.numbers = numbers.data();
  table.numbers.push_back(numbers);
  table.columns.push_back(std::move(column));
}

nb::bytes csv(const std::vector<std::string>& labels, const nb::list& columns,
              const std::optional<Missing>& missing, int significant_digits) {
  if (significant_digits < 0 || significant_digits > MOST_SIGNIFICANT_DIGITS)
    throw nb::value_error("significant_digits must be 0 (shortest round trip) or 1 to 15");
  if (labels.size() != columns.size()) throw nb::value_error("one label per column");
  Table table;
  for (const nb::handle column : columns) {
    if (nb::isinstance<nb::tuple>(column)) add_words(table, nb::borrow<nb::tuple>(column));
    else add_numbers(table, column);
  }
  if (missing && (missing->shape(0) != table.rows || missing->shape(1) != labels.size()))
    throw nb::value_error("missing must have the shape (rows, columns)");
  std::string header;
  for (const std::string& label : labels) {
    if (&label != &labels.front()) header += ',';
    header += csv_field(label);
  }
  const auto* mask = missing ? reinterpret_cast<const unsigned char*>(missing->data()) : nullptr;
  std::string text;
  {
    nb::gil_scoped_release released;
    text = csv_text(header.data(), header.size(), table.columns, table.rows, mask, significant_digits);
  }
  return nb::bytes(text.data(), text.size());
}

std::string one_number(double x, int significant_digits) {
  if (significant_digits < 0 || significant_digits > MOST_SIGNIFICANT_DIGITS)
    throw nb::value_error("significant_digits must be 0 (shortest round trip) or 1 to 15");
  char text[NUMBER_TEXT_SIZE];
  return {text, significant_digits ? number_text(x, significant_digits, text) : number_text(x, text)};
}

std::vector<std::string> fixed(const Numbers& values, int decimals) {
  if (decimals < 0 || decimals > MOST_DECIMALS) throw nb::value_error("decimals must be 0 to 1000");
  std::vector<std::string> texts;
  texts.reserve(values.shape(0));
  for (std::size_t i = 0; i < values.shape(0); ++i) texts.push_back(fixed_text(values.data()[i], decimals));
  return texts;
}

}  // namespace

void bind_text(nb::module_& m) {
  m.def("number_text", &one_number, "x"_a, "significant_digits"_a = 0);
  m.def("fixed_texts", &fixed, "values"_a, "decimals"_a);
  m.def("csv_text", &csv, "labels"_a, "columns"_a, "missing"_a.none() = nb::none(), "significant_digits"_a = 0);
}
