// Python's view of numbers and tables as text, and of how far numbers reach; where another thread changes the numbers
// meanwhile, the text is of either. A column is a float64 array; with a style of its own a tuple
// (array, scientific, decimals, trimmed); one of words a pair of int32 codes and the texts they stand for.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "arithmetic/extremes.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "text/table_text.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace {

using Codes = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Memory = nb::ndarray<std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

constexpr int MOST_DECIMALS = 1000;
constexpr int MOST_THREADS = 256;

int checked_digits(int digits) {
  if (digits < 0 || digits > MOST_SIGNIFICANT_DIGITS)
    throw nb::value_error("significant_digits must be 0 (shortest round trip) or 1 to 15");
  return digits;
}

int checked_decimals(int decimals) {
  if (decimals < 0 || decimals > MOST_DECIMALS) throw nb::value_error("decimals must be 0 to 1000");
  return decimals;
}

int checked_threads(int threads) {
  if (threads < 1 || threads > MOST_THREADS) throw nb::value_error("threads must be 1 to 256");
  return threads;
}

NumberStyle significant(int digits) {
  return {checked_digits(digits) ? Notation::significant : Notation::shortest, digits, false};
}

// What `what` names, as C++ has it; TypeError where it is of another type, or text that is no UTF-8.
template <class Value>
Value read(nb::handle given, const char* what) {
  Value value;
  if (!nb::try_cast(given, value)) throw nb::type_error(what);
  return value;
}

// The columns and what keeps their memory alive. Codes are copied: they were checked, and must not change after.
struct TextTable {
  std::vector<TextColumn> columns;
  std::vector<Row> numbers;
  std::vector<std::vector<std::int32_t>> codes;
  std::size_t rows = 0;
};

void add(TextTable& table, TextColumn column, std::size_t rows) {
  if (!table.columns.empty() && rows != table.rows) throw nb::value_error("columns of different length");
  table.rows = rows;
  table.columns.push_back(std::move(column));
}

void add_numbers(TextTable& table, nb::handle array, const NumberStyle& style) {
  const auto numbers = read<Row>(array, "a column of numbers is a C-contiguous array of float64, one per row");
  TextColumn column;
  column.numbers = numbers.data();
  column.style = style;
  add(table, std::move(column), numbers.shape(0));
  table.numbers.push_back(numbers);
}

using Field = std::string (*)(std::string_view);

std::string as_it_is(std::string_view text) { return std::string(text); }

std::string between_commas(std::string_view text) { return csv_field(text); }

std::string between_semicolons(std::string_view text) { return csv_field(text, ';'); }

Field csv_field_of(bool decimal_comma) { return decimal_comma ? between_semicolons : between_commas; }

void add_words(TextTable& table, const nb::tuple& pair, Field field) {
  if (pair.size() != 2) throw nb::value_error("a text column is a pair of codes and texts");
  const auto given = read<Codes>(pair[0], "the codes of a text column are a C-contiguous array of int32");
  std::vector<std::int32_t> codes(given.data(), given.data() + given.shape(0));
  TextColumn column;
  for (const std::string& text : read<std::vector<std::string>>(pair[1], "the texts of a column are a list of text"))
    column.fields.push_back(field(text));
  for (const std::int32_t code : codes)
    if (code < 0 || (std::size_t)code >= column.fields.size())
      throw nb::value_error("a code stands for none of the texts of its column");
  column.codes = codes.data();
  add(table, std::move(column), codes.size());
  table.codes.push_back(std::move(codes));
}

// `style` holds for the numbers that have none of their own.
void add_column(TextTable& table, nb::handle given, const NumberStyle& style, Field field) {
  if (!nb::isinstance<nb::tuple>(given)) return add_numbers(table, given, style);
  const auto parts = nb::borrow<nb::tuple>(given);
  if (parts.size() != 4) return add_words(table, parts, field);
  NumberStyle own;
  own.notation = read<bool>(parts[1], "scientific: True or False") ? Notation::scientific : Notation::fixed;
  own.digits = checked_decimals(read<int>(parts[2], "decimals: a whole number"));
  own.trimmed = read<bool>(parts[3], "trimmed: True or False");
  if (own.trimmed && own.notation == Notation::scientific)
    throw nb::value_error("only plain notation can be trimmed of its zeros");
  add_numbers(table, parts[0], own);
}

TextTable table_of(const nb::list& columns, const NumberStyle& style, Field field) {
  TextTable table;
  for (const nb::handle column : columns) add_column(table, column, style, field);
  return table;
}

// Runs `write(room)` without the GIL; the text is written straight into Python's bytes.
template <class Write>
nb::bytes written(const Write& write) {
  PyObject* bytes = nullptr;
  const Room room = [&bytes](std::size_t size) {
    const nb::gil_scoped_acquire held;
    bytes = PyBytes_FromStringAndSize(nullptr, (Py_ssize_t)size);
    return bytes ? PyBytes_AsString(bytes) : nullptr;  // the macro is not of the stable ABI
  };
  try {
    const nb::gil_scoped_release released;
    write(room);
  } catch (...) {
    Py_XDECREF(bytes);
    throw;
  }
  if (!bytes) throw nb::python_error();
  return nb::steal<nb::bytes>(bytes);
}

