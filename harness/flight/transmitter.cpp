#include "harness/flight/transmitter.hpp"

namespace whirl::flight {
namespace {

constexpr int kRoll = 0, kPitch = 1, kThrust = 2, kYaw = 3, kMode = 4, kArm = 5;
constexpr std::int64_t kPeriod_ns = 20'000'000;

double of_switch(int position) {  // 1, 2, 3: -1, 0, +1
  return position - 2.0;
}

}  // namespace

Transmitter::Transmitter(std::uint8_t board) : board_(board) {
  channels_.position[kThrust] = -1.0;
  channels_.position[kMode] = of_switch(1);
  channels_.position[kArm] = -1.0;
}

void Transmitter::set(const request::Sticks& sticks) {
  on_ = sticks.transmitter_on;
  double(&channel)[io::kRcChannels] = channels_.position;
  channel[kRoll] = sticks.roll.value_or(channel[kRoll]);
  channel[kPitch] = sticks.pitch.value_or(channel[kPitch]);
  channel[kYaw] = sticks.yaw.value_or(channel[kYaw]);
  if (sticks.thrust) channel[kThrust] = 2.0 * *sticks.thrust - 1.0;
  if (sticks.mode) channel[kMode] = of_switch(*sticks.mode);
  if (sticks.arm) channel[kArm] = *sticks.arm ? 1.0 : -1.0;
}

void Transmitter::step(std::int64_t t_ns, io::Batch& sensed) {
  if (t_ns < next_ns_) return;
  next_ns_ = t_ns + kPeriod_ns;
  if (!on_) return;
  const io::Header head{t_ns, io::Kind::rc_channels, board_, 0, 0};
  sensed.add(head, {{reinterpret_cast<const std::uint8_t*>(&channels_), sizeof channels_}});
}

}  // namespace whirl::flight
