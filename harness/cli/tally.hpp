// How the plans of one command went: counts by exit code, and the code of them all.
#pragma once
#include <array>
#include <string>

#include "results/verdict.hpp"

namespace whirl::cli {

class Tally {
 public:
  void add(int exit_code) {
    const bool known = exit_code >= 0 && exit_code < static_cast<int>(counts_.size());
    ++counts_[static_cast<std::size_t>(known ? exit_code : 4)];
    code_ = results::worse_exit_code(code_, exit_code);
  }
  // Plans that an interruption kept from running: they show nothing.
  void add_not_run(std::size_t plans) {
    if (plans == 0) return;
    not_run_ += plans;
    code_ = results::worse_exit_code(code_, 3);
  }
  std::size_t plans() const;  // that ran, or were to run
  // Something beside the plans went wrong.
  void worsen(int exit_code) { code_ = results::worse_exit_code(code_, exit_code); }
  int code() const { return code_; }
  std::string summary() const;  // "23 passed, 1 failed, 1 bad input"

 private:
  std::array<int, 5> counts_{};
  std::size_t not_run_ = 0;
  int code_ = 0;
};

}  // namespace whirl::cli
