// WHIRL_CHECK(condition, values...): our own bugs stop the program at once, in every build type.
//
//   What it is   an assertion that stays armed; prints the condition, its place and the values
//   Not for      what a user can get wrong (see result.hpp) or a firmware can do (see Finding)
#pragma once
#include <initializer_list>
#include <sstream>
#include <string>

namespace whirl::base {

[[noreturn]] void check_failed(const char* condition, const char* file, int line, const char* names,
                               const std::string& values);

template <typename... Values>
std::string list_values(const Values&... values) {
  std::ostringstream out;
  out.precision(17);
  std::size_t n = 0;
  ((out << (n++ == 0 ? "" : ", ") << values), ...);
  return out.str();
}

}  // namespace whirl::base

#define WHIRL_CHECK(condition, ...)                                             \
  do {                                                                          \
    if (!(condition)) {                                                         \
      ::whirl::base::check_failed(#condition, __FILE__, __LINE__, #__VA_ARGS__, \
                                  ::whirl::base::list_values(__VA_ARGS__));     \
    }                                                                           \
  } while (false)
