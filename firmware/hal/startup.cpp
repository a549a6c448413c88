// From reset to fw_main: vector table, FPU, RAM. Runs no constructors (the linker script asserts
// that there are none).
#include "firmware/hal/registers.hpp"
#include "firmware/hal/vectors.hpp"

extern "C" {
// Overridden where a driver needs the line.
#define FW_WEAK __attribute__((weak, nothrow, alias("unexpected_interrupt")))
FW_WEAK void exti3_handler();
FW_WEAK void dma1_stream2_handler();
FW_WEAK void dma1_stream3_handler();
FW_WEAK void dma1_stream6_handler();
FW_WEAK void tim1_cc_handler();
FW_WEAK void tim4_handler();
FW_WEAK void i2c1_ev_handler();
FW_WEAK void i2c1_er_handler();
FW_WEAK void i2c2_ev_handler();
FW_WEAK void i2c2_er_handler();
FW_WEAK void spi1_handler();
FW_WEAK void usart1_handler();
FW_WEAK void exti15_10_handler();
FW_WEAK void tim5_handler();
FW_WEAK void tim6_dac_handler();
FW_WEAK void tim7_handler();
FW_WEAK void dma2_stream0_handler();
FW_WEAK void can2_tx_handler();
FW_WEAK void can2_rx0_handler();
FW_WEAK void can2_sce_handler();
FW_WEAK void dma2_stream6_handler();
FW_WEAK void dma2_stream7_handler();
FW_WEAK void i2c3_ev_handler();
FW_WEAK void i2c3_er_handler();
#undef FW_WEAK
}

namespace {

constexpr auto make_vectors() {
  fw::hal::VectorTable<fw::hw::kIrqCount> table;
  const auto on = [&table](fw::hw::Irq irq, fw::hal::Handler handler) {
    table.irq[static_cast<unsigned>(irq)] = handler;
  };
  using fw::hw::Irq;
  on(Irq::EXTI3, exti3_handler);
  on(Irq::DMA1_Stream2, dma1_stream2_handler);
  on(Irq::DMA1_Stream3, dma1_stream3_handler);
  on(Irq::DMA1_Stream6, dma1_stream6_handler);
  on(Irq::TIM1_CC, tim1_cc_handler);
  on(Irq::TIM4_Global, tim4_handler);
  on(Irq::I2C1_EV, i2c1_ev_handler);
  on(Irq::I2C1_ER, i2c1_er_handler);
  on(Irq::I2C2_EV, i2c2_ev_handler);
  on(Irq::I2C2_ER, i2c2_er_handler);
  on(Irq::SPI1_Global, spi1_handler);
  on(Irq::USART1_Global, usart1_handler);
  on(Irq::EXTI15_10, exti15_10_handler);
  on(Irq::TIM5_Global, tim5_handler);
  on(Irq::TIM6_DAC, tim6_dac_handler);
  on(Irq::TIM7_Global, tim7_handler);
  on(Irq::DMA2_Stream0, dma2_stream0_handler);
  on(Irq::CAN2_TX, can2_tx_handler);
  on(Irq::CAN2_RX0, can2_rx0_handler);
  on(Irq::CAN2_SCE, can2_sce_handler);
  on(Irq::DMA2_Stream6, dma2_stream6_handler);
  on(Irq::DMA2_Stream7, dma2_stream7_handler);
  on(Irq::I2C3_EV, i2c3_ev_handler);
  on(Irq::I2C3_ER, i2c3_er_handler);
  return table;
}

}  // namespace

__attribute__((section(".isr_vector"), used)) constinit const auto vectors = make_vectors();

extern "C" __attribute__((noreturn, used)) void reset_handler() {
  fw::hw::SCB::CPACR::set(fw::hw::SCB::CP10_CP11_FULL);
  __asm volatile("dsb\n isb" ::: "memory");
  fw::hal::prepare_memory();
  fw_main();
  for (;;) __asm volatile("wfi");
}

// A line that nobody asked for: recorded like a fault, because it is one.
extern "C" __attribute__((used)) void unexpected_interrupt() {
  __asm volatile("udf #0");
}
