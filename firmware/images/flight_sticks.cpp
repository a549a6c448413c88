#include "firmware/images/flight_sticks.hpp"

#include "firmware/drivers/cppm_receiver.hpp"
#include "firmware/drivers/sbus_receiver.hpp"
#include "firmware/flight/receiver_choice.hpp"
#include "firmware/hal/edge_capture.hpp"
#include "firmware/hal/interrupts.hpp"
#include "firmware/hal/receiver_uart.hpp"
#include "firmware/hal/time_base.hpp"

namespace fw {
namespace {

constinit CppmReceiver cppm;
constinit SbusReceiver sbus;
volatile bool cppm_came = false, sbus_came = false;
constinit ReceiverChoice choice;

// The driver's newest frame, which its interrupt may replace at any time.
template <typename Receiver>
auto newest(const Receiver& receiver, volatile bool& came) {
  const hal::InterruptLock lock;
  came = false;
  return receiver.frame();
}

bool heard(ReceiverKind kind, const Flight& flight) {
  return choice.hears(kind, hal::now_us(), flight.state() != FlightState::disarmed);
}

}  // namespace

void receiver_edge(std::uint32_t edge_us) {
  if (cppm.edge(edge_us)) cppm_came = true;
}

void receiver_byte(std::uint8_t byte, bool error) {
  if (sbus.push(byte, hal::now_us(), error)) sbus_came = true;
}

void start_sticks() {
  hal::start_edge_capture();
  hal::start_receiver_uart();
}

void read_sticks(Flight& flight) {
  if (cppm_came) {
    const CppmFrame frame = newest(cppm, cppm_came);
    if (heard(ReceiverKind::cppm, flight)) flight.on_rc(frame.channels());
  }
  if (sbus_came) {
    const SbusFrame frame = newest(sbus, sbus_came);
    if (frame.is_news() && heard(ReceiverKind::sbus, flight)) flight.on_rc(frame.pulses_us());
  }
}

}  // namespace fw
