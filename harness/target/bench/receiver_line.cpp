#include "harness/target/bench/receiver_line.hpp"

#include <algorithm>
#include <array>

#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/devices/core/receiver.hpp"

namespace whirl::bench {
namespace {

bool is_receiver(const BoardDevice& device, std::uint16_t uart) {
  return device.type == "sbus" && is_uart(device.bus) && bus_number(device.bus) == uart;
}

}  // namespace

const BoardDevice* receiver_at(const BoardDescription& board, const SerialLink& link) {
  const auto found =
      std::find_if(board.devices.begin(), board.devices.end(),
                   [&](const BoardDevice& device) { return is_receiver(device, link.uart); });
  return found == board.devices.end() ? nullptr : &*found;
}

ReceiverLine::ReceiverLine(ReceiverLineOptions options)
    : SerialRackLink(
          {options.link.name, options.link.path, "a receiver with SBUS"},
          {core::receiver::kSbusBaud, 8, 'E', 2.0}, options.seed,
          [uart = options.link.uart](const BoardDevice& device) {
            return is_receiver(device, uart);
          },
          std::nullopt),
      options_(std::move(options)) {}

Result<Done> ReceiverLine::open() {
  const auto built =
      build(options_.board, options_.types, "usart" + std::to_string(options_.link.uart));
  if (!built) return built;
  return open_line(io::TtyFrame::e82, core::receiver::kSbusBaud);
}

// The line is one way. What comes is dropped, and a line that was unplugged is found.
Result<Done> ReceiverLine::take_in(std::int64_t /*now_host_ns*/) {
  std::array<std::uint8_t, 256> piece;
  const auto got = tty_->read(piece);
  if (!got) return got.error();
  return Done{};
}

Result<Done> ReceiverLine::send_waiting(std::int64_t /*now_host_ns*/) {
  const std::size_t whole =
      waiting_.size() / core::receiver::kSbusBytes * core::receiver::kSbusBytes;
  if (const auto sent = tty_->write(std::span(waiting_).first(whole)); !sent) return sent;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(whole));
  return tty_->flush();
}

}  // namespace whirl::bench
