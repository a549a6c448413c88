// Adds the host time of its scope to a figure. For reports only: nothing in a verdict reads it.
#pragma once
#include <chrono>

namespace whirl {

class Stopwatch {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Stopwatch(double& sum_s) : sum_s_(sum_s), begin_(Clock::now()) {}
  ~Stopwatch() { sum_s_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_s_;
  Clock::time_point begin_;
};

}  // namespace whirl
