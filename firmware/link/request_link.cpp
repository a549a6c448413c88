#include "firmware/link/request_link.hpp"

#include <algorithm>

namespace fw {
namespace {

using mavlink::for_us, mavlink::Frame, mavlink::Message;

enum MissionResult : std::uint8_t { kAccepted = 0, kUnsupported = 3 };  // MAV_MISSION_RESULT

}  // namespace

void RequestLink::on_frame(const Frame& frame) {
  switch (frame.id) {
    case mavlink::kMissionRequestList:
    case mavlink::kMissionCount:
    case mavlink::kMissionClearAll:
      return on_mission(frame);
    case mavlink::kTimesync:
      return on_timesync(frame);
    case mavlink::kPing:
      return on_ping(frame);
    case mavlink::kCommandInt:
      if (for_us(frame, 30)) command_int_ = frame.get<std::uint16_t>(28);
      return;
    default:
      return;
  }
}

void RequestLink::on_mission(const Frame& frame) {
  const bool count = frame.id == mavlink::kMissionCount;
  if (!for_us(frame, count ? 2 : 0)) return;
  mission_.system = frame.system;
  mission_.component = frame.component;
  mission_.kind = frame.get<std::uint8_t>(count ? 4 : 2);
  mission_.result = count ? kUnsupported : kAccepted;
  due_[frame.id == mavlink::kMissionRequestList ? kMissionCount : kMissionAck] = true;
}

// tc1 is 0 in a request and the answering side's time in an answer.
void RequestLink::on_timesync(const Frame& frame) {
  if (frame.get<std::int64_t>(0) != 0 || !for_us(frame, 16)) return;
  timesync_ts1_ns_ = frame.get<std::int64_t>(8);
  due_[kTimesync] = true;
}

// One to nobody in particular is a request; one to us answers a ping of ours, and we send none.
void RequestLink::on_ping(const Frame& frame) {
  if (frame.get<std::uint8_t>(12) != 0 || frame.get<std::uint8_t>(13) != 0) return;
  ping_.time_us = frame.get<std::uint64_t>(0);
  ping_.sequence = frame.get<std::uint32_t>(8);
  ping_.system = frame.system;
  ping_.component = frame.component;
  due_[kPing] = true;
}

std::optional<std::uint16_t> RequestLink::take_command_int() {
  const auto command = command_int_;
  command_int_.reset();
  return command;
}

bool RequestLink::due() const {
  return std::find(due_.begin(), due_.end(), true) != due_.end();
}

Message RequestLink::next(std::uint32_t time_ms) {
  const auto first = std::find(due_.begin(), due_.end(), true);
  *first = false;
  switch (static_cast<Answer>(first - due_.begin())) {
    case kMissionCount:
      return mission_count();
    case kMissionAck:
      return mission_ack();
    case kTimesync:
      return timesync(time_ms);
    case kPing:
      return ping();
    case kVersion:
    case kAnswers:
      break;
  }
  return version();
}

// A parameter's whole number is told as a float of that value.
Message RequestLink::version() const {
  constexpr std::uint64_t kSetPositionLocal = 128, kMavlink2 = 8192, kParametersCast = 131072;
  constexpr std::uint32_t kSoftware = 1u << 16;  // 0.1.0, a development build
  Message m(mavlink::kAutopilotVersion, 60);
  return m.put(0, kSetPositionLocal | kMavlink2 | kParametersCast).put(16, kSoftware);
}

Message RequestLink::mission_count() const {
  Message m(mavlink::kMissionCount, 5);
  m.put<std::uint16_t>(0, 0).put(2, mission_.system).put(3, mission_.component);
  return m.put(4, mission_.kind);
}

Message RequestLink::mission_ack() const {
  Message m(mavlink::kMissionAck, 4);
  m.put(0, mission_.system).put(1, mission_.component).put(2, mission_.result);
  return m.put(3, mission_.kind);
}

Message RequestLink::timesync(std::uint32_t time_ms) const {
  Message m(mavlink::kTimesync, 16);
  return m.put(0, std::int64_t{time_ms} * 1'000'000).put(8, timesync_ts1_ns_);
}

Message RequestLink::ping() const {
  Message m(mavlink::kPing, 14);
  m.put(0, ping_.time_us).put(8, ping_.sequence).put(12, ping_.system);
  return m.put(13, ping_.component);
}

}  // namespace fw
