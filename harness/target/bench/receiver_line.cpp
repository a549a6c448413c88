#include "harness/target/bench/receiver_line.hpp"

#include <array>

#include "io_bridges/board_description/line_part.hpp"
#include "io_bridges/devices/core/receiver.hpp"

namespace whirl::bench {

ReceiverLine::ReceiverLine(LinePartOptions options)
    : SerialRackLink(options, "a receiver with SBUS", {core::receiver::kSbusBaud, 8, 'E', 2.0},
                     is_receiver),
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
