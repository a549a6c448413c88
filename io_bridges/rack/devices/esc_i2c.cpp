// A speed controller as its I2C master sees it; the motor behind it is the harness's.
#include "io_bridges/devices/esc_i2c.hpp"

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

class EscDevice final : public RackDevice {
 public:
  explicit EscDevice(DeviceSlot& slot)
      : motor_(slot.whole("motor")), esc_(static_cast<std::uint8_t>(slot.whole("address"))) {
    esc_.on_setpoint(
        [&happened = slot.rack().happened(), motor = motor_](const io::EscI2c::Write& write) {
          io::EscSetpoint setpoint;
          setpoint.value = write.v;
          setpoint.valid = write.valid ? 1 : 0;
          setpoint.start_ns = write.start_ns;
          happened.add(io::Kind::esc_setpoint, motor, write.stop_ns, setpoint);
        });
    slot.join_i2c(esc_);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::esc_state, motor_}}; }
  void on_message(const io::Reader& message) override {
    const auto state = message.as<io::EscState>();
    esc_.set_status({state.bus_current_A, state.speed_rpm, state.flags});
  }

 private:
  std::uint16_t motor_;
  io::EscI2c esc_;
};

}  // namespace

DeviceType esc_i2c_type() {
  return {"esc_i2c",
          "speed controller on I2C",
          {bus_key("i2c", "the bus").need(), address_key().need(), motor_key().need()},
          make_device<EscDevice>};
}

}  // namespace whirl::rack
