// A speed controller on CAN; the motor behind it is the harness's.
//
//   Set-point  esc.RawCommand at its index (motor - 1): four steps of it are one of the I2C protocol's
//              2047, so 0 stops and 8191 is the top of the range of the ESC's mode. Negative: refused.
//              An array too short to reach it says 0
//   Speed      esc.RPMCommand likewise, where the ESC is in the mode whose set-points are speeds: to the nearest step of
//              its range; beyond the range, or in another mode: refused
//   Status     20 Hz: esc.Status (rated power and temperature are not known: 0 % and NaN), then
//              StatusExtended with the flags of the I2C protocol's status byte
#include <cmath>
#include <optional>

#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/esc_extended.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kStatusPeriod_ns = 50'000'000;
constexpr double kPhasePerMotor_ns = 11'300'000;  // of each further motor: not all at once
constexpr std::uint8_t kStatusPriority = 16;
constexpr int kRawSteps = 4;
constexpr int kFirstNode = 40;  // 0x28 + motor, as its address on I2C

// Nothing: no speed of the mode's range.
std::optional<int> setpoint_of_speed(int speed_rpm) {
  const io::EscRange range = io::range_of(io::EscMode::rpm);
  if (speed_rpm == 0) return 0;
  if (speed_rpm < range.min || speed_rpm > range.max) return std::nullopt;
  return io::setpoint_of_value(io::EscMode::rpm, speed_rpm);
}

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
          const int raw = own_of(command.commands);
          follow(raw < 0 ? std::nullopt : std::optional(raw / kRawSteps), begun, now);
        });
    node_.on<io::dronecan::RpmCommand>([this, by_speed = slot.flag("params.speeds")](
                                           const auto& command, Nanoseconds begun,
                                           Nanoseconds now) {
      const int speed_rpm = own_of(command.speeds_rpm);
      follow(by_speed || speed_rpm == 0 ? setpoint_of_speed(speed_rpm) : std::nullopt, begun, now);
    });
    due_.in(std::llround(kPhasePerMotor_ns * motor_));
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
  template <typename List>
  int own_of(const List& all) const {
    const std::size_t index = motor_ - 1u;
    return index < all.size ? all.items[index] : 0;
  }

  void follow(std::optional<int> value, Nanoseconds begun, Nanoseconds now) {
    io::EscSetpoint setpoint;
    setpoint.valid = value ? 1 : 0;
    setpoint.value = static_cast<std::uint16_t>(value.value_or(0));
    setpoint.start_ns = begun;
    rejected_ = rejected_ || !value;
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
    node_.send(status, kStatusPriority);
    io::dronecan::EscStatusExtended extended;
    extended.flags = state_.flags | (rejected_ ? kWriteRejected : 0u);
    extended.index = index;
    rejected_ = false;
    node_.send(extended, kStatusPriority);
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
  keys.push_back(
      flag_key("params.speeds", "its set-points are speeds: it takes RPMCommand, too").with(false));
  return {"esc_dronecan", "speed controller on CAN, by DroneCAN", std::move(keys),
          make_device<CanEscDevice>};
}

}  // namespace whirl::rack
