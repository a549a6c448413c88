// MEAS MS5611 on I2C or SPI, or in a DroneCAN node: the part command by command (io_bridges/devices), what
// it senses by the plant's barometer. Its white noise is the part's own, by oversampling.
//
//   Rotors    their thrust over the area of their discs, of which the frame feels rotor_share: a step
//             when they start (plant/sensors/barometer.hpp)
//   Left out  self-heating: the part is as warm as the air
#include "io_bridges/devices/air_node.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/sensed_air.hpp"

namespace whirl::rack {
namespace {

bool on_i2c(const DeviceSlot& slot) {
  return slot.text("bus").starts_with("i2c");
}

plant::BarometerParams physics_of(const DeviceSlot& slot) {
  plant::BarometerParams params;
  params.noise_density_Pa = 0.0;
  params.rotor_share = slot.quantity("params.rotor_share");
  params.disc_area_m2 = slot.quantity("params.disc_area_m2");
  params.turn_on_bias_Pa = slot.quantity("params.turn_on_bias");
  params.drift_Pa = slot.quantity("params.drift");
  params.drift_time_s = slot.quantity("params.drift_time");
  params.wind_share = slot.quantity("params.wind_share");
  params.lag_s = slot.quantity("params.lag");
  return params;
}

io::ms5611::Prom prom_of(DeviceSlot& slot) {
  const std::uint64_t seed = slot.rack().seed();
  io::ms5611::Coefficients coefficients =
      io::ms5611::draw_coefficients(slot.quantity("params.spread"), seed, slot.name());
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const std::string path = "params.c" + std::to_string(i + 1);
    if (slot.given(path)) coefficients[i] = slot.whole(path);
  }
  RandomStream random(seed, slot.name() + ".serial");
  const auto factory = static_cast<std::uint16_t>(random.bits() & 0xFFFF);
  const auto serial = static_cast<std::uint16_t>(random.bits() & 0xFFF);
  return io::ms5611::make_prom(coefficients, factory, serial);
}

io::Ms5611::Params barometer_params(DeviceSlot& slot) {
  io::Ms5611::Params params;
  params.name = slot.name();
  params.seed = slot.rack().seed();
  params.prom = prom_of(slot);
  params.noise_scale = slot.quantity("params.noise");
  params.conversion_share = slot.given("params.conversion_share")
                                ? slot.quantity("params.conversion_share")
                                : RandomStream(params.seed, slot.name() + ".oscillator").uniform();
  params.bus = slot.bus_number();
  params.device = slot.number();
  if (!on_i2c(slot)) return params;
  params.i2c_address = static_cast<std::uint8_t>(slot.whole("address"));
  params.device = params.i2c_address;
  return params;
}

class Ms5611Device final : public RackDevice {
 public:
  explicit Ms5611Device(DeviceSlot& slot)
      : air_(physics_of(slot), slot.rack().seed(), slot.name()),
        part_(
            slot.rack().events(), barometer_params(slot),
            [this](Nanoseconds now) { return air_.sense(now); }, &slot.rack().faults(),
            slot.rack().finding()) {
    if (on_i2c(slot)) {
      slot.join_i2c(part_);
    } else {
      slot.join_spi(part_);
    }
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { air_.set(message.as<io::BodyMotion>()); }

 private:
  SensedAir air_;
  io::Ms5611 part_;
};

class AirNodeDevice final : public RackDevice {
 public:
  explicit AirNodeDevice(DeviceSlot& slot)
      : air_(physics_of(slot), slot.rack().seed(), slot.name()),
        node_(
            slot.rack().events(), slot.can(), can_node_of(slot, "org.whirlstand.air", kNode),
            barometer_params(slot), [this](Nanoseconds now) { return air_.sense(now); },
            &slot.rack().faults(), slot.rack().finding()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { air_.set(message.as<io::BodyMotion>()); }

 private:
  static constexpr int kNode = 51;
  SensedAir air_;
  io::AirNode node_;
};

DeviceKey number_key(const char* path, Limits limits, const char* about) {
  return quantity_key(path, Dimension::none, "", limits, about);
}

void add_barometer_keys(std::vector<DeviceKey>& keys) {
  for (int i = 1; i <= 6; ++i) {
    DeviceKey key = quantity_key("params.c" + std::to_string(i), Dimension::none, "",
                                 {1.0, 65535.0}, "coefficient of its PROM");
    key.kind = KeyKind::whole;
    keys.push_back(key.with_text("drawn"));
  }
  keys.push_back(quantity_key("params.spread", Dimension::ratio, "%", {0.0, 0.05},
                              "of drawn coefficients, evenly about the sheet's typical ones")
                     .with(0.05));
  keys.push_back(number_key("params.conversion_share", {0.0, 1.0},
                            "0: the sheet's shortest conversions, 1: its longest")
                     .with_text("drawn"));
  keys.push_back(number_key("params.noise", {0.0, 100.0}, "times the sheet's").with(1.0));
}

void add_air_keys(std::vector<DeviceKey>& keys) {
  const plant::BarometerParams usual;
  const auto pressure = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::pressure, "Pa", {0.0, 10000.0}, about);
  };
  const auto time = [](const char* path, Limits limits, const char* about) {
    return quantity_key(path, Dimension::time, "s", limits, about);
  };
  keys.push_back(pressure("params.turn_on_bias", "standard deviation").with(usual.turn_on_bias_Pa));
  keys.push_back(
      pressure("params.drift", "standard deviation of a slow wander").with(usual.drift_Pa));
  keys.push_back(time("params.drift_time", {1.0, 1e5}, "how slow it is").with(usual.drift_time_s));
  keys.push_back(number_key("params.wind_share", {-1.0, 1.0}, "of the dynamic pressure")
                     .with(usual.wind_share));
  keys.push_back(number_key("params.rotor_share", {-1.0, 1.0},
                            "of the rotors' thrust over the area of their discs")
                     .with(usual.rotor_share));
  keys.push_back(number_key("params.disc_area_m2", {1e-3, 100.0}, "of all rotors together")
                     .with(usual.disc_area_m2));
  keys.push_back(time("params.lag", {1e-4, 10.0}, "of the air in the frame").with(usual.lag_s));
}

}  // namespace

DeviceType ms5611_type() {
  DeviceKey address = address_key();
  address.limits = {0x76, 0x77};
  std::vector<DeviceKey> keys = {
      bus_key("i2c or spi", "the bus").need(),
      address.need().on("i2c"),
      pin_key("cs", "chip select, active low").need().on("spi"),
  };
  add_barometer_keys(keys);
  add_air_keys(keys);
  return {"ms5611", "barometer on I2C or SPI",  std::move(keys), make_device<Ms5611Device>,
          {},       {"pressure", "temperature"}};
}

DeviceType ms5611_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("51");
  add_barometer_keys(keys);
  add_air_keys(keys);
  return {"ms5611_dronecan",
          "barometer on CAN, by DroneCAN",
          std::move(keys),
          make_device<AirNodeDevice>,
          {},
          {"pressure", "temperature"}};
}

}  // namespace whirl::rack
