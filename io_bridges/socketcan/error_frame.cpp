#include "io_bridges/socketcan/error_frame.hpp"

#include <linux/can.h>
#include <linux/can/error.h>

// Since Linux 6.1; older kernels leave the bytes zero.
#ifndef CAN_ERR_CNT
#define CAN_ERR_CNT 0x00000200U
#endif

namespace whirl::io {

CanTrouble parse_error_frame(std::uint32_t id, const std::array<std::uint8_t, 8>& data) {
  const auto has = [&](std::uint32_t bit) { return (id & bit) != 0; };
  CanTrouble t;
  t.transmit_time_out = has(CAN_ERR_TX_TIMEOUT);
  t.lost_arbitration = has(CAN_ERR_LOSTARB);
  t.protocol = has(CAN_ERR_PROT);
  t.transceiver = has(CAN_ERR_TRX);
  t.no_acknowledge = has(CAN_ERR_ACK);
  t.bus_error = has(CAN_ERR_BUSERROR);
  t.restarted = has(CAN_ERR_RESTARTED);
  t.bus_off = has(CAN_ERR_BUSOFF);
  if (has(CAN_ERR_CRTL)) {
    const std::uint8_t what = data[1];
    t.receive_overflow = (what & CAN_ERR_CRTL_RX_OVERFLOW) != 0;
    t.transmit_overflow = (what & CAN_ERR_CRTL_TX_OVERFLOW) != 0;
    if ((what & CAN_ERR_CRTL_ACTIVE) != 0) t.state = CanBusState::active;
    if ((what & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
      t.state = CanBusState::warning;
    }
    if ((what & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
      t.state = CanBusState::passive;
    }
  }
  if (t.bus_off) t.state = CanBusState::bus_off;
  if (t.restarted) t.state = CanBusState::active;
  if (has(CAN_ERR_CNT) || ((data[6] | data[7]) != 0 && has(CAN_ERR_CRTL | CAN_ERR_BUSERROR))) {
    t.transmit_errors = data[6];
    t.receive_errors = data[7];
  }
  return t;
}

std::string text_of(const CanTrouble& t) {
  std::string text;
  const auto add = [&](bool is_so, const std::string& what) {
    if (is_so) text += (text.empty() ? "" : ", ") + what;
  };
  add(t.no_acknowledge, "nobody acknowledges");
  add(t.lost_arbitration, "lost an arbitration");
  add(t.protocol || t.bus_error, "an error on the bus");
  add(t.receive_overflow, "the controller lost frames that it had received");
  add(t.transmit_overflow, "the controller lost frames to send");
  add(t.transmit_time_out, "the controller does not get a frame out");
  add(t.transceiver, "the transceiver sees a fault of the wires");
  add(t.restarted, "restarted after bus-off");
  add(t.state.has_value(), t.state ? name(*t.state) : "");
  add(t.transmit_errors.has_value(),
      std::to_string(t.transmit_errors.value_or(0)) + " transmit errors");
  add(t.receive_errors.has_value(),
      std::to_string(t.receive_errors.value_or(0)) + " receive errors");
  return text.empty() ? "an error frame that says nothing" : text;
}

}  // namespace whirl::io
