// Which devices of a rack take which messages of the harness (Intake).
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io_bridges/rack/device_type.hpp"

namespace whirl::rack {

class Takers {
 public:
  // place: of the device, for the message. Errors  bad_input: what it takes at a port another one takes already
  Result<Done> add(RackDevice& device, const std::string& place);
  // False: nobody takes it.
  bool give(const io::Reader& message) const;

 private:
  std::map<io::Kind, std::vector<RackDevice*>> of_kind_;  // whatever the port
  std::map<std::pair<io::Kind, std::uint16_t>, RackDevice*> of_port_;
};

}  // namespace whirl::rack
