#include "io_bridges/devices/sbus.hpp"

namespace whirl::io {
namespace {

UartFormat format_of(const SbusReceiver::Params& params) {
  return {core::receiver::kSbusBaud, 8, 'E', 2.0, !params.inverter};
}

}  // namespace

std::optional<SbusFrame> sbus_frame(RadioLink::Output out, Failsafe failsafe) {
  const bool never = out.state == RadioLink::State::never_heard;
  if (out.silent && !(never && failsafe == Failsafe::hold)) return {};
  if (never && failsafe == Failsafe::hold) out.sticks[kThrustStick] = -1.0;
  SbusFrame frame;
  for (std::size_t i = 0; i < frame.channels.size(); ++i) {
    frame.channels[i] = sbus_of_travel(out.sticks[i]);
  }
  if (out.state != RadioLink::State::up) frame.flags |= kSbusFrameLost;
  if (never || out.state == RadioLink::State::failsafe) frame.flags |= kSbusFailsafe;
  return frame;
}

void SbusGlitches::spoil(SbusFrame& frame, Nanoseconds now) {
  if (faults_ == nullptr) return;
  const Fault* glitch = faults_->find(FaultKind::rc_glitch, bus_, device_, now);
  if (glitch == nullptr || nonsense_.uniform() >= glitch->value) return;
  faults_->applied(*glitch, now);
  for (auto& channel : frame.channels) {
    channel = static_cast<std::uint16_t>(nonsense_.bits() % 2048);
  }
}

SbusReceiver::SbusReceiver(EventQueue& queue, const Params& params, FaultBook* faults)
    : queue_(queue),
      params_(params),
      link_(params.link, faults),
      transmitter_(queue, format_of(params),
                   [this](const UartByte& byte, const UartFormat& format) { send(byte, format); }),
      glitches_(faults, params.link.bus, params.link.device, params.seed, params.name),
      frame_(queue, [this] { begin_frame(); }) {
  frame_.in(core::receiver::kSbusBoot_ns);
}

void SbusReceiver::begin_frame() {
  const Nanoseconds now = queue_.now();
  frame_.at(now + params_.period_ns);
  auto frame = sbus_frame(link_.at(now), params_.link.failsafe);
  if (!frame) return;
  glitches_.spoil(*frame, now);
  transmitter_.add(encode(*frame));
}

}  // namespace whirl::io
