#include "io_bridges/rack/devices/radio_receiver.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::rack {
namespace {

Nanoseconds link_time_ns(const DeviceSlot& slot, const char* path) {
  return std::llround(slot.quantity(path) * 1e9);
}

}  // namespace

void add_link_keys(std::vector<DeviceKey>& keys) {
  const io::RadioLink::Params usual;
  const auto time = [](const char* path, Nanoseconds usual_ns, const char* about) {
    return quantity_key(path, Dimension::time, "ms", {0.0, 60.0}, about)
        .with(static_cast<double>(usual_ns) * 1e-9);
  };
  keys.push_back(time("params.latency", usual.latency_ns, "of the radio"));
  keys.push_back(time("params.lost_after", usual.lost_after_ns, "without news: frames are lost"));
  keys.push_back(time("params.failsafe_after", usual.failsafe_after_ns, "without news: failsafe"));
  keys.push_back(word_key("params.failsafe", "stop or hold or fixed", "what it puts out then")
                     .with(std::string("hold")));
  keys.push_back(quantity_key("params.failsafe_thrust", Dimension::ratio, "%", {-1.5, 1.5},
                              "channel 3 of the fixed positions, of its travel from the middle")
                     .with(usual.failsafe_thrust));
}

io::RadioLink::Params link_of(const DeviceSlot& slot) {
  io::RadioLink::Params link;
  link.latency_ns = link_time_ns(slot, "params.latency");
  link.lost_after_ns = link_time_ns(slot, "params.lost_after");
  link.failsafe_after_ns = link_time_ns(slot, "params.failsafe_after");
  const std::string style = slot.text("params.failsafe");
  link.failsafe = style == "stop"   ? io::Failsafe::stop
                  : style == "hold" ? io::Failsafe::hold
                                    : io::Failsafe::fixed;
  link.failsafe_thrust = slot.quantity("params.failsafe_thrust");
  link.bus = slot.bus_number() == 0 ? io::kAnywhere : slot.bus_number();  // a pin has no number
  link.device = slot.number();
  return link;
}

io::StickPositions sticks_of(const io::Reader& message) {
  const auto channels = message.as<io::RcChannels>();
  io::StickPositions sticks{};
  static_assert(std::tuple_size_v<io::StickPositions> == io::kRcChannels);
  std::copy(std::begin(channels.position), std::end(channels.position), sticks.begin());
  return sticks;
}

}  // namespace whirl::rack
