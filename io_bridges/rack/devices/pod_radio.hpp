// The telemetry radio that a pod plays, behind its host, where the board file asks for it: 57600 baud, the air of a board's
// own radio (mavlink_keys.hpp). Its bytes go to the pod a millisecond's worth at a time, and come from it 44 at a time or
// after 4 ms.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "io_bridges/devices/mavlink_link.hpp"
#include "io_bridges/rack/devices/pod_line_end.hpp"

namespace whirl::rack {

std::vector<DeviceKey> pod_radio_keys();  // params.radio and those of the air

class PodRadio {
 public:
  using Send = std::function<void(std::vector<std::uint8_t> frame)>;

  // Pre: the slot's type has those keys.
  PodRadio(DeviceSlot& slot, io::PodLinkReader& reader, Send send);

  void start();                                // the pod listens
  void on_message(const io::Reader& message);  // a frame from the ground

 private:
  std::unique_ptr<io::MavlinkLink> link_;  // null: none
  std::unique_ptr<PodLineEnd> said_;
};

}  // namespace whirl::rack
