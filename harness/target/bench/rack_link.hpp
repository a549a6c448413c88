// The bench as what hangs on one wire of a board: parts that a board file names are played to a microcontroller that is
// of metal, by the code that plays them on a virtual board (io_bridges/rack/far_rack.hpp).
//
//   World    body_motion, esc_state and their like go to the parts with the step; esc_setpoint comes back
//   Times    parts live in virtual time, as far as the host's clock has come, and never beyond the step at hand: a
//            host that is late makes them late. What they send leaves within 50 us of the host of when it is due
//   Safe     nothing turns here: the parts fall silent
//   Pod      the parts are behind a pod: what it counts of samples lost and late is told when the run is over. Faults name
//            a part as the flight controller's board has it, and are given to the one that plays it
//   Errors   bad_input: the board has no part at that wire; host: the adapter is gone
#pragma once
#include <map>
#include <optional>
#include <utility>

#include "harness/target/bench/link.hpp"
#include "harness/target/bench/pod_counts.hpp"
#include "io_bridges/rack/far_rack.hpp"

namespace whirl::bench {

// By bus and address of a part on the flight controller's board: those of the one behind the pod's host.
using PodPlaces = std::map<std::pair<int, int>, std::pair<int, int>>;

class RackLink : public Link {
 public:
  void keep_time(BenchTime time) override { time_ = std::move(time); }
  // Never only its own: others on other wires hear of the same world.
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  std::int64_t next_due_host_ns() const override;
  void finish(const VirtualTime& virtual_ns, std::int64_t end_ns, io::Batch& happened) override;

 protected:
  // The rack has to live as long, and may be made later.
  RackLink(rack::FarRack& rack, const std::optional<PodPlaces>& pod);

  // wire: as messages name it.
  Result<Done> build(const BoardDescription& board, const rack::DeviceTypes& types,
                     const std::string& wire);
  void advance(std::int64_t host_ns);  // the parts, to that time of the host
  std::int64_t virtual_ns(std::int64_t host_ns) const { return time_.virtual_ns(host_ns); }
  void add_pod_findings(std::vector<std::string>& findings) const;

 private:
  virtual Result<Done> take_in(std::int64_t now_host_ns) = 0;
  virtual Result<Done> send_waiting(std::int64_t now_host_ns) = 0;
  void hand_over(Arrivals& arrivals);

  void give_fault(const io::Reader& order);

  rack::FarRack& rack_;
  std::optional<PodCounts> pod_;
  PodPlaces places_;
  BenchTime time_;
  std::int64_t served_host_ns_ = 0;
};

}  // namespace whirl::bench
