// The bench as the host of a pod on a serial line of this host (rack_link.hpp): the parts that the pod plays to a flight
// controller live here, in the plant's motion.
//
//   Line     3 Mbaud (io_bridges/protocols/dronecan/pod_link.hpp). What a USB adapter gathers to packets of a millisecond
//            the pod sees as samples that come late, and counts
#pragma once
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/rack_link.hpp"
#include "io_bridges/rack/line_rack.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

struct PodLineOptions {
  PodLink link;            // its path
  BoardDescription board;  // the pod's; of it, the host on its line
  rack::DeviceTypes types;
  std::uint64_t seed = 1;  // of that board
  PodPlaces places = {};
};

class PodLine final : public RackLink {
 public:
  explicit PodLine(PodLineOptions options);

  std::string name() const override { return options_.link.name; }
  Result<Done> open() override;
  int file() const override { return tty_ ? tty_->file() : -1; }
  void make_safe() override;
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;
  std::vector<std::string> findings() const override;

 private:
  Result<Done> take_in(std::int64_t now_host_ns) override;
  Result<Done> send_waiting(std::int64_t now_host_ns) override;

  PodLineOptions options_;
  rack::LineRack rack_;
  std::optional<io::Tty> tty_;
  std::vector<std::uint8_t> waiting_;
  bool safe_ = false;
};

}  // namespace whirl::bench
