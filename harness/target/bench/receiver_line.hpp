// The bench as a flight controller's radio-control receiver with SBUS, on a serial line of this host (rack_link.hpp): the
// receiver of the board file, with its faults, hears the plan's sticks.
//
//   Line     100000 baud 8E2, inverted on copper: by the adapter (an FT232R can, see docs/bench.md), or by a transistor where
//            the board has no inverter before its UART
//   Frame    leaves whole when its last character is over: on copper it begins 3 ms later than a receiver's would
//   Safe     nothing goes out any more, as of a receiver without supply
#pragma once
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/rack_link.hpp"
#include "io_bridges/rack/line_rack.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

struct ReceiverLineOptions {
  SerialLink link;
  BoardDescription board;  // of it, the receiver on that UART
  rack::DeviceTypes types;
  std::uint64_t seed = 1;
};

// The receiver that a link of a bench is to play; null: the line is of something else.
const BoardDevice* receiver_at(const BoardDescription& board, const SerialLink& link);

class ReceiverLine final : public RackLink {
 public:
  explicit ReceiverLine(ReceiverLineOptions options);

  std::string name() const override { return options_.link.name; }
  Result<Done> open() override;
  int file() const override { return tty_ ? tty_->file() : -1; }
  void make_safe() override;
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;

 private:
  Result<Done> take_in(std::int64_t now_host_ns) override;
  Result<Done> send_waiting(std::int64_t now_host_ns) override;

  ReceiverLineOptions options_;
  rack::LineRack rack_;
  std::optional<io::Tty> tty_;
  std::vector<std::uint8_t> waiting_;
  bool safe_ = false;
};

}  // namespace whirl::bench
