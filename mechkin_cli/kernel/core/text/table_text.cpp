#include "text/table_text.hpp"

#include <algorithm>
#include <memory>
#include <cstring>

#include "text/blocks.hpp"

namespace {

std::size_t style_size(const NumberStyle& style) {
  const bool decimal = style.notation == Notation::fixed || style.notation == Notation::scientific;
  return decimal ? decimal_text_size(style.digits) : NUMBER_TEXT_SIZE;
}

std::size_t styled_text(const NumberStyle& style, double x, char* out) {
  switch (style.notation) {
    case Notation::shortest: return number_text(x, out);
    case Notation::significant: return number_text(x, style.digits, out);
    case Notation::fixed: return fixed_text(x, style.digits, out);
    case Notation::scientific: return scientific_text(x, style.digits, out);
    case Notation::json: return json_text(x, out);
    case Notation::real: return real_text(x, out);
  }
  return 0;
}

// The most that a cell can take.
std::size_t cell_capacity(const TextColumn& column) {
  std::size_t longest = column.numbers ? style_size(column.style) : 0;
  for (const std::string& field : column.fields) longest = std::max(longest, field.size());
  return longest;
}

char* put(const std::string& text, char* at) {
  std::memcpy(at, text.data(), text.size());
  return at + text.size();
}

char* put_cell(const TextColumn& column, std::size_t row, char* at) {
  if (column.numbers) return at + styled_text(column.style, column.numbers[row], at);
  return put(column.fields[(std::size_t)column.codes[row]], at);
}

// Memory of one thread.
class Scratch {
 public:
  explicit Scratch(std::size_t size) : memory_(new char[size]) {}
  char* get() const { return memory_.get(); }

 private:
  std::unique_ptr<char[]> memory_;
};

// Writes blocks of at most `capacity` characters a row between `before` and `after`.
template <class Put>
void write_blocks(const std::string& before, const std::string& after, std::size_t rows, std::size_t capacity,
                  int threads, const Room& room, const Put& put_row) {
  std::vector<std::string> blocks(block_count(rows));
  for_each_block(rows, threads, [&] {
    return [&, scratch = Scratch(BLOCK_ROWS * capacity)](std::size_t block, std::size_t first, std::size_t end) {
      char* at = scratch.get();
      for (std::size_t row = first; row < end; ++row) at = put_row(row, at);
      blocks[block].assign(scratch.get(), at);
    };
  });
  std::size_t size = before.size() + after.size();
  for (const std::string& text : blocks) size += text.size();
  char* at = room(size);
  if (!at) return;
  at = put(before, at);
  for (std::string& text : blocks) {
    at = put(text, at);
    std::string().swap(text);
  }
  put(after, at);
}

}  // namespace

namespace {

// Writes lines of at most `capacity` characters into a room. One thread writes them without a gap; more of them write
// blocks that begin where the longest lines before would end.
template <class Put>
std::size_t write_lines(std::size_t first, std::size_t rows, std::size_t capacity, int threads, char* room,
                        std::size_t size, std::vector<LinePiece>& pieces, const Put& put_row) {
  pieces.clear();
  const std::size_t fit = std::min(rows - first, size / capacity), end = first + fit;
  if (threads <= 1 || fit <= BLOCK_ROWS) {
    char* at = room;
    for (std::size_t row = first; row < end; ++row) at = put_row(row, at);
    if (fit) pieces.push_back({0, (std::size_t)(at - room)});
    return end;
  }
  pieces.resize(block_count(fit));
  for_each_block(fit, threads, [&] {
    return [&](std::size_t block, std::size_t begin, std::size_t finish) {
      const std::size_t start = begin * capacity;
      char* at = room + start;
      for (std::size_t row = begin; row < finish; ++row) at = put_row(first + row, at);
      pieces[block] = {start, (std::size_t)(at - room) - start};
    };
  });
  return end;
}

}  // namespace

