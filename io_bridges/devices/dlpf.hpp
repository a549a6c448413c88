// A digital low-pass filter known by two figures of a datasheet: its bandwidth and its delay.
//
//   Model    two real poles behind a pure delay: -3 dB at the bandwidth; delay at low frequency as
//            printed, where two real poles allow it. With s = delay * 2 pi * bandwidth:
//              s > 1.287   equal poles, the rest is pure delay (in whole steps)
//              1 .. 1.287  poles apart: t1 + t2 = delay, t1 t2 from the -3 dB point
//              s < 1       one pole; its delay is longer than printed
//   Method   each pole as a first-order recursion; what delay the recursion lacks, the pure delay
//            gives (to half a step)
//   Error    -3 dB and delay against the table (tests/dlpf_test.cpp)
#pragma once
#include <array>
#include <cstddef>

namespace whirl::io {

class Dlpf {
 public:
  Dlpf(double bandwidth_Hz, double delay_s, double step_s);

  double step(double input);
  void settle(double input);  // as if it had been so for ever
  double output() const { return second_; }

 private:
  static constexpr std::size_t kMaxDelaySteps = 15;

  double first_blend_ = 1.0, second_blend_ = 1.0;  // 1 - exp(-step / tau)
  double first_ = 0.0, second_ = 0.0;
  std::size_t delay_steps_ = 0, next_ = 0;
  std::array<double, kMaxDelaySteps + 1> held_{};
};

}  // namespace whirl::io
