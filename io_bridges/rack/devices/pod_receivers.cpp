#include "io_bridges/rack/devices/pod_receivers.hpp"

#include <cmath>
#include <utility>

#include "io_bridges/rack/devices/pod_faults.hpp"
#include "io_bridges/rack/devices/radio_receiver.hpp"

namespace whirl::rack {
namespace {

io::Ublox::Params gps_of(DeviceSlot& slot) {
  io::Ublox::Params params;
  params.name = slot.name() + ".gps";
  params.first_fix_ns = std::llround(slot.quantity("params.first_fix") * 1e9);
  params.seed = slot.rack().seed();
  params.bus = kPodBus;
  params.device = kPodGps;
  return params;
}

io::RadioLink::Params radio_params() {
  io::RadioLink::Params params;
  params.bus = kPodBus;
  params.device = kPodReceiver;
  return params;
}

}  // namespace

std::vector<DeviceKey> pod_receiver_keys() {
  const auto first_fix_s = static_cast<double>(io::Ublox::Params{}.first_fix_ns) * 1e-9;
  return {flag_key("params.gps", "it has a GPS").with(false),
          quantity_key("params.first_fix", Dimension::time, "s", {0.0, 3600.0},
                       "of the GPS from power-up, cold")
              .with(first_fix_s),
          flag_key("params.receiver", "it has a radio-control receiver with SBUS").with(false)};
}

PodReceivers::PodReceivers(DeviceSlot& slot, io::PodLinkReader& reader, Send send)
    : queue_(slot.rack().events()),
      send_(std::move(send)),
      place_(slot, {}),
      radio_params_(radio_params()),
      radio_(radio_params_, &slot.rack().faults()),
      glitches_(&slot.rack().faults(), kPodBus, kPodReceiver, slot.rack().seed(),
                slot.name() + ".receiver"),
      has_radio_(slot.flag("params.receiver")),
      sticks_(queue_, [this] { tell_sticks(); }) {
  if (!slot.flag("params.gps")) return;
  gps_ = std::make_unique<io::Ublox>(
      queue_, gps_of(slot), [this](const io::Ublox::Query& query) { return place_.fix(query); },
      &slot.rack().faults(), slot.rack().finding());
  said_ = std::make_unique<PodLineEnd>(
      queue_, io::PodEnd::gps, *gps_, [this] { return gps_->baud(); }, reader,
      PodLineEnd::Ears{send_}, PodLineEnd::kGather_ns);
}

void PodReceivers::start() {
  if (said_ != nullptr) said_->tell_rate();
  if (has_radio_) sticks_.in(core::receiver::kSbusPeriod_ns);
}

void PodReceivers::on_sticks(const io::Reader& message) {
  radio_.on_sticks(sticks_of(message), queue_.now());
}

void PodReceivers::tell_sticks() {
  sticks_.in(core::receiver::kSbusPeriod_ns);
  auto frame = io::sbus_frame(radio_.at(queue_.now()), radio_params_.failsafe);
  if (frame) glitches_.spoil(*frame, queue_.now());
  send_(io::pack_pod_sbus(number_++, frame.value_or(io::SbusFrame{}), !frame));
}

}  // namespace whirl::rack
