// From reset to fw_main on the STM32F103: vector table and RAM. Runs no constructors (the linker
// script asserts that there are none).
#include <array>
#include <cstdint>

#include "firmware/esc/image/registers.hpp"

extern "C" {
extern std::uint32_t stack_top, data_begin, data_end, data_image, bss_begin, bss_end;
void fw_main();
void reset_handler();
void hard_fault_handler();
void unexpected_interrupt();
void systick_handler();
void adc1_2_handler();
void tim2_handler();
void i2c2_ev_handler();
void i2c2_er_handler();
void usart1_handler();
}

namespace {

using Handler = void (*)();

struct VectorTable {
  const void* stack;
  std::array<Handler, 15> system;
  std::array<Handler, fw::f103::kIrqCount> irq;
};

constexpr VectorTable make_vectors() {
  VectorTable table{&stack_top, {}, {}};
  table.system.fill(unexpected_interrupt);
  table.irq.fill(unexpected_interrupt);
  table.system[0] = reset_handler;
  table.system[2] = hard_fault_handler;
  table.system[14] = systick_handler;
  const auto on = [&table](fw::f103::Irq irq, Handler handler) {
    table.irq[static_cast<unsigned>(irq)] = handler;
  };
  using fw::f103::Irq;
  on(Irq::ADC1_2, adc1_2_handler);
  on(Irq::TIM2_Global, tim2_handler);
  on(Irq::I2C2_EV, i2c2_ev_handler);
  on(Irq::I2C2_ER, i2c2_er_handler);
  on(Irq::USART1_Global, usart1_handler);
  return table;
}

}  // namespace

__attribute__((section(".isr_vector"), used)) constinit const VectorTable vectors = make_vectors();

extern "C" __attribute__((noreturn, used)) void reset_handler() {
  for (std::uint32_t *to = &data_begin, *from = &data_image; to < &data_end;) *to++ = *from++;
  for (std::uint32_t* to = &bss_begin; to < &bss_end;) *to++ = 0;
  fw_main();
  for (;;) __asm volatile("wfi");
}

// A line that nobody asked for: recorded like a fault, because it is one.
extern "C" __attribute__((used)) void unexpected_interrupt() {
  __asm volatile("udf #0");
}
