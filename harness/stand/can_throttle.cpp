#include "harness/stand/can_throttle.hpp"

#include <algorithm>

#include "io_bridges/messages/can_message.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"

namespace whirl::stand {
namespace {

using namespace io::dronecan;

constexpr std::int64_t kMs = 1'000'000, kBoot_ns = 100 * kMs;
constexpr std::uint8_t kNode = 10, kPriority = 5;
constexpr int kRawSteps = 4;

const DataType* known(Kind kind, std::uint16_t id) {
  if (kind != Kind::message) return nullptr;
  for (const DataType* type : {&EscStatus::kType, &EscStatusExtended::kType}) {
    if (type->id == id) return type;
  }
  return nullptr;
}

}  // namespace

CanThrottle::CanThrottle(std::uint16_t motor, std::uint16_t bus, bool by_speed)
    : motor_(motor), bus_(bus), by_speed_(by_speed), assembler_(known, kNode) {}

std::vector<io::CanFrame> CanThrottle::command() {
  if (!by_speed_) {
    return command_of(&RawCommand::commands, static_cast<std::int16_t>(kRawSteps * v_));
  }
  const double speed_rpm = v_ == 0 ? 0.0 : io::value_of_setpoint(io::EscMode::rpm, v_);
  return command_of(&RpmCommand::speeds_rpm, static_cast<std::int32_t>(std::lround(speed_rpm)));
}

// `own` at the motor's place, 0 at all others.
template <typename Command, typename List, typename Count>
std::vector<io::CanFrame> CanThrottle::command_of(List Command::*counts, Count own) {
  Command message;
  for (std::uint16_t motor = 1; motor <= std::max<std::uint16_t>(motor_, 4); ++motor) {
    (message.*counts).add(motor == motor_ ? own : Count{0});
  }
  const Payload payload = encode(message);
  const Header header{Kind::message, Command::kType.id, kPriority, kNode, 0, transfer_id_};
  transfer_id_ = (transfer_id_ + 1) & tail::kTransfer_id;
  return frames_of(header, Command::kType.signature, payload.bytes());
}

void CanThrottle::send(std::int64_t t_ns, io::Batch& sensed) {
  if (t_ns < kBoot_ns || silent_) return;
  for (std::int64_t at = (t_ns + every_ns_ - 1) / every_ns_ * every_ns_; at < t_ns + kMs;
       at += every_ns_) {
    if (changed_) awaited_id_ = transfer_id_;
    awaited_ = awaited_ || changed_;
    changed_ = false;
    for (const io::CanFrame& frame : command()) {
      sensed.add(io::Kind::can_order, bus_, at, io::to_message(frame));
    }
  }
}

void CanThrottle::on_message(const io::Reader& message) {
  if (message.header().port != bus_) return;
  const auto record = message.as<io::CanRecord>();
  const io::CanFrame frame = io::frame_of(record.frame);
  const bool ours = record.sender >= 0;
  if (ours && record.error != 0) ++reported_.refused;
  if (record.error != 0 || frame.length == 0) return;
  if (!ours) {
    if (const Transfer* t = assembler_.take(frame, message.header().t_ns)) on_status(*t);
    return;
  }
  ++reported_.replies;
  const std::uint8_t last = frame.data[frame.length - 1u];
  const bool whole = (last & tail::kEnd) != 0;
  if (!awaited_ || !whole || (last & tail::kTransfer_id) != awaited_id_) return;
  awaited_ = false;
  on_wire_ns_ = message.header().t_ns;
}

void CanThrottle::on_status(const Transfer& transfer) {
  if (transfer.header.type_id == EscStatus::kType.id) {
    const auto status = decode<EscStatus>(transfer.payload);
    if (!status || status->index != motor_ - 1) return;
    reported_.current_A = static_cast<double>(status->current_A);
    reported_.speed_rpm = status->speed_rpm;
  } else if (const auto extended = decode<EscStatusExtended>(transfer.payload)) {
    if (extended->index == motor_ - 1) reported_.flags = extended->flags;
  }
}

}  // namespace whirl::stand
