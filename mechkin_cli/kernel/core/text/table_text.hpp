// Tables as text: lines of CSV and of JSON, the table of a Markdown page, lists of JSON.
//
// Rows are cut into blocks that are written independently, by several threads where asked; the text does not
// depend on their number. Nothing is kept per cell: memory beside the text is that of a block.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "text/number_text.hpp"

enum class Notation { shortest, significant, fixed, scientific, json, real };

// How a column's numbers are written; `digits` as the notation needs them.
struct NumberStyle {
  Notation notation = Notation::shortest;
  int digits = 0;
  bool trimmed = false;  // fixed only: without the zeros that end every number of the column
};

// One column of a table: `numbers`, or, where that is nullptr, fields[codes[row]].
struct TextColumn {
  const double* numbers = nullptr;
  const std::int32_t* codes = nullptr;
  std::vector<std::string> fields;
  NumberStyle style;
};

// Room for the text of a given size, once it is known; null, and no text is written, where there is none.
using Room = std::function<char*(std::size_t)>;

// A field of RFC 4180: in quotes where it holds the mark that parts cells, a quote or a line break.
std::string csv_field(std::string_view text, char between = ',');

// How lines of CSV are written: with `decimal_comma` semicolons part the cells; the empty cells of a single column are
// `""` where `quoted_empty`, as many readers skip blank lines.
struct CsvStyle {
  bool quoted_empty = false;
  bool decimal_comma = false;
};

// Where lines stand in the room that they were written into.
struct LinePiece {
  std::size_t start = 0, size = 0;
};

// One line per row, LF endings, from the row `first` on, as many as fit into a room of `size` characters. They stand
// in `pieces`, in order. Returns the row behind the last one; `first` where not even one line fits. Fields of words
// are as `csv_field` already.
std::size_t csv_lines(const std::vector<TextColumn>& columns, std::size_t first, std::size_t rows,
                      const CsvStyle& style, int threads, char* room, std::size_t size, std::vector<LinePiece>& pieces);

// An object of JSON, `{"theta":0.5,"status":"ok"}`; keys and the fields of words are JSON already.
std::size_t json_lines(const std::vector<std::string>& keys, const std::vector<TextColumn>& columns,
                       std::size_t first, std::size_t rows, int threads, char* room, std::size_t size,
                       std::vector<LinePiece>& pieces);

// Lines of a header, of alignment and one per row, every column padded to one width (characters, not bytes, at
// least 4): words to the left, numbers to the right.
void markdown_text(const std::vector<std::string>& headers, const std::vector<TextColumn>& columns,
                   std::size_t rows, int threads, const Room& room);

// The cells of one column, not padded.
std::vector<std::string> column_texts(const TextColumn& column, std::size_t rows);

// `[1, null, 0.5]`; the fields of words are JSON already.
void json_list_text(const TextColumn& column, std::size_t rows, int threads, const Room& room);
