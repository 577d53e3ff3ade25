// Work cut into blocks of rows, done by threads in any order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

constexpr std::size_t BLOCK_ROWS = 1024;

inline std::size_t block_count(std::size_t rows) { return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS; }

// Calls work(block, first row, end row) once for every block, where each thread has its own `work = make()` with the
// memory that it uses again for every block. What it throws first comes out here, once all threads have ended.
template <class Make>
void for_each_block(std::size_t rows, int threads, const Make& make) {
  const std::size_t blocks = block_count(rows);
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto run = [&] {
    try {
      auto work = make();
      for (std::size_t block; (block = next++) < blocks;)
        work(block, block * BLOCK_ROWS, std::min(rows, (block + 1) * BLOCK_ROWS));
    } catch (...) {
      const std::lock_guard<std::mutex> held(failing);
      if (!failure) failure = std::current_exception();
    }
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < (std::size_t)threads && i < blocks; ++i) {
    try {
      helpers.emplace_back(run);
    } catch (const std::system_error&) {
      break;  // no thread to be had: the others do its share
    }
  }
  run();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}
