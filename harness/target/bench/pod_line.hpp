// The bench as the host of a pod on a serial line of this host (serial_rack_link.hpp): the parts that the pod plays to a
// flight controller live here, in the plant's motion.
//
//   Line     3 Mbaud (io_bridges/protocols/dronecan/pod_link.hpp). What a USB adapter gathers to packets of a millisecond
//            the pod sees as samples that come late, and counts
#pragma once
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/serial_rack_link.hpp"

namespace whirl::bench {

struct PodLineOptions {
  PodLink link;            // its path
  BoardDescription board;  // the pod's; of it, the host on its line
  rack::DeviceTypes types;
  std::uint64_t seed = 1;  // of that board
  PodPlaces places = {};
};

class PodLine final : public SerialRackLink {
 public:
  explicit PodLine(PodLineOptions options);

  Result<Done> open() override;
  std::vector<std::string> findings() const override;

 private:
  Result<Done> send_waiting(std::int64_t now_host_ns) override;

  PodLineOptions options_;
};

}  // namespace whirl::bench
