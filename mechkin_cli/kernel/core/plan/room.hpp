// Memory of what a unit computes in.
#pragma once

namespace {

// Hands out memory, aligned for packs; without memory it only counts.
struct Room {
  char* memory;
  long used = 0;
  template <class T>
  T* take(int count) {
    char* const here = memory ? memory + used : nullptr;
    used += ((long)count * (long)sizeof(T) + 63) / 64 * 64;
    return reinterpret_cast<T*>(here);
  }
};

}  // namespace
