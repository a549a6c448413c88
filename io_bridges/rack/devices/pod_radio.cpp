#include "io_bridges/rack/devices/pod_radio.hpp"

#include "io_bridges/board_description/pod_host.hpp"
#include "io_bridges/rack/devices/mavlink_keys.hpp"

namespace whirl::rack {
namespace {

constexpr double kRadioBaud = io::MavlinkLink::Params{}.baud;

}  // namespace

std::vector<DeviceKey> pod_radio_keys() {
  std::vector<DeviceKey> keys = air_keys();
  keys.push_back(flag_key("params.radio", "it has a telemetry radio").with(false));
  return keys;
}

PodRadio::PodRadio(DeviceSlot& slot, io::PodLinkReader& reader, Send send) {
  if (!slot.flag("params.radio")) return;
  io::EventQueue& queue = slot.rack().events();
  link_ =
      std::make_unique<io::MavlinkLink>(queue, radio_of(slot, kRadioBaud), slot.rack().finding());
  tell_frames(*link_, slot.rack().happened(), kPodRadioPort);
  said_ = std::make_unique<PodLineEnd>(
      queue, io::PodEnd::radio, *link_, [] { return kRadioBaud; }, reader,
      PodLineEnd::Ears{std::move(send)}, PodLineEnd::kGather_ns);
}

void PodRadio::start() {
  if (said_ != nullptr) said_->tell_rate();
}

void PodRadio::on_message(const io::Reader& message) {
  if (link_ != nullptr) link_->send_frame(message.payload(), message.header().t_ns);
}

}  // namespace whirl::rack
