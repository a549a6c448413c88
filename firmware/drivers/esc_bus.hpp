// The four ESCs on their bus: queues writes and reads, collects what came of them.
//
//   Contract  tasks call write(), request_status() and take_...() with motor = 0..3; job_done() comes from interrupts
//   Faults    a failed transaction has been tried again by the bus; here it is only counted. How long
//             an ESC may stay silent is the flight logic's business
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "firmware/drivers/i2c_queue.hpp"
#include "firmware/esc/core/protocol.hpp"
#include "firmware/status.hpp"

namespace fw {

template <I2cQueue Bus>
class EscBus {
 public:
  explicit constexpr EscBus(Bus& bus) : bus_(bus) {}

  Status write(const std::array<std::uint16_t, 4>& setpoints) {
    Status worst = Status::ok;
    for (unsigned motor = 0; motor < 4; ++motor) {
      const std::uint8_t address = esc::protocol::address_of(motor + 1);
      const esc::protocol::SetpointBytes bytes =
          esc::protocol::encode_setpoint(address, setpoints[motor]);
      hal::I2cJob job{.address = address, .read = false, .length = 3};
      std::copy(bytes.begin(), bytes.end(), job.bytes.begin());
      if (const Status s = bus_.submit(job); s != Status::ok) worst = s;
    }
    return worst;
  }

  Status request_status(unsigned motor) {
    return bus_.submit(
        {.address = esc::protocol::address_of(motor + 1), .read = true, .length = 6});
  }

  // True: the ESC has acknowledged something since the last call.
  bool take_answered(unsigned motor) {
    const bool answered = answered_[motor];
    answered_[motor] = false;
    return answered;
  }
  // True: a new status. Reads are far apart: it does not change while a task copies it.
  bool take_status(unsigned motor, esc::protocol::Status& out) {
    if (!fresh_[motor]) return false;
    fresh_[motor] = false;
    out = status_[motor];
    return true;
  }
  std::uint32_t failures() const { return failures_; }
  std::uint32_t bad_status() const { return bad_status_; }

  void job_done(const hal::I2cJob& job, Status status) {
    const unsigned motor = job.address - esc::protocol::address_of(1);
    if (motor >= 4) return;
    if (status != Status::ok) {
      failures_ = failures_ + 1;
      return;
    }
    answered_[motor] = true;
    if (!job.read) return;
    const std::span<const std::uint8_t, 6> bytes(job.bytes.data(), 6);
    if (!esc::protocol::decode_status(job.address, bytes, status_[motor])) {
      bad_status_ = bad_status_ + 1;
      return;
    }
    fresh_[motor] = true;
  }

 private:
  Bus& bus_;
  std::array<esc::protocol::Status, 4> status_{};
  volatile bool answered_[4] = {}, fresh_[4] = {};
  volatile std::uint32_t failures_ = 0, bad_status_ = 0;
};

}  // namespace fw
