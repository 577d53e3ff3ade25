// Numbers that compiled units read as packs: memory aligned for the widest.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), ALIGNMENT)); }
  void deallocate(T* at, std::size_t) { ::operator delete(at, ALIGNMENT); }
  friend bool operator==(AlignedAllocator, AlignedAllocator) { return true; }
  friend bool operator!=(AlignedAllocator, AlignedAllocator) { return false; }

 private:
  static constexpr std::align_val_t ALIGNMENT{64};
};

using Packed = std::vector<double, AlignedAllocator<double>>;
