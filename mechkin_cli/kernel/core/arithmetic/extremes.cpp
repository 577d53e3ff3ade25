#include "arithmetic/extremes.hpp"

#include <cstdint>
#include <cstring>
#include <limits>

namespace {

// Pairs of numbers, which every processor compares at once, and so many pairs side by side, as one comparison waits for
// the one before: what is found does not depend on it.
typedef double Two __attribute__((vector_size(16)));
typedef std::int64_t Counts __attribute__((vector_size(16)));
constexpr std::size_t TWOS = 4, BESIDE = 2 * TWOS;
constexpr double WITHOUT_END = std::numeric_limits<double>::infinity(), NOTHING = std::numeric_limits<double>::quiet_NaN();

struct Reach {
  Two largest[TWOS], smallest[TWOS];
  Counts cells[TWOS];

  Reach() : cells{} {
    for (std::size_t k = 0; k < TWOS; ++k) {
      largest[k] = Two{-WITHOUT_END, -WITHOUT_END};
      smallest[k] = Two{WITHOUT_END, WITHOUT_END};
    }
  }
  void take(const double* numbers) {
    for (std::size_t k = 0; k < TWOS; ++k) {
      Two x;
      std::memcpy(&x, numbers + 2 * k, sizeof x);
      // false with nan
      largest[k] = x > largest[k] ? x : largest[k];
      smallest[k] = x < smallest[k] ? x : smallest[k];
      cells[k] -= x == x;  // true is -1
    }
  }
};

}  // namespace

Extremes extremes(const double* numbers, std::size_t count) {
  Reach reach;
  const std::size_t whole = count - count % BESIDE;
  for (std::size_t i = 0; i < whole; i += BESIDE) reach.take(numbers + i);
  double rest[BESIDE];
  for (std::size_t k = 0; k < BESIDE; ++k) rest[k] = whole + k < count ? numbers[whole + k] : NOTHING;
  reach.take(rest);
  Extremes found = {0, 0, -WITHOUT_END, WITHOUT_END};
  for (std::size_t k = 0; k < BESIDE; ++k) {
    const double most = reach.largest[k / 2][k % 2], least = reach.smallest[k / 2][k % 2];
    found.cells += (std::size_t)reach.cells[k / 2][k % 2];
    found.largest = most > found.largest ? most : found.largest;
    found.smallest = least < found.smallest ? least : found.smallest;
  }
  if (found.cells && (found.largest == WITHOUT_END || found.smallest == -WITHOUT_END))
    for (std::size_t i = 0; i < count; ++i) found.infinite += numbers[i] == WITHOUT_END || numbers[i] == -WITHOUT_END;
  return found;
}
