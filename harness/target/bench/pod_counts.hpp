// What a pod counts of samples that never came or came late, and of what it could not do, from the first second of a run
// to its end.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/rack/far_rack.hpp"

namespace whirl::bench {

class PodCounts {
 public:
  // Its host is on that rack, which has to live as long.
  explicit PodCounts(rack::FarRack& rack) : rack_(rack) {}

  // An order is for the pod's host: all are but lines of text, which are the flight controller's; those for its radio it may play.
  static bool is_for_host(const io::Reader& order) {
    return order.header().kind != io::Kind::uart_frame || order.header().port == kPodRadioPort;
  }
  // An answer of the host's; it is kept here.
  bool hears(const io::Reader& told);
  // With each turn: asks once the first second is over.
  void turn();
  void finish();                              // asks for the last time
  std::vector<std::string> findings() const;  // what has been counted; pre: finish()

 private:
  void ask();
  void ask(const std::string& name);

  rack::FarRack& rack_;
  bool began_ = false;
  std::map<std::string, long> first_, last_;
};

}  // namespace whirl::bench
