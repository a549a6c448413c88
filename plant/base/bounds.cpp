#include "plant/base/bounds.hpp"

#include <cstdio>

namespace whirl::plant {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

}  // namespace

void Bounds::within(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  require(false, std::string(name) + " is " + text(value) + ", must lie from " + text(low) +
                     " to " + text(high));
}

void Bounds::require(bool condition, const std::string& what) {
  if (!condition && !error_) error_ = Error{ErrorKind::bad_input, place_, what, ""};
}

void Bounds::merge(const Result<Done>& other) {
  if (!other.ok() && !error_) error_ = other.error();
}

Result<Done> Bounds::result() const {
  if (error_) return *error_;
  return Done{};
}

}  // namespace whirl::plant
