// What the pilot asks for, from the frames of a radio-control receiver.
//
//   Channels  1 roll, 2 pitch, 3 throttle, 4 yaw (order "AETR"), 5 mode switch of three positions:
//             manual attitude, manual velocity, autonomous; 6 arm switch
//   Ranges    1000..2000 us, middle 1500; full travel counts from 20 us before its end on, a dead
//             zone of 20 us about the middle. Receivers and decoders agree on these ends [PX4 v1.0.0
//             RCn_MIN, RCn_MAX, RCn_DZ]; a transmitter's own are not learned
//   Not ok    fewer than six channels; one of them beyond 900..2100 us; throttle below 950 us, where
//             receivers put it that lost their transmitter. Such a frame counts as none
//   Lost      0.5 s without a frame that is ok
//   One bad   frame moves nothing: sticks are the median of three frames, and nothing counts unless the
//             three agree on where the switches are
//   Nonsense  0.5 s of frames that are not ok, or of which no three agree: neither signal has a checksum,
//             and what any bits mean is ok two times in three
#pragma once
#include <array>
#include <cstdint>
#include <span>

namespace fw {

enum class PilotMode : std::uint8_t { attitude, velocity, autonomous };

struct PilotDemand {
  float roll = 0.0f, pitch = 0.0f,
        yaw = 0.0f;       // shares of travel: right, nose up, nose right are +
  float throttle = 0.0f;  // 0..1 from the lower stop
  bool arm = false;
  PilotMode mode = PilotMode::autonomous;

  bool throttle_low() const { return throttle < 0.05f; }
};

enum class PilotLink : std::uint8_t { never_heard, ok, lost, nonsense };

class Pilot {
 public:
  void tick() {  // once a millisecond
    quiet_ms_ += quiet_ms_ < kLost_ms ? 1 : 0;
    in_doubt_ms_ += in_doubt_ms_ < kLost_ms ? 1 : 0;
  }
  void on_frame(std::span<const std::uint16_t> channels_us);

  // nonsense: frames still come, but say nothing.
  PilotLink link() const;
  const PilotDemand& demand() const { return demand_; }  // after a loss: the last
  std::uint32_t frames_refused() const { return refused_; }

 private:
  static constexpr std::uint32_t kLost_ms = 500;
  static constexpr unsigned kChannels = 6, kFrames = 3;
  enum Channel : std::uint8_t { kRoll, kPitch, kThrottle, kYaw, kMode, kArm };

  std::uint16_t median_us(Channel channel) const;
  // The switch's position, 0 to 2, when all frames agree on it; else -1.
  int position(Channel channel) const;

  std::array<std::array<std::uint16_t, kChannels>, kFrames> last_us_{};
  unsigned held_ = 0, next_ = 0;
  std::uint32_t quiet_ms_ = kLost_ms, refused_ = 0;  // since a frame that was ok
  std::uint32_t in_doubt_ms_ = kLost_ms;             // since three agreed
  bool heard_ = false, last_refused_ = false;
  PilotDemand demand_;
};

}  // namespace fw
