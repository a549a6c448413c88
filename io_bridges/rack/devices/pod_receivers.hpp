// The GPS and the radio-control receiver that a pod plays, behind its host; each where the board file asks for it.
//
//   GPS     a u-blox of generation 6 at 9600 baud as it is saved, in the plant's motion with the usual errors; its bytes go
//           a millisecond's worth at a time
//   Faults  of the GPS all, of the receiver rc_link_lost and rc_glitch (pod_faults.hpp)
//   Sticks  each period of an SBUS receiver what one would put out, its flags too; the pod keeps the line's time
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "io_bridges/devices/radio_link.hpp"
#include "io_bridges/devices/sbus.hpp"
#include "io_bridges/rack/devices/gnss_place.hpp"
#include "io_bridges/rack/devices/pod_line_end.hpp"

namespace whirl::rack {

std::vector<DeviceKey> pod_receiver_keys();  // params.gps, .first_fix, .receiver

class PodReceivers {
 public:
  using Send = std::function<void(std::vector<std::uint8_t> frame)>;

  // Pre: the slot's type has those keys.
  PodReceivers(DeviceSlot& slot, io::PodLinkReader& reader, Send send);

  void start();  // the pod listens
  void set(const io::BodyMotion& motion) { place_.set(motion); }
  void on_sticks(const io::Reader& message);

 private:
  void tell_sticks();

  io::EventQueue& queue_;
  Send send_;
  SensedPlace place_;
  std::unique_ptr<io::Ublox> gps_;  // null: none
  std::unique_ptr<PodLineEnd> said_;
  io::RadioLink::Params radio_params_;
  io::RadioLink radio_;
  io::SbusGlitches glitches_;
  bool has_radio_;
  std::uint8_t number_ = 0;
  io::Event sticks_;
};

}  // namespace whirl::rack
