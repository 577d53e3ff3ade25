// What comes of a call that may be refused: a value, or the sentence that says what is wrong with what was given.
//
// The core throws nothing of its own. Memory that runs out is std::bad_alloc, which passes through it to the skin, and
// the end of the process where the core is built without exceptions.
#pragma once

#include <optional>
#include <string>
#include <utility>

// What is wrong with what was given, or nothing.
using Refusal = std::optional<std::string>;

// A value, or the refusal that stands in its place.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T&& value) : value_(std::move(value)) {}
  Result(Refusal refusal) : refusal_(std::move(refusal)) {}
  const Refusal& refusal() const { return refusal_; }
  T& operator*() { return *value_; }
  T* operator->() { return &*value_; }

 private:
  std::optional<T> value_;
  Refusal refusal_;
};

// An object whose constructor takes what is given, and whose `prepare` refuses what does not fit together.
template <class T, class... Given>
Result<T> make(Given&&... given) {
  T made(std::forward<Given>(given)...);
  if (Refusal refused = made.prepare()) return refused;
  return made;
}

// In a function that gives a Refusal or a Result: goes no farther where something is not as it must be, or where another
// call refuses.
#define REQUIRE(condition, sentence)            \
  do {                                          \
    if (!(condition)) return Refusal(sentence); \
  } while (0)
#define CHECK(call)                               \
  do {                                            \
    if (Refusal refused = (call)) return refused; \
  } while (0)
