#include "io_bridges/devices/air_node.hpp"

#include "io_bridges/protocols/dronecan/sensors.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kAirNode_priority = 16;
constexpr Nanoseconds kAirNode_step_ns = 10'000'000;
constexpr std::uint8_t kAirNode_reset = 0x1E, kAirNode_adc = 0x00, kAirNode_prom = 0xA0,
                       kAirNode_pressure = 0x48, kAirNode_temperature = 0x58;
constexpr unsigned kAirNode_cycle = 4, kAirNode_most_bad = 5;
constexpr float kAirNode_rms_Pa = 1.2f, kAirNode_rms_K = 0.002f;

}  // namespace

AirNode::AirNode(EventQueue& queue, CanBus& bus, const DroneCanNode::Setup& node,
                 const Ms5611::Params& part, Ms5611::Sense sense, FaultBook* faults,
                 FindingSink findings)
    : queue_(queue),
      address_(part.i2c_address),
      node_(queue, bus, node),
      part_(queue, part, std::move(sense), faults, std::move(findings)),
      due_(queue, [this] { step(); }) {
  due_.in(kAirNode_step_ns);
}

void AirNode::command(std::uint8_t code) {
  const Nanoseconds now = queue_.now();
  part_.start(address_, false, now);
  part_.write(code, now);
  part_.stop(now);
}

std::uint32_t AirNode::ask(std::uint8_t code, int bytes) {
  command(code);
  part_.start(address_, true, queue_.now());
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | part_.read(queue_.now());
  part_.stop(queue_.now());
  return value;
}

void AirNode::step() {
  due_.in(kAirNode_step_ns);
  switch (next_) {
    case Next::reset:
      command(kAirNode_reset);
      slot_ = bad_ = 0;
      converting_ = false;
      next_ = Next::read_prom;
      return;
    case Next::read_prom:
      for (std::size_t i = 0; i < prom_.size(); ++i) {
        prom_[i] =
            static_cast<std::uint16_t>(ask(static_cast<std::uint8_t>(kAirNode_prom + 2 * i), 2));
      }
      next_ =
          ms5611::crc4(prom_) == (prom_[7] & 0xF) && prom_[1] != 0 ? Next::convert : Next::reset;
      return;
    case Next::convert:
      if (converting_) collect();
      if (next_ == Next::reset) return;
      of_pressure_ = slot_ != 0;  // a temperature first
      command(of_pressure_ ? kAirNode_pressure : kAirNode_temperature);
      converting_ = true;
      slot_ = (slot_ + 1) % kAirNode_cycle;
      return;
  }
}

void AirNode::collect() {
  const std::uint32_t counts = ask(kAirNode_adc, 3);
  if (counts == 0) {
    if (++bad_ == kAirNode_most_bad) next_ = Next::reset;
    return;
  }
  bad_ = 0;
  (of_pressure_ ? pressure_counts_ : temperature_counts_) = counts;
  publish();
}

void AirNode::publish() {
  const ms5611::Air air = ms5611::compensated(prom_, pressure_counts_, temperature_counts_);
  if (of_pressure_) {
    node_.send(dronecan::StaticPressure{static_cast<float>(air.pressure_Pa),
                                        kAirNode_rms_Pa * kAirNode_rms_Pa},
               kAirNode_priority);
  } else {
    node_.send(dronecan::StaticTemperature{static_cast<float>(air.temperature_K),
                                           kAirNode_rms_K * kAirNode_rms_K},
               kAirNode_priority);
  }
}

}  // namespace whirl::io