std::string csv_field(std::string_view text, char between) {
  const char special[] = {between, '"', '\r', '\n', '\0'};
  if (text.find_first_of(special) == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field += '"';
}

namespace {

// Neighbouring cells of a row, of which the shortest numbers find their digits together.
class Together {
 public:
  Together(const TextColumn* columns, std::size_t count, std::size_t row) : columns_(columns), row_(row) {
    for (std::size_t c = 0; c < count; ++c) numbers_[c] = is_shortest(columns[c]) ? columns[c].numbers[row] : 0.0;
    find_digits(numbers_, count, digits_);
  }
  char* put(std::size_t c, char* at) const {
    if (is_shortest(columns_[c])) return at + number_text(numbers_[c], digits_[c], at);
    return put_cell(columns_[c], row_, at);
  }

 private:
  static bool is_shortest(const TextColumn& column) {
    return column.numbers && column.style.notation == Notation::shortest;
  }

  const TextColumn* columns_;
  std::size_t row_;
  double numbers_[NUMBERS_TOGETHER];
  NumberDigits digits_[NUMBERS_TOGETHER];
};

}  // namespace

std::size_t csv_lines(const std::vector<TextColumn>& columns, std::size_t first, std::size_t rows,
                      const CsvStyle& style, int threads, char* room, std::size_t size, std::vector<LinePiece>& pieces) {
  std::size_t capacity = 3;
  for (const TextColumn& column : columns) capacity += cell_capacity(column) + 1;
  const char between = style.decimal_comma ? ';' : ',';
  return write_lines(first, rows, capacity, threads, room, size, pieces, [&](std::size_t row, char* at) {
    char* const line = at;
    for (std::size_t begin = 0; begin < columns.size(); begin += NUMBERS_TOGETHER) {
      const std::size_t count = std::min(columns.size() - begin, NUMBERS_TOGETHER);
      const Together cells(&columns[begin], count, row);
      for (std::size_t c = 0; c < count; ++c) {
        if (begin + c) *at++ = between;
        char* const cell = at;
        at = cells.put(c, at);
        if (style.decimal_comma && columns[begin + c].numbers) std::replace(cell, at, '.', ',');
      }
    }
    if (style.quoted_empty && at == line) at = put("\"\"", at);
    *at++ = '\n';
    return at;
  });
}

std::size_t json_lines(const std::vector<std::string>& keys, const std::vector<TextColumn>& columns,
                       std::size_t first, std::size_t rows, int threads, char* room, std::size_t size,
                       std::vector<LinePiece>& pieces) {
  std::vector<std::string> before;  // what stands in front of each cell
  std::size_t capacity = 3;
  for (const std::string& key : keys) before.push_back((before.empty() ? '{' : ',') + key + ':');
  for (std::size_t c = 0; c < columns.size(); ++c) capacity += before[c].size() + cell_capacity(columns[c]);
  return write_lines(first, rows, capacity, threads, room, size, pieces, [&](std::size_t row, char* at) {
    if (columns.empty()) *at++ = '{';
    for (std::size_t c = 0; c < columns.size(); ++c) {
      at = put(before[c], at);
      at = put_cell(columns[c], row, at);
    }
    *at++ = '}';
    *at++ = '\n';
    return at;
  });
}

void json_list_text(const TextColumn& column, std::size_t rows, int threads, const Room& room) {
  const std::size_t capacity = cell_capacity(column) + 2;
  write_blocks("[", "]", rows, capacity, threads, room, [&](std::size_t row, char* at) {
    if (row) at = put(", ", at);
    return put_cell(column, row, at);
  });
}

// Markdown: the first pass measures, the second writes every block where it belongs.
namespace {

constexpr std::size_t NARROWEST = 4;  // room for the alignment row's `---:`

std::size_t characters(std::string_view text) {
  return (std::size_t)std::count_if(text.begin(), text.end(), [](char c) { return ((unsigned char)c & 0xC0) != 0x80; });
}

// What the cells of a column need: the longest text, and of numbers the decimals that are not zero in all.
struct Measure {
  std::size_t width = 0;
  int decimals = 0;
};

// Layout of a column: numbers end `dropped` characters earlier than their style writes them.
struct Padded {
  const TextColumn& column;
  std::vector<std::size_t> widths;  // of the fields, in characters
  std::size_t width;
  std::size_t dropped;
};

std::size_t fraction_digits(const char* text, std::size_t size, int decimals) {
  std::size_t zeros = 0;
  while (zeros < (std::size_t)decimals && text[size - 1 - zeros] == '0') ++zeros;
  return (std::size_t)decimals - zeros;
}

Measure measured(const Padded& padded, std::size_t first, std::size_t end, char* scratch) {
  const TextColumn& column = padded.column;
  Measure found;
  for (std::size_t row = first; row < end; ++row) {
    std::size_t size;
    if (column.numbers) {
      size = styled_text(column.style, column.numbers[row], scratch);
      if (column.style.trimmed && size)
        found.decimals = std::max(found.decimals, (int)fraction_digits(scratch, size, column.style.digits));
    } else {
      size = padded.widths[(std::size_t)column.codes[row]];
    }
    found.width = std::max(found.width, size);
  }
  return found;
}

// Bytes beyond characters in some rows of words.
std::size_t extra_bytes(const Padded& padded, std::size_t first, std::size_t end) {
  std::size_t extra = 0;
  if (!padded.column.numbers)
    for (std::size_t row = first; row < end; ++row) {
      const auto code = (std::size_t)padded.column.codes[row];
      extra += padded.column.fields[code].size() - padded.widths[code];
    }
  return extra;
}

char* fill(char* at, std::size_t count, char c) {
  std::memset(at, c, count);
  return at + count;
}

// `scratch` has room for the untrimmed text of a number.
char* put_padded(const Padded& padded, std::size_t row, char* scratch, char* at) {
  const TextColumn& column = padded.column;
  if (!column.numbers) {
    const auto code = (std::size_t)column.codes[row];
    return fill(put(column.fields[code], at), padded.width - padded.widths[code], ' ');
  }
  std::size_t size = styled_text(column.style, column.numbers[row], scratch);
  if (size) size -= padded.dropped;
  // a number that another thread changed since it was measured stays within its cell
  size = std::min(size, padded.width);
  at = fill(at, padded.width - size, ' ');
  std::memcpy(at, scratch, size);
  return at + size;
}

std::string head(const std::vector<std::string>& headers, const std::vector<Padded>& columns) {
  std::string names = "|", rule = "|";
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string space(columns[c].width - characters(headers[c]), ' '), line(columns[c].width - 1, '-');
    const bool words = !columns[c].column.numbers;
    names += words ? ' ' + headers[c] + space + " |" : ' ' + space + headers[c] + " |";
    rule += words ? " :" + line + " |" : ' ' + line + ": |";
  }
  return names + '\n' + rule + '\n';
}

// Decides what numbers drop and how wide their column is.
void settle(Padded& padded, const Measure& whole, std::size_t least_width) {
  const NumberStyle& style = padded.column.style;
  if (style.trimmed && whole.width && whole.decimals < style.digits)
    padded.dropped = (std::size_t)(style.digits - whole.decimals) + (whole.decimals == 0);  // with the point
  padded.width = std::max(least_width, whole.width - padded.dropped);
}

// `measures` are those of the blocks, column by column within a block.
void settle(std::vector<Padded>& columns, const std::vector<std::string>& headers,
            const std::vector<Measure>& measures) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Measure whole;
    for (std::size_t m = c; m < measures.size(); m += columns.size()) {
      whole.width = std::max(whole.width, measures[m].width);
      whole.decimals = std::max(whole.decimals, measures[m].decimals);
    }
    settle(columns[c], whole, std::max(NARROWEST, characters(headers[c])));
  }
}

}  // namespace

