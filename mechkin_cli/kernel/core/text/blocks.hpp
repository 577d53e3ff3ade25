// Work cut into blocks of rows, done by threads in any order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "rows/threads.hpp"

constexpr std::size_t BLOCK_ROWS = 1024;

inline std::size_t block_count(std::size_t rows) { return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS; }

// Calls work(block, first row, end row) once for every block, where each thread has its own `work = make()` with the
// memory that it uses again for every block.
template <class Make>
void for_each_block(std::size_t rows, int threads, const Make& make) {
  std::vector<decltype(make())> works;
  const int count = (int)std::clamp<std::size_t>((std::size_t)threads, 1, std::max<std::size_t>(block_count(rows), 1));
  for (int i = 0; i < count; ++i) works.push_back(make());
  over_rows((long)rows, (long)BLOCK_ROWS, count, [&](long begin, long end, int thread) {
    for (std::size_t first = (std::size_t)begin; first < (std::size_t)end; first += BLOCK_ROWS)
      works[(std::size_t)thread](first / BLOCK_ROWS, first, std::min((std::size_t)end, first + BLOCK_ROWS));
  });
}
