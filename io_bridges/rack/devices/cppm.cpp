// A radio-control receiver with a sum signal on a pin.
#include "io_bridges/devices/cppm.hpp"

#include <cmath>

#include "io_bridges/rack/devices/radio_receiver.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

io::CppmReceiver::Params cppm_params(DeviceSlot& slot) {
  io::CppmReceiver::Params params;
  params.name = slot.name();
  params.channels = slot.whole("params.channels");
  params.frame_ns = std::llround(slot.quantity("params.frame") * 1e9);
  params.pulse_ns = std::llround(slot.quantity("params.pulse") * 1e9);
  params.negative = slot.flag("params.negative");
  params.jitter_s = slot.quantity("params.jitter");
  params.clock_error = slot.quantity("params.clock_error");
  params.link = link_of(slot);
  params.seed = slot.rack().seed();
  return params;
}

class CppmDevice final : public RackDevice {
 public:
  explicit CppmDevice(DeviceSlot& slot)
      : receiver_(slot.rack().events(), slot.pin("bus"), cppm_params(slot), &slot.rack().faults()) {
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::rc_channels}}; }
  void on_message(const io::Reader& message) override { receiver_.on_sticks(sticks_of(message)); }

 private:
  io::CppmReceiver receiver_;
};

}  // namespace

DeviceType cppm_type() {
  const io::CppmReceiver::Params usual;
  const auto time = [](const char* path, const char* unit, Limits limits, const char* about) {
    return quantity_key(path, Dimension::time, unit, limits, about);
  };
  DeviceKey channels =
      quantity_key("params.channels", Dimension::none, "", {1.0, 16.0}, "of a frame")
          .with(static_cast<double>(usual.channels));
  channels.kind = KeyKind::whole;
  std::vector<DeviceKey> keys = {
      pin_key("bus", "the pin that it drives").need(),
      channels,
      time("params.frame", "ms", {5e-3, 0.1}, "from frame to frame")
          .with(static_cast<double>(usual.frame_ns) * 1e-9),
      time("params.pulse", "us", {20e-6, 700e-6}, "width")
          .with(static_cast<double>(usual.pulse_ns) * 1e-9),
      flag_key("params.negative", "idle high, pulses low").with(false),
      time("params.jitter", "us", {0.0, 10e-6}, "of each edge, RMS").with(usual.jitter_s),
      quantity_key("params.clock_error", Dimension::ratio, "%", {-0.05, 0.05},
                   "share by which its times are longer")
          .with(0.0)};
  add_link_keys(keys);
  return {"cppm", "radio-control receiver with a sum signal on a pin", std::move(keys),
          make_device<CppmDevice>};
}

}  // namespace whirl::rack
