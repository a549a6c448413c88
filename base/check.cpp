#include "base/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace whirl::base {
namespace {

CheckHandler handler = nullptr;

}  // namespace

void set_check_handler(CheckHandler wanted) {
  handler = wanted;
}

void throw_check_failure(const std::string& message) {
  throw CheckFailed(message);
}

void check_failed(const char* condition, const char* file, int line, const char* names,
                  const std::string& values) {
  std::string message =
      std::string(file) + ":" + std::to_string(line) + ": check failed: " + condition;
  if (!values.empty()) message += std::string("  with ") + names + " = " + values;
  if (handler != nullptr) handler(message);
  std::fprintf(stderr, "%s\nThis is a bug in whirl, not in your plan or firmware.\n",
               message.c_str());
  std::abort();
}

}  // namespace whirl::base
