// The four ESCs as nodes on CAN: set-points out by esc.RawCommand, what they tell of themselves in.
//
//   Set-points  index 0..3 is motor 1..4; four steps of the command are one of the I2C protocol's 2047:
//               0 stops, 8188 is the top of the range of the ESC's mode
//   Status      esc.Status (current, speed), then StatusExtended, whose flags are those of the I2C
//               protocol; they come by themselves. Of whom they are says their index
//   Late        what has not gone out when the next set-point does is given up, and counted
//   Contract    as EscBus; on_frame() with each frame that came, before the take_...() of a task
#pragma once
#include <tuple>
#include <utility>

#include "firmware/dronecan/node.hpp"
#include "firmware/esc/core/protocol.hpp"

namespace fw {

template <typename Can, typename Access>
class EscCan {
 public:
  using Node = dronecan::Node<Can, Access>;
  constexpr EscCan(Can& can, Node& node) : can_(can), node_(node) {}

  // What the hardware must let through: the status messages of anybody.
  static constexpr std::array<hal::CanFilter, 2> kFilters{
      {{dronecan::message_id(0, dronecan::kEscStatus.id, 0), 0x00FF'FF80},
       {dronecan::message_id(0, dronecan::kEscStatusExtended.id, 0), 0x00FF'FF80}}};

  Status write(const std::array<std::uint16_t, 4>& setpoints) {
    if (can_.waiting() > 0) {
      can_.cancel();
      ++failures_;
    }
    std::array<std::uint8_t, 7> bytes{};
    dronecan::BitsOut out(bytes);
    for (const std::uint16_t v : setpoints) out.put(4u * v, 14);
    const Status s = node_.publish(kUrgent, dronecan::kRawCommand, transfer_, bytes);
    if (s != Status::ok) ++failures_;
    return s;
  }
  // They come unasked.
  Status request_status(unsigned /*motor*/) { return Status::ok; }

  // False: no message of an ESC.
  bool on_frame(const hal::CanFrame& frame) {
    if (dronecan::is_message(frame.id, dronecan::kEscStatus)) {
      on_status(frame);
    } else if (dronecan::is_message(frame.id, dronecan::kEscStatusExtended)) {
      on_flags(frame);
    } else {
      return false;
    }
    return true;
  }

  bool take_answered(unsigned motor) { return std::exchange(answered_[motor], false); }
  bool take_status(unsigned motor, esc::protocol::Status& out) {
    if (!fresh_[motor]) return false;
    fresh_[motor] = false;
    out = status_[motor];
    return true;
  }
  std::uint32_t failures() const { return failures_; }
  std::uint32_t bad_status() const {
    std::uint32_t sum = malformed_;
    for (const Sender& sender : senders_) sum += sender.transfer.spoiled();
    return sum;
  }

 private:
  static constexpr std::uint32_t kUrgent = 5;
  struct Sender {
    std::uint8_t source = 0;
    dronecan::Reassembly<14> transfer;
  };

  // Senders keep their place; a fifth is not heard.
  Sender* sender_of(std::uint8_t source) {
    for (Sender& sender : senders_) {
      if (sender.source != source && sender.source != 0) continue;
      sender.source = source;
      return &sender;
    }
    return nullptr;
  }
  void on_status(const hal::CanFrame& frame) {
    Sender* sender = sender_of(dronecan::source_of(frame.id));
    if (sender == nullptr || !sender->transfer.take(frame, dronecan::kEscStatus)) return;
    dronecan::BitsIn in(sender->transfer.payload());
    std::ignore = in.get(32);  // errors since its motor started
    std::ignore = in.get(16);  // volts
    const float current_mA = 1000.0f * dronecan::from_half(in.get(16));
    std::ignore = in.get(16);  // kelvin
    const std::int32_t speed_rpm = in.get_signed(18);
    std::ignore = in.get(7);
    const std::uint32_t motor = in.get(5);
    if (!in.ok() || motor >= 4 || !(current_mA > -32768.0f && current_mA < 32767.0f)) {
      ++malformed_;
      return;
    }
    answered_[motor] = true;
    status_[motor].current_mA = static_cast<std::int16_t>(current_mA);
    status_[motor].speed_rpm = static_cast<std::uint16_t>(speed_rpm < 0 ? 0 : speed_rpm);
  }
  void on_flags(const hal::CanFrame& frame) {
    if (!flags_.take(frame, dronecan::kEscStatusExtended)) return;
    dronecan::BitsIn in(flags_.payload());
    std::ignore = in.get(7 + 7);
    std::ignore = in.get(9 + 9);
    const std::uint32_t flags = in.get(19), motor = in.get(5);
    if (!in.ok() || motor >= 4) {
      ++malformed_;
      return;
    }
    answered_[motor] = true;
    status_[motor].flags = static_cast<std::uint8_t>(flags);
    fresh_[motor] = true;
  }

  Can& can_;
  Node& node_;
  std::array<Sender, 4> senders_{};
  dronecan::Reassembly<8> flags_;  // single frames
  std::array<esc::protocol::Status, 4> status_{};
  std::array<bool, 4> answered_{}, fresh_{};
  std::uint8_t transfer_ = 0;
  std::uint32_t failures_ = 0, malformed_ = 0;
};

}  // namespace fw
