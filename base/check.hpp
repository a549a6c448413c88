// WHIRL_CHECK(condition, values...): our own bugs stop the program at once, in every build type.
//
//   What it is   an assertion that stays armed; says the condition, its place and the values
//   Who acts     by default it prints that and aborts. A process that can do better (end one plan and
//                run the next, report through its link) sets a handler; one that returns ends in abort.
//   Not for      what a user can get wrong (see result.hpp) or a firmware can do (see Finding)
#pragma once
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <string>

namespace whirl::base {

// Thrown by throw_check_failure: for a process with one catch at its top.
class CheckFailed : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};
using CheckHandler = void (*)(const std::string& message);
void set_check_handler(CheckHandler handler);
[[noreturn]] void throw_check_failure(const std::string& message);

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
