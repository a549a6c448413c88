#include "firmware/hal/can_link.hpp"

#include "firmware/hal/pins.hpp"

namespace fw::hal {

using namespace hw;

constinit BxCan<HeaderCan> can2;

void HeaderCan::start() {
  constexpr std::uint32_t kAf = 9;
  RCC::AHB1ENR::set(RCC::GPIOBEN);
  RCC::APB1ENR::set(RCC::CAN1EN | RCC::CAN2EN);  // CAN1 for its filters
  CanRx::alternate(kAf, false, Pull::up);
  CanTx::alternate(kAf, false, Pull::none);
  Nvic<Irq::CAN2_TX>::enable(kPriorityCan);
  Nvic<Irq::CAN2_RX0>::enable(kPriorityCan);
  Nvic<Irq::CAN2_SCE>::enable(kPriorityCan);
}

std::array<std::uint8_t, 16> unique_id() {
  std::array<std::uint8_t, 16> bytes{};
  for (std::uint32_t i = 0; i < 12; ++i) {
    const std::uint32_t word = RegBlock<UID::base>::read(i & ~3u);
    bytes[i] = static_cast<std::uint8_t>(word >> 8 * (i % 4));
  }
  return bytes;
}

}  // namespace fw::hal

extern "C" void can2_tx_handler() {
  fw::hal::can2.on_transmit();
}
extern "C" void can2_rx0_handler() {
  if (fw::hal::can2.on_receive()) fw::can_frame_came(fw::hal::can2.newest());
}
extern "C" void can2_sce_handler() {
  fw::hal::can2.on_status();
}
