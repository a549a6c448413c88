#include "firmware/images/flight_escs.hpp"

#include <tuple>

#include "firmware/drivers/esc_bus.hpp"
#include "firmware/flight/schedule.hpp"
#include "firmware/hal/i2c_master.hpp"
#include "firmware/images/flight_can.hpp"

namespace fw {
namespace {

constinit EscBus<hal::I2cMaster<hal::EscI2c>> escs(hal::i2c3);

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

}  // namespace

void esc_job_done(const hal::I2cJob& job, Status status) {
  escs.job_done(job, status);
}

bool serve_escs(Flight& flight, Faults& faults, std::uint32_t tick) {
  faults.i2c_recoveries = hal::i2c3.counters().recoveries;
  faults.i2c_timeouts = hal::i2c3.counters().timeouts;
  if (!flight.parameters().is_on(Parameter::esc_bus) || !start_can(flight)) {
    return serve(escs, flight, faults, tick);
  }
  return serve(can_escs(), flight, faults, tick);
}

}  // namespace fw
