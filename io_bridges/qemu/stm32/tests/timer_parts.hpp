// Two timers as the tests want them: a general one on APB1 and an advanced one on APB2.
#pragma once
#include "io_bridges/qemu/stm32/timer.hpp"

namespace whirl::stm32::test {

inline TimerConfig general(int number = 3) {
  TimerConfig config;
  config.number = number;
  config.kind = TimerKind::general_16;
  config.update_irq = 29;
  return config;
}

inline TimerConfig advanced() {
  TimerConfig config;
  config.number = 1;
  config.kind = TimerKind::advanced;
  config.on_apb2 = true;
  config.update_irq = 25;
  config.compare_irq = 27;
  config.trigger_irq = 26;
  config.break_irq = 24;
  return config;
}

// The first clock edge at which n clocks of f have passed since t = 0.
inline Nanoseconds edge_ns(std::int64_t n, std::int64_t f_Hz) {
  return (n * 1'000'000'000 + f_Hz - 1) / f_Hz;
}

}  // namespace whirl::stm32::test
