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
//   One bad   frame moves nothing: sticks are the median of three frames, and nothing counts unless three
//             in a row agree that the switches are where they were, or five on where else they are
//   Nonsense  0.5 s of frames that are not ok, or that do not agree: neither signal has a checksum, and
//             what any bits mean is ok two times in three. Those agree by chance once in some 600
//             frames; of a link with one frame in ten bad seven in ten do
//   Again     after a loss or nonsense the pilot is heard once 0.5 s of doubt are gone, 0.1 s with each frame that
//             agrees: some ten good ones in a row
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
    trusted_ = trusted_ && in_doubt_ms_ < kLost_ms;
  }
  void on_frame(std::span<const std::uint16_t> channels_us);

  // nonsense: frames still come, but say nothing.
  PilotLink link() const;
  const PilotDemand& demand() const { return demand_; }  // after a loss: the last
  std::uint32_t frames_refused() const { return refused_; }

 private:
  static constexpr std::uint32_t kLost_ms = 500, kTrusted_ms = 100;
  static constexpr unsigned kChannels = 6, kFrames = 3, kAgreeing = 3, kMoved = 5;
  enum Channel : std::uint8_t { kRoll, kPitch, kThrottle, kYaw, kMode, kArm };

  std::uint16_t median_us(Channel channel) const;

  std::array<std::array<std::uint16_t, kChannels>, kFrames> last_us_{};
  unsigned held_ = 0, next_ = 0;
  int told_mode_ = -1, told_arm_ = -1;  // the switches as they count
  int mode_ = 0, arm_ = 0;              // where the last frame had the switches, 0 to 2
  unsigned agreeing_ = 0;               // frames in a row that had them there
  std::uint32_t quiet_ms_ = kLost_ms, refused_ = 0;  // since a frame that was ok
  std::uint32_t in_doubt_ms_ = kLost_ms;             // of the frames: see Nonsense
  bool heard_ = false, last_refused_ = false, trusted_ = false;
  PilotDemand demand_;
};

}  // namespace fw
