// A short list of numbers that stands where it is declared: up to `N` of them need no memory of their own.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

template <std::size_t N>
class Numbers {
 public:
  Numbers() = default;
  explicit Numbers(std::size_t size, double value = 0.0) { assign(size, value); }
  Numbers(const std::vector<double>& values) { *this = values; }
  Numbers(const Numbers& other) { *this = other; }
  Numbers(Numbers&& other) noexcept { *this = static_cast<Numbers&&>(other); }
  ~Numbers() {
    if (at_ != place_) delete[] at_;
  }
  Numbers& operator=(const Numbers& other) {
    if (this != &other) copy(other.at_, other.size_);
    return *this;
  }
  Numbers& operator=(Numbers&& other) noexcept {
    if (other.at_ == other.place_) return *this = static_cast<const Numbers&>(other);
    if (this == &other) return *this;
    if (at_ != place_) delete[] at_;
    at_ = other.at_, size_ = other.size_, room_ = other.room_;
    other.at_ = other.place_, other.size_ = 0, other.room_ = N;
    return *this;
  }
  Numbers& operator=(const std::vector<double>& values) {
    copy(values.data(), values.size());
    return *this;
  }
  operator std::vector<double>() const { return std::vector<double>(begin(), end()); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  double* data() { return at_; }
  const double* data() const { return at_; }
  double* begin() { return at_; }
  const double* begin() const { return at_; }
  double* end() { return at_ + size_; }
  const double* end() const { return at_ + size_; }
  double& operator[](std::size_t k) { return at_[k]; }
  const double& operator[](std::size_t k) const { return at_[k]; }
  // New numbers are zero.
  void resize(std::size_t size) {
    if (size > room_) grow(size);
    for (std::size_t k = size_; k < size; ++k) at_[k] = 0.0;
    size_ = size;
  }
  void assign(std::size_t size, double value) {
    size_ = 0;
    if (size > room_) grow(size);
    for (std::size_t k = 0; k < size; ++k) at_[k] = value;
    size_ = size;
  }
  friend bool operator==(const Numbers& a, const Numbers& b) {
    if (a.size_ != b.size_) return false;
    for (std::size_t k = 0; k < a.size_; ++k)
      if (!(a.at_[k] == b.at_[k])) return false;
    return true;
  }
  friend bool operator!=(const Numbers& a, const Numbers& b) { return !(a == b); }

 private:
  void copy(const double* from, std::size_t size) {
    size_ = 0;
    if (size > room_) grow(size);
    for (std::size_t k = 0; k < size; ++k) at_[k] = from[k];
    size_ = size;
  }
  void grow(std::size_t room) {
    double* const larger = new double[room];
    for (std::size_t k = 0; k < size_; ++k) larger[k] = at_[k];
    if (at_ != place_) delete[] at_;
    at_ = larger, room_ = room;
  }

  std::size_t size_ = 0, room_ = N;
  double* at_ = place_;
  double place_[N];
};
