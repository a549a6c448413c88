#include "firmware/flight/pilot.hpp"

#include <algorithm>
#include <cmath>

namespace fw {
namespace {

constexpr std::uint16_t kSensibleLow_us = 900, kSensibleHigh_us = 2100, kFailsafeThrottle_us = 950;
constexpr float kMiddle_us = 1500.0f, kDeadZone_us = 20.0f, kFull_us = 480.0f;
constexpr std::uint16_t kSwitchLow_us = 1300, kSwitchHigh_us = 1700;

float share_of_travel(std::uint16_t us) {
  const float off_us = static_cast<float>(us) - kMiddle_us;
  const float moved_us = std::max(std::abs(off_us) - kDeadZone_us, 0.0f);
  return std::copysign(std::min(moved_us / (kFull_us - kDeadZone_us), 1.0f), off_us);
}

float share_from_stop(std::uint16_t us) {
  const float off_us = static_cast<float>(us) - (kMiddle_us - kFull_us);
  return std::clamp(off_us / (2.0f * kFull_us), 0.0f, 1.0f);
}

int position_of(std::uint16_t us) {
  return us < kSwitchLow_us ? 0 : us > kSwitchHigh_us ? 2 : 1;
}

}  // namespace

PilotLink Pilot::link() const {
  const bool frames_come = held_ == kFrames && quiet_ms_ < kLost_ms;
  if (frames_come && trusted_) return PilotLink::ok;
  if (last_refused_ || (frames_come && heard_)) return PilotLink::nonsense;
  return heard_ ? PilotLink::lost : PilotLink::never_heard;
}

std::uint16_t Pilot::median_us(Channel channel) const {
  const std::uint16_t a = last_us_[0][channel], b = last_us_[1][channel], c = last_us_[2][channel];
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

void Pilot::on_frame(std::span<const std::uint16_t> channels_us) {
  bool good = channels_us.size() >= kChannels && channels_us[kThrottle] >= kFailsafeThrottle_us;
  for (unsigned i = 0; good && i < kChannels; ++i) {
    good = channels_us[i] >= kSensibleLow_us && channels_us[i] <= kSensibleHigh_us;
  }
  last_refused_ = !good;
  if (!good) {
    ++refused_;
    agreeing_ = 0;
    return;
  }
  if (quiet_ms_ >= kLost_ms) held_ = agreeing_ = 0;  // what was before a gap says nothing of now
  std::copy_n(channels_us.begin(), kChannels, last_us_[next_].begin());
  next_ = (next_ + 1) % kFrames;
  held_ = std::min(held_ + 1, kFrames);
  quiet_ms_ = 0;
  const int mode = position_of(channels_us[kMode]), arm = position_of(channels_us[kArm]);
  agreeing_ = mode == mode_ && arm == arm_ ? std::min(agreeing_ + 1, kMoved) : 1;
  mode_ = mode;
  arm_ = arm;
  const bool moved = mode != told_mode_ || arm != told_arm_;
  if (agreeing_ < (moved ? kMoved : kAgreeing)) return;
  in_doubt_ms_ -= std::min(in_doubt_ms_, kTrusted_ms);
  trusted_ = trusted_ || in_doubt_ms_ == 0;
  if (!trusted_) return;
  told_mode_ = mode;
  told_arm_ = arm;
  heard_ = true;
  demand_.roll = share_of_travel(median_us(kRoll));
  demand_.pitch = share_of_travel(median_us(kPitch));
  demand_.yaw = share_of_travel(median_us(kYaw));
  demand_.throttle = share_from_stop(median_us(kThrottle));
  demand_.mode = static_cast<PilotMode>(mode);
  if (arm != 1) demand_.arm = arm == 2;  // in its middle the switch says nothing
}

}  // namespace fw
