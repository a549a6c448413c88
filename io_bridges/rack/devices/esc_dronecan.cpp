// A speed controller on CAN; the motor behind it is the harness's.
//
//   Set-point  esc.RawCommand at its index (motor - 1): four steps of it are one of the I2C protocol's
//              2047, so 0 stops and 8191 is the top of the range of the ESC's mode. Negative: refused.
//              An array too short to reach it says 0
//   Status     20 Hz: esc.Status (rated power and temperature are not known: 0 % and NaN), then
//              StatusExtended with the flags of the I2C protocol's status byte
#include <cmath>

#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kStatusPeriod_ns = 50'000'000;
constexpr double kPhase_ns = 11'300'000;  // of each further motor: not all at once
constexpr std::uint8_t kPriority = 16;
constexpr int kRawSteps = 4;
constexpr int kFirstNode = 40;  // 0x28 + motor, as its address on I2C

class CanEscDevice final : public RackDevice {
 public:
  explicit CanEscDevice(DeviceSlot& slot)
      : motor_(slot.whole("motor")),
        happened_(slot.rack().happened()),
        node_(slot.rack().events(), slot.can(),
              can_node_of(slot, "org.whirlstand.esc", kFirstNode + motor_)),
        due_(slot.rack().events(), [this] { publish(); }) {
    node_.on<io::dronecan::RawCommand>(
        [this](const auto& command, Nanoseconds begun, Nanoseconds now) {
          on_command(command, begun, now);
        });
    due_.in(std::llround(kPhase_ns * motor_));
  }

  std::vector<Intake> intakes() const override {
    return {{io::Kind::esc_state, motor_}, {io::Kind::body_motion, std::nullopt}};
  }
  void on_message(const io::Reader& message) override {
    if (message.header().kind == io::Kind::body_motion) {
      bus_voltage_V_ = message.as<io::BodyMotion>().bus_voltage_V;
    } else {
      state_ = message.as<io::EscState>();
    }
  }

 private:
  void on_command(const io::dronecan::RawCommand& command, Nanoseconds begun, Nanoseconds now) {
    const std::size_t index = motor_ - 1u;
    const int raw = index < command.commands.size ? command.commands.items[index] : 0;
    io::EscSetpoint setpoint;
    setpoint.valid = raw >= 0 ? 1 : 0;
    setpoint.value = static_cast<std::uint16_t>(raw >= 0 ? raw / kRawSteps : 0);
    setpoint.start_ns = begun;
    rejected_ = rejected_ || raw < 0;
    happened_.add(io::Kind::esc_setpoint, motor_, now, setpoint);
  }

  void publish() {
    constexpr std::uint8_t kWriteRejected = 1u << 7;  // since the last status
    const auto index = static_cast<std::uint8_t>(motor_ - 1);
    io::dronecan::EscStatus status;
    status.voltage_V = static_cast<float>(bus_voltage_V_);
    status.current_A = static_cast<float>(state_.bus_current_A);
    status.temperature_K = std::nanf("");
    status.speed_rpm = static_cast<std::int32_t>(std::lround(state_.speed_rpm));
    status.index = index;
    node_.send(status, kPriority);
    io::dronecan::EscStatusExtended extended;
    extended.flags = state_.flags | (rejected_ ? kWriteRejected : 0u);
    extended.index = index;
    rejected_ = false;
    node_.send(extended, kPriority);
    due_.in(kStatusPeriod_ns);
  }

  std::uint16_t motor_;
  io::Batch& happened_;
  io::DroneCanNode node_;
  io::Event due_;
  io::EscState state_;
  double bus_voltage_V_ = 0.0;
  bool rejected_ = false;
};

}  // namespace

DeviceType esc_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("40 + motor");
  keys.insert(keys.begin() + 1, motor_key().need());
  return {"esc_dronecan", "speed controller on CAN, by DroneCAN", std::move(keys),
          make_device<CanEscDevice>};
}

}  // namespace whirl::rack
