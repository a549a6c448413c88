#include "harness/base/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace whirl::base {

void check_failed(const char* condition, const char* file, int line, const char* names,
                  const std::string& values) {
  std::fprintf(stderr, "%s:%d: check failed: %s", file, line, condition);
  if (!values.empty()) std::fprintf(stderr, "  with %s = %s", names, values.c_str());
  std::fprintf(stderr, "\nThis is a bug in whirl, not in your plan or firmware.\n");
  std::abort();
}

}  // namespace whirl::base
