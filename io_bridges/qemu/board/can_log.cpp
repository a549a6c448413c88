#include "io_bridges/qemu/board/can_log.hpp"

#include <algorithm>
#include <utility>

#include "io_bridges/qemu/stm32/bxcan.hpp"

namespace whirl::board {

void log_can(io::CanBus& bus, int number, io::Batch& happened) {
  bus.on_transfer([&happened, number](const io::CanTransfer& t) {
    io::CanRecord record;
    record.start_ns = t.start_ns;
    record.frame.id = t.frame.id;
    record.frame.flags =
        static_cast<std::uint8_t>((t.frame.extended ? 1 : 0) | (t.frame.remote ? 2 : 0));
    record.frame.length = t.frame.length;
    std::copy(t.frame.data.begin(), t.frame.data.end(), record.frame.data);
    record.sender = t.sender;
    record.busy_ns = static_cast<std::uint32_t>(t.busy_ns);
    record.tec = static_cast<std::uint32_t>(t.tec);
    record.bit = static_cast<std::uint16_t>(t.bit);
    record.error = static_cast<std::uint8_t>(t.error);
    record.losers = static_cast<std::uint8_t>(t.losers);
    happened.add(io::Kind::can_transfer, static_cast<std::uint16_t>(number), t.end_ns, record);
  });
}

void watch_empty_can(const std::function<bool(int bus)>& used, stm32::ChipModel& chip,
                     const io::FindingSink& finding) {
  constexpr int kBuses = 2;
  for (int number = 1; number <= kBuses; ++number) {
    stm32::BxCan* block = chip.can(number);
    if (block == nullptr || used(number)) continue;
    block->bus().on_transfer([number, finding, told = false](const io::CanTransfer& t) mutable {
      if (std::exchange(told, true)) return;
      finding({t.end_ns, "can" + std::to_string(number),
               "the board has no device on this bus: nobody acknowledges a frame"});
    });
  }
}

}  // namespace whirl::board