void check_labels(const std::vector<std::string>& labels, const nb::list& columns) {
  if (labels.size() != columns.size()) throw nb::value_error("one label per column");
}

std::string csv_header(const std::vector<std::string>& labels, bool decimal_comma) {
  std::string header;
  for (const std::string& label : labels) {
    if (&label != &labels.front()) header += decimal_comma ? ';' : ',';
    header += csv_field_of(decimal_comma)(label);
  }
  return header += '\n';
}

// The row behind the last line, and the start and size of each piece of the room that lines stand in.
using Written = std::pair<std::size_t, std::vector<std::pair<std::size_t, std::size_t>>>;

// Runs `write(room, size, pieces)` without the GIL.
template <class Write>
Written lines(const TextTable& table, std::size_t first, Memory& room, const Write& write) {
  if (first > table.rows) throw nb::value_error("the first row lies behind the last");
  std::vector<LinePiece> pieces;
  Written written;
  {
    const nb::gil_scoped_release released;
    written.first = write(reinterpret_cast<char*>(room.data()), room.shape(0), pieces);
  }
  for (const LinePiece& piece : pieces) written.second.emplace_back(piece.start, piece.size);
  return written;
}

Written csv(const nb::list& columns, std::size_t first, Memory room, int significant_digits, bool quoted_empty,
            bool decimal_comma, int threads) {
  checked_threads(threads);
  const TextTable table = table_of(columns, significant(significant_digits), csv_field_of(decimal_comma));
  return lines(table, first, room, [&](char* memory, std::size_t size, std::vector<LinePiece>& pieces) {
    return csv_lines(table.columns, first, table.rows, {quoted_empty, decimal_comma}, threads, memory, size, pieces);
  });
}

Written json(const std::vector<std::string>& keys, const nb::list& columns, std::size_t first, Memory room,
             const std::vector<bool>& whole, int threads) {
  checked_threads(threads);
  check_labels(keys, columns);
  if (whole.size() != keys.size()) throw nb::value_error("for each column, whether its numbers are whole");
  TextTable table;
  for (std::size_t c = 0; c < keys.size(); ++c)
    add_column(table, columns[c], {whole[c] ? Notation::json : Notation::real, 0, false}, as_it_is);
  return lines(table, first, room, [&](char* memory, std::size_t size, std::vector<LinePiece>& pieces) {
    return json_lines(keys, table.columns, first, table.rows, threads, memory, size, pieces);
  });
}

nb::bytes markdown(const std::vector<std::string>& headers, const nb::list& columns, int threads) {
  checked_threads(threads);
  check_labels(headers, columns);
  const TextTable table = table_of(columns, {}, as_it_is);
  return written([&](const Room& room) { markdown_text(headers, table.columns, table.rows, threads, room); });
}

nb::bytes json_list(nb::handle column, int threads) {
  checked_threads(threads);
  TextTable table;
  add_column(table, column, {Notation::json, 0, false}, as_it_is);
  return written([&](const Room& room) { json_list_text(table.columns.front(), table.rows, threads, room); });
}

std::string one_number(double x, int significant_digits) {
  char text[NUMBER_TEXT_SIZE];
  return {text, checked_digits(significant_digits) ? number_text(x, significant_digits, text) : number_text(x, text)};
}

std::vector<std::string> decimal_texts(const nb::tuple& column) {
  TextTable table;
  add_column(table, column, {}, as_it_is);
  return column_texts(table.columns.front(), table.rows);
}

std::tuple<std::size_t, std::size_t, double, double> extremes_of(const Row& numbers) {
  const Extremes found = extremes(numbers.data(), numbers.shape(0));
  return {found.cells, found.infinite, found.largest, found.smallest};
}

}  // namespace

void bind_text(nb::module_& m) {
  m.def("number_text", &one_number, "x"_a, "significant_digits"_a = 0);
  m.def("decimal_texts", &decimal_texts, "column"_a);
  m.def("csv_header", &csv_header, "labels"_a, "decimal_comma"_a = false);
  m.def("csv_lines", &csv, "columns"_a, "first"_a, "room"_a, "significant_digits"_a = 0, "quoted_empty"_a = false,
        "decimal_comma"_a = false, "threads"_a = 1);
  m.def("json_lines", &json, "keys"_a, "columns"_a, "first"_a, "room"_a, "whole"_a, "threads"_a = 1);
  m.def("markdown_text", &markdown, "headers"_a, "columns"_a, "threads"_a = 1);
  m.def("extremes", &extremes_of, "numbers"_a);
  m.def("json_list", &json_list, "column"_a, "threads"_a = 1);
}
