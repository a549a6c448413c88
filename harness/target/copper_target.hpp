// A run whose buses and pins are told by a capture, not by the board: what a logic analyser saw, judged by the same
// plan.
//
//   Replaced  i2c_transaction, spi_transaction and data_ready of the buses that the capture sees whole, and pin_edge of
//             the pins that it has; all else is the target's own, so that the run is the same run
//   Times     of the capture are virtual time (a file that `whirl export --vcd` drew from the same plan and seed)
//   Reads     the capture whole at start()
//   Ends      before the run does: its I2C and SPI buses are unread from there on, and no window over that time is judged
#pragma once
#include <memory>
#include <set>
#include <string>

#include "harness/target/target.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/copper/bus_decoders.hpp"

namespace whirl {

struct CopperOptions {
  std::string file;
  double vcd_rate_Hz = 50e6;
  copper::BoardNames names;
};

// What a capture's channels may be called on that board.
copper::BoardNames copper_names(const BoardDescription& board);

class CopperTarget final : public Target {
 public:
  CopperTarget(CopperOptions options, std::unique_ptr<Target> target);

  Result<Done> start() override;
  void run(std::int64_t until_ns, const io::Batch& sensed) override;
  Result<TargetState> arrive(io::Batch& happened) override;
  void stop(io::Batch& happened) override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  Offers offers() const override { return target_->offers(); }
  std::string why_ended() const override { return target_->why_ended(); }
  const HeldPace* held_pace() const override { return target_->held_pace(); }

 private:
  bool is_replaced(const io::Header& header) const;
  void replace(const io::Batch& own, io::Batch& happened);
  void tell_end(io::Batch& happened);

  CopperOptions options_;
  std::unique_ptr<Target> target_;
  io::Batch seen_;  // all that was decoded
  std::unique_ptr<io::Reader> next_;
  bool more_ = false;
  std::set<std::string> buses_;  // that the capture sees whole
  std::set<std::uint16_t> pins_, ready_;
  std::int64_t until_ns_ = 0, end_ns_ = 0;  // the run's and the capture's
};

}  // namespace whirl
