// Which expectation of one run is which of another: by its name, and its place among those of that name.
#pragma once
#include <map>
#include <string>

#include "results/report.hpp"

namespace whirl::results {

class SameExpectation {  // of one run; to be asked in the order of its expectations
 public:
  std::string name(const Expectation& e) {
    const int n = ++seen_[e.name];
    return n == 1 ? e.name : e.name + " (" + std::to_string(n) + ")";
  }

 private:
  std::map<std::string, int> seen_;
};

}  // namespace whirl::results
