// The yardstick of `table_files.py`: numbers as text by std::to_chars, with a comma behind each, on some threads.
// Prints the processor's time and that of the clock of each round.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <chrono>
#include <thread>
#include <vector>

int main(int, char** words) {
  const std::size_t count = (std::size_t)std::atol(words[2]);
  const int threads = std::atoi(words[3]), rounds = std::atoi(words[4]);
  std::vector<double> numbers(count);
  std::FILE* file = std::fopen(words[1], "rb");
  if (!file || std::fread(numbers.data(), sizeof(double), count, file) != count) return 1;
  std::fclose(file);
  constexpr std::size_t ROOM = 1 << 20;
  std::vector<std::vector<char>> rooms((std::size_t)threads, std::vector<char>(ROOM));
  for (int round = 0; round < rounds; ++round) {
    const std::clock_t before = std::clock();
    const auto start = std::chrono::steady_clock::now();
    std::vector<std::thread> others;
    for (int t = 0; t < threads; ++t)
      others.emplace_back([&, t] {
        char* const room = rooms[(std::size_t)t].data();
        char* at = room;
        for (std::size_t i = count * (std::size_t)t / (std::size_t)threads;
             i < count * (std::size_t)(t + 1) / (std::size_t)threads; ++i) {
          if (at > room + ROOM - 64) at = room;
          at = std::to_chars(at, at + 32, numbers[i]).ptr;
          *at++ = ',';
        }
      });
    for (std::thread& other : others) other.join();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::printf("%.6f %.6f\n", (double)(std::clock() - before) / CLOCKS_PER_SEC, took.count());
  }
}
