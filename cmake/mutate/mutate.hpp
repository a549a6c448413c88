// What the mutated copies of the judging code call: each mutant is in the program, and the environment
// variable WHIRL_MUTANT chooses one by number. Without it every call here is what the source says.
#pragma once
#include <cstdlib>
#include <type_traits>

namespace whirl::mutate {

inline int chosen() {
  static const int number = [] {
    const char* text = std::getenv("WHIRL_MUTANT");
    return text == nullptr ? 0 : std::atoi(text);
  }();
  return number;
}
inline bool on(int id) {
  return chosen() == id;
}
inline bool off(int id) {
  return chosen() != id;
}

// id: the boundary moved; id + 1: the other direction.
template <typename A, typename B>
bool less(int id, A a, B b) {
  return on(id) ? a <= b : on(id + 1) ? a > b : a < b;
}
template <typename A, typename B>
bool less_or_equal(int id, A a, B b) {
  return on(id) ? a < b : on(id + 1) ? a >= b : a <= b;
}
template <typename A, typename B>
bool more(int id, A a, B b) {
  return on(id) ? a >= b : on(id + 1) ? a < b : a > b;
}
template <typename A, typename B>
bool more_or_equal(int id, A a, B b) {
  return on(id) ? a > b : on(id + 1) ? a <= b : a >= b;
}
template <typename A, typename B>
bool equal(int id, A a, B b) {
  return on(id) ? a != b : a == b;
}
template <typename A, typename B>
bool unequal(int id, A a, B b) {
  return on(id) ? a == b : a != b;
}

template <typename A, typename B>
auto plus(int id, A a, B b) {
  return on(id) ? a - b : a + b;
}
template <typename A, typename B>
auto minus(int id, A a, B b) {
  return on(id) ? a + b : a - b;
}
template <typename A, typename B>
auto times(int id, A a, B b) {
  return on(id) ? a / b : a * b;
}
template <typename A, typename B>
auto over(int id, A a, B b) {
  return on(id) ? a * b : a / b;
}
template <typename A, typename B>
auto rest(int id, A a, B b) {
  return on(id) ? a * b : a % b;
}

// b is not evaluated where the source would not.
template <typename B>
bool both(int id, bool a, B b) {
  return on(id) ? a || b() : a && b();
}
template <typename B>
bool either(int id, bool a, B b) {
  return on(id) ? a && b() : a || b();
}
inline bool truth(int id, bool condition) {
  return condition != on(id);
}

template <typename T>
T opposite(int id, T x) {
  return on(id) ? static_cast<T>(-x) : x;
}
// id: one more; id + 1: one less. Of a real number: one percent more, one less.
template <typename T>
T constant(int id, T x) {
  if (std::is_floating_point_v<T> && on(id) && x != T{}) return static_cast<T>(x * 1.01);
  return on(id) ? static_cast<T>(x + 1) : on(id + 1) ? static_cast<T>(x - 1) : x;
}
// A number that is returned becomes 0, and 0 becomes 1; a pointer null.
template <typename T>
T result(int id, T x) {
  if constexpr (std::is_same_v<T, bool>) {
    return x != on(id);
  } else if constexpr (std::is_pointer_v<T>) {
    return on(id) ? nullptr : x;
  } else {
    return !on(id) ? x : x == T{} ? static_cast<T>(1) : T{};
  }
}

}  // namespace whirl::mutate
