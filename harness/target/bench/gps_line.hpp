// The bench as a flight controller's GPS on a serial line of this host (serial_rack_link.hpp): the u-blox receiver of the
// board file, with its faults, in the plant's motion. It answers settings and keeps them, its baud rate among them.
//
//   Line     8N1. The adapter is set to the receiver's rate, at first to that of the board file, whatever the bench's file says
//   Rate     a new one is set once what was sent at the old one is over, kRest_ns later: so long an adapter may hold bytes back.
//            Meanwhile it reads at the old rate what the flight controller sends, as of the new one: garbage, a few milliseconds
//            longer than the receiver itself would
//   Garbage  of two rates that differ is copper's and the adapter's own. What an adapter reads without a stop bit comes as a
//            character here, which a receiver would leave out
//   Late     a character leaves when its last bit is over: on copper it ends a character's time later than a receiver's
//   Safe     nothing goes out any more, as of a receiver without supply
#pragma once
#include <deque>
#include <vector>

#include "harness/target/bench/serial_rack_link.hpp"

namespace whirl::bench {

class GpsLine final : public SerialRackLink {
 public:
  static constexpr std::int64_t kRest_ns = 5'000'000;  // of the host

  explicit GpsLine(LinePartOptions options);

  Result<Done> open() override;
  std::int64_t next_due_host_ns() const override;
  void make_safe() override;

 private:
  struct Piece {
    double baud = 0.0;
    std::vector<std::uint8_t> bytes;
  };
  void hear(std::uint8_t byte, double baud) override;
  Result<Done> send_waiting(std::int64_t now_host_ns) override;
  double next_baud() const { return pieces_.empty() ? rack_.baud() : pieces_.front().baud; }
  bool rests(std::int64_t now_host_ns) const;
  Result<Done> set_baud(double baud);

  LinePartOptions options_;
  std::deque<Piece> pieces_;         // not yet written, each of one rate
  double baud_ = 0.0;                // of the adapter
  std::int64_t rested_host_ns_ = 0;  // what was written is over, and the adapter holds nothing
};

}  // namespace whirl::bench
