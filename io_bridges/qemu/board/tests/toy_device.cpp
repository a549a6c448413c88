// A device that no board has: a thermometer on I2C that answers every read with the air's
// temperature in whole kelvin, and with 0xEE where a fault makes it a wrong one. One file, and one
// line of a table (toy_device_test.cpp).
#include "io_bridges/qemu/board/tests/toy_device.hpp"

namespace whirl::board_test {
namespace {

class Toy final : public rack::RackDevice, public io::I2cTarget {
 public:
  explicit Toy(rack::DeviceSlot& slot)
      : address_(static_cast<std::uint8_t>(slot.whole("address"))),
        offset_K_(slot.quantity("params.offset")),
        bus_(slot.bus_number()),
        faults_(slot.rack().faults()) {
    slot.join_i2c(*this);
  }

  std::vector<rack::Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    air_K_ = message.as<io::BodyMotion>().air_temperature_K;
  }

  bool answers(std::uint8_t address) const override { return address == address_; }
  bool start(std::uint8_t, bool, io::Nanoseconds) override { return true; }
  bool write(std::uint8_t, io::Nanoseconds) override { return true; }
  std::uint8_t read(io::Nanoseconds now) override {
    const bool wrong =
        faults_.apply(io::FaultKind::sensor_wrong_identity, bus_, address_, now) != nullptr;
    return wrong ? 0xEE : static_cast<std::uint8_t>(air_K_ + offset_K_ - 200.0);
  }
  void acked(bool, io::Nanoseconds) override {}
  void stop(io::Nanoseconds) override {}

 private:
  std::uint8_t address_;
  double offset_K_, air_K_ = 288.15;
  int bus_;
  io::FaultBook& faults_;
};

}  // namespace

rack::DeviceType toy_type() {
  return {"toy_thermometer",
          "thermometer of the tests",
          {rack::bus_key("i2c", "the bus").need(), rack::address_key().need(),
           rack::quantity_key("params.offset", Dimension::none, "K", {-10.0, 10.0}, "its error")
               .with(0.0)},
          rack::make_device<Toy>};
}

}  // namespace whirl::board_test
