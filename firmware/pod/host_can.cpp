#include "firmware/pod/host_can.hpp"

#include <algorithm>
#include <tuple>

#include "firmware/pod/imu.hpp"

namespace fw::pod {

struct HostCan::NoParameters {
  static constexpr std::size_t count() { return 0; }
  static std::string_view name(std::size_t) { return {}; }
  static bool is_whole(std::size_t) { return false; }
  static float value(std::size_t) { return 0.0f; }
  static float start(std::size_t) { return 0.0f; }
  static float low(std::size_t) { return 0.0f; }
  static float high(std::size_t) { return 0.0f; }
  static bool set(std::size_t, float) { return false; }
};

namespace {

namespace mpu = whirl::core::mpu;
constexpr std::uint8_t kNodeId = 20;
constexpr std::uint32_t kSilent_us = 1'000'000, kSecond_us = 1'000'000;
constexpr std::uint32_t kUrgent = 5, kUsual = 16;
constexpr std::uint32_t kOfType = 0x00FF'FF80;  // of a message's identifier

constexpr hal::CanFilter messages(const dronecan::Type& type) {
  return {dronecan::message_id(0, type.id, 0), kOfType};
}

}  // namespace

using Node = dronecan::Node<hal::BxCan<hal::HeaderCan>, HostCan::NoParameters>;

namespace {

constinit HostCan::NoParameters no_parameters;
constinit Node node(hal::can2, no_parameters);

}  // namespace

constinit HostCan host_can;

void HostCan::start() {
  static constexpr std::array<hal::CanFilter, 5> kFilters{
      messages(kPodSample), messages(kPodFrame), messages(dronecan::kImu14),
      messages(dronecan::kImu16), Node::services_to(kNodeId)};
  node.be({kNodeId, "org.whirlstand.pod", hal::unique_id()});
  std::ignore = hal::can2.init(kFilters);  // no_answer: no CAN clock, and the UART is there
}

bool HostCan::read(Frame& out, std::uint32_t now_us) {
  hal::CanFrame frame;
  while (hal::can2.read(frame)) {
    node.on_frame(frame);
    if (is_host(frame, now_us) && on_frame(frame, out)) return true;
  }
  return false;
}

bool HostCan::is_host(const hal::CanFrame& frame, std::uint32_t now_us) {
  const std::uint8_t from = dronecan::source_of(frame.id);
  if ((frame.id & 1u << 7) != 0) return false;  // a service
  if (heard_ && from != host_ && now_us - heard_us_ <= kSilent_us) return false;
  if (!heard_) status_due_us_ = now_us;
  heard_ = true;
  host_ = from;
  heard_us_ = now_us;
  return true;
}

bool HostCan::on_frame(const hal::CanFrame& frame, Frame& out) {
  using dronecan::is_message;
  const auto put = [&out](std::span<const std::uint8_t> payload, std::size_t at) {
    std::copy(payload.begin(), payload.end(),
              out.payload.begin() + static_cast<std::ptrdiff_t>(at));
    out.length = static_cast<std::uint8_t>(at + payload.size());
  };
  if (is_message(frame.id, kPodSample)) {
    if (!sample_.take(frame, kPodSample) || sample_.payload().size() != 17) return false;
    out.kind = FrameKind::sample;
    out.sequence = sample_.payload()[0];
    put(sample_.payload().subspan(1), 0);
    temperature_ = out.word(2 + 2 * 3);
    return true;
  }
  if (is_message(frame.id, kPodFrame)) {
    if (!frame_.take(frame, kPodFrame) || frame_.payload().size() < 2) return false;
    out.kind = static_cast<FrameKind>(frame_.payload()[0]);
    out.sequence = frame_.payload()[1];
    put(frame_.payload().subspan(2), 0);
    return true;
  }
  const unsigned bits = is_message(frame.id, dronecan::kImu14) ? 14 : 16;
  if (!imu_.take(frame, bits == 14 ? dronecan::kImu14 : dronecan::kImu16)) return false;
  from_imu(bits, out);
  return true;
}

// The part's registers have the accelerometer first.
void HostCan::from_imu(unsigned bits, Frame& out) {
  dronecan::BitsIn in(imu_.payload());
  std::array<std::int16_t, 7> counts{};
  counts[3] = temperature_;
  for (const std::size_t at : {4, 5, 6, 0, 1, 2}) {
    const unsigned range = imu.setting(at >= 4 ? mpu::GYRO_CONFIG : mpu::ACCEL_CONFIG) >> 3 & 3;
    counts[at] = part_counts(in.get_signed(bits) * (1 << (16 - bits)), range);
  }
  out.kind = FrameKind::sample;
  out.sequence = stamps_.number(in.get(bits == 14 ? 12 : 16), bits == 14 ? 1u << 12 : 1u << 16);
  const auto half = [&out](std::size_t at, unsigned value) {
    out.payload[at] = static_cast<std::uint8_t>(value);
    out.payload[at + 1] = static_cast<std::uint8_t>(value >> 8);
  };
  half(0, stamps_.now_us());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    half(2 + 2 * i, static_cast<std::uint16_t>(counts[i]));
  }
  out.length = 2 + 2 * counts.size();
}

bool HostCan::send(FrameWriter& frame) {
  std::array<std::uint8_t, 2 + kMostPayload> bytes{};
  const bool setpoint = frame.kind() == FrameKind::setpoint;
  std::size_t size = 0;
  if (!setpoint) bytes[size++] = static_cast<std::uint8_t>(frame.kind());
  bytes[size++] = frame.sequence();
  for (const std::uint8_t byte : frame.payload()) bytes[size++] = byte;
  const auto whole = std::span(bytes).first(size);
  const Status sent = setpoint ? node.publish(kUrgent, kPodSetpoint, setpoint_transfer_, whole)
                               : node.publish(kUsual, kPodFrame, frame_transfer_, whole);
  return sent == Status::ok;
}

void HostCan::poll(std::uint32_t now_us) {
  if (!heard_ || static_cast<std::int32_t>(now_us - status_due_us_) < 0) return;
  status_due_us_ = now_us + kSecond_us;
  node.publish_status(++uptime_s_, dronecan::Health::ok);
}

}  // namespace fw::pod

namespace fw {
void can_frame_came(const hal::CanFrame& /*frame*/) {}  // its time is that of the main loop
}  // namespace fw
