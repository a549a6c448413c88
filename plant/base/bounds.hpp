// Collects the first bound that a parameter breaks, as one sentence for whoever wrote the file.
#pragma once
#include <optional>
#include <string>

#include "base/result.hpp"

namespace whirl::plant {

class Bounds {
 public:
  explicit Bounds(std::string place) : place_(std::move(place)) {}

  // NaN is outside every range.
  void within(const char* name, double value, double low, double high);
  void require(bool condition, const std::string& what);
  void merge(const Result<Done>& other);
  Result<Done> result() const;

 private:
  std::string place_;
  std::optional<Error> error_;
};

}  // namespace whirl::plant