void markdown_text(const std::vector<std::string>& headers, const std::vector<TextColumn>& given,
                   std::size_t rows, int threads, const Room& room) {
  std::vector<Padded> columns;
  std::size_t longest = 0;
  for (const TextColumn& column : given) {
    columns.push_back({column, {}, 0, 0});
    for (const std::string& field : column.fields) columns.back().widths.push_back(characters(field));
    longest = std::max(longest, cell_capacity(column));
  }
  const std::size_t count = columns.size(), blocks = block_count(rows);
  std::vector<Measure> measures(blocks * count);
  std::vector<std::size_t> starts(blocks + 1, 0);
  for_each_block(rows, threads, [&] {
    return [&, scratch = Scratch(longest + 1)](std::size_t block, std::size_t first, std::size_t end) {
      for (std::size_t c = 0; c < count; ++c) {
        measures[block * count + c] = measured(columns[c], first, end, scratch.get());
        starts[block + 1] += extra_bytes(columns[c], first, end);
      }
    };
  });
  settle(columns, headers, measures);
  std::size_t line = 2;  // the first bar and the line's end
  for (const Padded& column : columns) line += column.width + 3;
  const std::string top = head(headers, columns);
  starts[0] = top.size();
  for (std::size_t block = 0; block < blocks; ++block)
    starts[block + 1] += starts[block] + line * (std::min(rows, (block + 1) * BLOCK_ROWS) - block * BLOCK_ROWS);
  char* const text = room(starts[blocks]);
  if (!text) return;
  put(top, text);
  for_each_block(rows, threads, [&] {
    return [&, scratch = Scratch(longest + 1)](std::size_t block, std::size_t first, std::size_t end) {
      char* at = text + starts[block];
      for (std::size_t row = first; row < end; ++row) {
        *at++ = '|';
        for (const Padded& column : columns) {
          *at++ = ' ';
          at = put_padded(column, row, scratch.get(), at);
          *at++ = ' ';
          *at++ = '|';
        }
        *at++ = '\n';
      }
    };
  });
}

std::vector<std::string> column_texts(const TextColumn& column, std::size_t rows) {
  Padded padded{column, {}, 0, 0};
  std::string text(cell_capacity(column), '\0');
  if (column.numbers) settle(padded, measured(padded, 0, rows, text.data()), 0);
  std::vector<std::string> texts;
  texts.reserve(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto size = (std::size_t)(put_cell(column, row, text.data()) - text.data());
    texts.emplace_back(text, 0, size ? size - padded.dropped : 0);
  }
  return texts;
}
