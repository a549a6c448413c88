#include "io_bridges/rack/can_log.hpp"

#include "io_bridges/messages/can_message.hpp"

namespace whirl::rack {

void log_can(io::CanBus& bus, int number, io::Batch& happened) {
  bus.on_transfer([&happened, number](const io::CanTransfer& t) {
    io::CanRecord record;
    record.start_ns = t.start_ns;
    record.frame = io::to_message(t.frame);
    record.sender = t.sender;
    record.busy_ns = static_cast<std::uint32_t>(t.busy_ns);
    record.tec = static_cast<std::uint32_t>(t.tec);
    record.bit = static_cast<std::uint16_t>(t.bit);
    record.error = static_cast<std::uint8_t>(t.error);
    record.losers = static_cast<std::uint8_t>(t.losers);
    happened.add(io::Kind::can_transfer, static_cast<std::uint16_t>(number), t.end_ns, record);
  });
}

}  // namespace whirl::rack
