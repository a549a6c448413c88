// From reset to fw_main on the STM32F103: vector table and RAM. Runs no constructors (the linker
// script asserts that there are none).
#include "firmware/esc/image/registers.hpp"
#include "firmware/hal/vectors.hpp"

extern "C" {
void systick_handler();
void adc1_2_handler();
void tim2_handler();
void i2c2_ev_handler();
void i2c2_er_handler();
void dma1_channel4_handler();
void can_tx_handler();
void can_rx0_handler();
void can_sce_handler();
}

namespace {

constexpr auto make_vectors() {
  fw::hal::VectorTable<fw::f103::kIrqCount> table;
  table.system[14] = systick_handler;
  const auto on = [&table](fw::f103::Irq irq, fw::hal::Handler handler) {
    table.irq[static_cast<unsigned>(irq)] = handler;
  };
  using fw::f103::Irq;
  on(Irq::ADC1_2, adc1_2_handler);
  on(Irq::CAN_TX, can_tx_handler);
  on(Irq::CAN_RX0, can_rx0_handler);
  on(Irq::CAN_SCE, can_sce_handler);
  on(Irq::TIM2_Global, tim2_handler);
  on(Irq::I2C2_EV, i2c2_ev_handler);
  on(Irq::I2C2_ER, i2c2_er_handler);
  on(Irq::DMA1_Channel4, dma1_channel4_handler);
  return table;
}

}  // namespace

__attribute__((section(".isr_vector"), used)) constinit const auto vectors = make_vectors();

extern "C" __attribute__((noreturn, used)) void reset_handler() {
  fw::hal::prepare_memory();
  fw_main();
  for (;;) __asm volatile("wfi");
}

// A line that nobody asked for: recorded like a fault, because it is one.
extern "C" __attribute__((used)) void unexpected_interrupt() {
  __asm volatile("udf #0");
}
