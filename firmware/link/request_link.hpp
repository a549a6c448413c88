// What a ground station asks of a vehicle beside flying it and beside parameters: who it is, whether it has
// a mission, what time it has, whether it is there.
//
//   Source  mavlink.io/en/services/{command,mission,ping,timesync}.html; what QGroundControl asks when it
//           has heard a first HEARTBEAT
//   Answers AUTOPILOT_VERSION: to commands 512 (of message 148) and 520. MISSION_COUNT: 0, of each kind of
//           mission. A mission is refused by MISSION_ACK, to clear the empty one is accepted. TIMESYNC,
//           PING: sent back. COMMAND_INT: COMMAND_ACK "unsupported". Others not at all: REQUEST_DATA_STREAM
//           has no answer, and the radio's slots fix the rates
//   Late    of each kind the newest waits for its slot; a station asks again
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "firmware/link/mavlink.hpp"

namespace fw {

class RequestLink {
 public:
  // Frames of other messages, or for others, are passed over.
  void on_frame(const mavlink::Frame& frame);
  void on_version_wanted() { due_[kVersion] = true; }
  // The newest COMMAND_INT that was not answered yet: its command.
  std::optional<std::uint16_t> take_command_int();

  bool due() const;
  mavlink::Message next(std::uint32_t time_ms);  // pre: due()

 private:
  enum Answer : std::uint8_t { kVersion, kMissionCount, kMissionAck, kTimesync, kPing, kAnswers };

  void on_mission(const mavlink::Frame& frame);
  void on_timesync(const mavlink::Frame& frame);
  void on_ping(const mavlink::Frame& frame);
  mavlink::Message version() const;
  mavlink::Message mission_count() const;
  mavlink::Message mission_ack() const;
  mavlink::Message timesync(std::uint32_t time_ms) const;
  mavlink::Message ping() const;

  std::array<bool, kAnswers> due_{};
  struct {
    std::uint8_t system = 0, component = 0, kind = 0, result = 0;
  } mission_;  // of the last request
  std::int64_t timesync_ts1_ns_ = 0;
  struct {
    std::uint64_t time_us = 0;
    std::uint32_t sequence = 0;
    std::uint8_t system = 0, component = 0;
  } ping_;
  std::optional<std::uint16_t> command_int_;
};

}  // namespace fw
