#include "firmware/images/flight_escs.hpp"

#include <tuple>

#include "firmware/config/parameter_access.hpp"
#include "firmware/drivers/esc_bus.hpp"
#include "firmware/drivers/esc_can.hpp"
#include "firmware/flight/schedule.hpp"
#include "firmware/hal/can_link.hpp"
#include "firmware/hal/i2c_master.hpp"

namespace fw {
namespace {

using Can = hal::BxCan<hal::HeaderCan>;
constinit EscBus<hal::I2cMaster<hal::EscI2c>> escs(hal::i2c3);
constinit ParameterAccess access;
constinit dronecan::Node<Can, ParameterAccess> node(hal::can2, access);
constinit EscCan<Can, ParameterAccess> can_escs(hal::can2, node);

// What they told since the last time, then what is due.
template <typename Escs>
bool serve(Escs& bus, Flight& flight, Faults& faults, std::uint32_t tick) {
  for (unsigned motor = 0; motor < 4; ++motor) {
    if (bus.take_answered(motor)) flight.on_esc_answered(motor);
    esc::protocol::Status status;
    if (bus.take_status(motor, status)) flight.on_esc_status(motor, status);
  }
  const bool due = schedule::setpoints(tick);
  if (due) std::ignore = bus.write(flight.send_setpoints());
  const int motor = schedule::status_read(tick);
  if (motor >= 0) std::ignore = bus.request_status(static_cast<unsigned>(motor));
  faults.esc_no_answer = bus.failures();
  faults.esc_bad_status = bus.bad_status();
  return due;
}

// Once the parameter asks for it; the bus stays on from then.
bool start_can(Flight& flight) {
  static constinit bool started = false;
  if (started) return true;
  constexpr std::uint8_t kNodeId = 10;
  constexpr std::array<hal::CanFilter, 3> filters{
      EscCan<Can, ParameterAccess>::kFilters[0], EscCan<Can, ParameterAccess>::kFilters[1],
      dronecan::Node<Can, ParameterAccess>::services_to(kNodeId)};
  node.be({kNodeId, "org.whirlstand.flight", hal::unique_id()});
  access.join(flight.parameters());
  started = hal::can2.init(filters) == Status::ok;
  return started;
}

void can_node_tick(const Flight& flight, std::uint32_t tick, std::uint32_t uptime_s) {
  constexpr std::uint32_t kPeriod_ticks = 1000;
  access.set_armed(flight.state() != FlightState::disarmed);
  can_escs.tick();
  if (tick % kPeriod_ticks != 0) return;
  node.publish_status(uptime_s,
                      flight.emergency() ? dronecan::Health::critical : dronecan::Health::ok);
}

}  // namespace

void esc_job_done(const hal::I2cJob& job, Status status) {
  escs.job_done(job, status);
}

bool serve_escs(Flight& flight, Faults& faults, std::uint32_t tick, std::uint32_t uptime_s) {
  faults.i2c_recoveries = hal::i2c3.counters().recoveries;
  faults.i2c_timeouts = hal::i2c3.counters().timeouts;
  if (!flight.parameters().is_on(Parameter::esc_bus) || !start_can(flight)) {
    return serve(escs, flight, faults, tick);
  }
  can_node_tick(flight, tick, uptime_s);
  return serve(can_escs, flight, faults, tick);
}

}  // namespace fw
