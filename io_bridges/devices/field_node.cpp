#include "io_bridges/devices/field_node.hpp"

#include "io_bridges/protocols/dronecan/sensors.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kFieldNode_priority = 16, kFieldNode_address = Hmc5883l::kI2c_address;
constexpr Nanoseconds kFieldNode_read_ns = 200'000, kFieldNode_powerUp_ns = 60'000'000,
                      kFieldNode_look_ns = 100'000'000;
constexpr double kFieldNode_counts_per_Ga = 1090.0;
constexpr std::int16_t kFieldNode_overflow = -4096;

}  // namespace

FieldNode::FieldNode(EventQueue& queue, CanBus& bus, const Setup& setup, Hmc5883l::Sense sense,
                     FaultBook* faults, FindingSink findings)
    : queue_(queue),
      setup_(setup),
      node_(queue, bus, setup.node),
      part_(queue, setup.part, std::move(sense), &drdy_, faults, std::move(findings)),
      read_over_(queue, [this] { read_data(); }),
      look_(queue, [this] {
        if (!std::exchange(heard_, false)) set_up();
        look_.in(kFieldNode_look_ns);
      }) {
  drdy_.watch([this](bool level, Nanoseconds) {
    if (!level) read_over_.in(kFieldNode_read_ns);
  });
  look_.in(kFieldNode_powerUp_ns);
}

void FieldNode::set_up() {
  const Nanoseconds now = queue_.now();
  constexpr std::uint8_t kSettings[][2] = {{0x00, 6 << 2},  // CONF_A: 75 Hz
                                           {0x01, 1 << 5},  // CONF_B: +-1.3 Ga
                                           {0x02, 0}};      // MODE: continuous
  for (const auto& [address, value] : kSettings) {
    part_.start(kFieldNode_address, false, now);
    part_.write(address, now);
    part_.write(value, now);
    part_.stop(now);
  }
}

void FieldNode::read_data() {
  const Nanoseconds now = queue_.now();
  part_.start(kFieldNode_address, false, now);
  part_.write(0x03, now);
  part_.start(kFieldNode_address, true, now);
  std::array<std::int16_t, 3> x_z_y{};
  for (std::int16_t& word : x_z_y) {
    const int high = part_.read(now);
    word = static_cast<std::int16_t>(high << 8 | part_.read(now));
  }
  part_.stop(now);
  heard_ = true;
  for (const std::int16_t word : x_z_y) {
    if (word == kFieldNode_overflow) return;
  }
  const Triple field_Ga =
      setup_.to_body({x_z_y[0] / kFieldNode_counts_per_Ga, x_z_y[2] / kFieldNode_counts_per_Ga,
                      x_z_y[1] / kFieldNode_counts_per_Ga});
  dronecan::MagneticFieldStrength2 message;
  for (std::size_t i = 0; i < 3; ++i) message.field_Ga[i] = static_cast<float>(field_Ga[i]);
  node_.send(message, kFieldNode_priority);
}

}  // namespace whirl::io
