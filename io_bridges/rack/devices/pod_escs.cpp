#include "io_bridges/rack/devices/pod_escs.hpp"

#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kEvery_ns = 20'000'000 / PodEscs::kEscs;

}  // namespace

PodEscs::PodEscs(Rack& rack, Sink to_pod)
    : rack_(rack), to_pod_(std::move(to_pod)), due_(rack.events(), [this] { tell_next(); }) {}

std::vector<Intake> PodEscs::intakes() {
  std::vector<Intake> all;
  for (std::uint16_t motor = 1; motor <= kEscs; ++motor) {
    all.push_back({io::Kind::esc_state, motor});
  }
  return all;
}

void PodEscs::on_message(const io::Reader& message) {
  states_.at(message.header().port - 1u) = message.as<io::EscState>();
  if (!due_.pending()) due_.in(kEvery_ns);
}

void PodEscs::told(const io::PodSetpoint& setpoint) {
  if (setpoint.esc >= kEscs) return;  // damaged and not seen: there is no such part
  ++setpoints_;
  if (!setpoint.valid) ++refused_;
  io::EscSetpoint told;
  told.value = setpoint.valid ? setpoint.value : std::uint16_t{0};
  told.valid = setpoint.valid ? 1 : 0;
  told.start_ns = rack_.events().now();
  rack_.happened().add(io::Kind::esc_setpoint, static_cast<std::uint16_t>(setpoint.esc + 1),
                       told.start_ns, told);
}

void PodEscs::tell_next() {
  due_.in(kEvery_ns);
  const std::size_t esc = next_;
  next_ = (next_ + 1) % kEscs;
  if (!states_[esc]) return;
  const io::EscState& state = *states_[esc];
  const auto counts = io::counts_of({state.bus_current_A, state.speed_rpm, state.flags});
  to_pod_(io::pack_pod_esc(number_++, static_cast<std::uint8_t>(esc), counts.current_mA,
                           counts.speed_rpm, counts.flags));
}

}  // namespace whirl::rack
