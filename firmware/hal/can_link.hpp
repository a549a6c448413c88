// CAN2 of the PX4FMU v1, 1 Mbit/s: PB12 and PB13 on the header, the transceiver is outside.
#pragma once
#include "firmware/hal/bxcan.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/registers.hpp"

namespace fw::hal {

struct HeaderCan {
  using Can = hw::CAN2;
  using Filters = hw::CAN1;
  using Lock = PriorityLock<kPriorityCan>;
  // 42 MHz / 3 / (1 + 11 + 2), sampled at 86 %.
  static constexpr std::uint32_t kBitTiming = hw::bxcan::bit_timing(3, 11, 2);
  static constexpr std::uint32_t kFirstBank = 14;  // CAN2SB after reset
  static constexpr std::size_t kRxFrames = 32, kTxFrames = 24;
  static void start();
};

extern BxCan<HeaderCan> can2;

std::array<std::uint8_t, 16> unique_id();  // of this part: 12 bytes, then zeros

}  // namespace fw::hal

namespace fw {
void can_frame_came(const hal::CanFrame& frame);  // supplied by the application; from the interrupt
}  // namespace fw
