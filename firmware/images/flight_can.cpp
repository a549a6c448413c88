#include "firmware/images/flight_can.hpp"

namespace fw {
namespace {

using Node = dronecan::Node<FlightCan, ParameterAccess>;

constinit ParameterAccess access;
constinit Node node(hal::can2, access);
constinit FlightCanEscs escs(hal::can2, node);
constinit CanSensors sensors;
constinit bool started = false;

constexpr std::uint8_t kNodeId = 10;

constexpr auto filters() {
  std::array<hal::CanFilter, CanSensors::kTypes.size() + 3> all{};
  std::size_t n = 0;
  for (const dronecan::Type& type : CanSensors::kTypes) {
    all[n++] = {dronecan::message_id(0, type.id, 0), CanSensors::kOfType};
  }
  for (const hal::CanFilter& of_escs : FlightCanEscs::kFilters) all[n++] = of_escs;
  all[n++] = Node::services_to(kNodeId);
  return all;
}

}  // namespace

FlightCanEscs& can_escs() {
  return escs;
}

CanSensors& can_sensors() {
  return sensors;
}

bool start_can(Flight& flight) {
  if (started) return true;
  static constexpr auto kFilters = filters();
  node.be({kNodeId, "org.whirlstand.flight", hal::unique_id()});
  access.join(flight.parameters());
  started = hal::can2.init(kFilters) == Status::ok;
  return started;
}

void can_tick(const Flight& flight, std::uint32_t tick, std::uint32_t now_us,
              std::uint32_t uptime_s) {
  constexpr std::size_t kMost = 24;  // a task has its budget
  constexpr std::uint32_t kPeriod_ticks = 1000;
  if (!started) return;
  access.set_armed(flight.state() != FlightState::disarmed);
  hal::CanFrame frame;
  for (std::size_t i = 0; i < kMost && hal::can2.read(frame); ++i) {
    if (!sensors.on_frame(frame, now_us) && !escs.on_frame(frame)) node.on_frame(frame);
  }
  if (tick % kPeriod_ticks != 0) return;
  node.publish_status(uptime_s,
                      flight.emergency() ? dronecan::Health::critical : dronecan::Health::ok);
}

}  // namespace fw
