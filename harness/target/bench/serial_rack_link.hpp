// Parts of a board's that the bench plays at the other end of a serial line of this host (rack_link.hpp): what they send
// waits here until it is written.
#pragma once
#include <string>
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/rack_link.hpp"
#include "io_bridges/rack/line_rack.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

struct LinePlace {
  std::string name, path;  // of the link
  std::string end;         // who is at the other end here: "a pod's host"
};

// One part of a board's on the line of its own UART (io_bridges/board_description/line_part.hpp).
struct LinePartOptions {
  SerialLink link;
  BoardDescription board;  // of it, the part on that UART
  rack::DeviceTypes types;
  std::uint64_t seed = 1;
};
using LinePart = bool (*)(const BoardDevice&);  // which kind: is_gps

// The part of that kind that a link of a bench is to play; null: the line is of something else.
const BoardDevice* part_at(const BoardDescription& board, const SerialLink& link, LinePart kind);

class SerialRackLink : public RackLink {
 public:
  std::string name() const override { return place_.name; }
  int file() const override { return tty_ ? tty_->file() : -1; }
  void make_safe() override;
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;

 protected:
  // format: of the microcontroller's bytes; carries: which devices of a board are at that line.
  SerialRackLink(LinePlace place, const io::UartFormat& format, std::uint64_t seed,
                 rack::LineRack::Choice carries, const std::optional<PodPlaces>& pod);

  // The same for one part.
  SerialRackLink(const LinePartOptions& options, std::string end, const io::UartFormat& format,
                 LinePart kind);

  Result<Done> open_line(io::TtyFrame frame, double baud);
  // What has come is the microcontroller's.
  Result<Done> take_in(std::int64_t now_host_ns) override;
  // What a device sends, with its last stop bit. None comes once the link is safe.
  virtual void hear(std::uint8_t byte, double /*baud*/) { waiting_.push_back(byte); }

  rack::LineRack rack_;
  std::optional<io::Tty> tty_;
  std::vector<std::uint8_t> waiting_;

 private:
  LinePlace place_;
  bool safe_ = false;
};

}  // namespace whirl::bench
