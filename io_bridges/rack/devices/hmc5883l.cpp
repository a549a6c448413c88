// Honeywell HMC5883L on I2C, or in a DroneCAN node: the part register by register (io_bridges/devices), the field at the
// vehicle and what the frame adds to it, soldered as the board file's `axes` say.
//
//   Currents  what each motor's bus current and the pack's add, per ampere, means over a millisecond
//             (plant/sensors/magnetometer.hpp)
//   Soft iron what the frame makes of the earth's field: (1 + E) x field, E symmetric, in the body's axes. It
//             bends neither the currents' fields nor its own hard iron
//   Left out  the currents' ripple
#include "io_bridges/devices/field_node.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/sensed_field.hpp"

namespace whirl::rack {
namespace {

constexpr double kMost_T = 1e-3;  // beyond its largest range
constexpr double kMost_soft = 0.3;

std::string motor_field(std::size_t number) {
  return "params.motor_field_" + std::to_string(number);
}

DeviceKey per_ampere_key(const std::string& path, const Eigen::Vector3d& usual_T,
                         const char* about) {
  return triple_key(path, Dimension::magnetic_field, "uT", {-kMost_T, kMost_T}, about)
      .with(std::vector<double>(usual_T.begin(), usual_T.end()));
}

io::Hmc5883l::Params magnetometer_params(DeviceSlot& slot) {
  io::Hmc5883l::Params params;
  params.name = slot.name();
  params.seed = slot.rack().seed();
  params.noise_T = slot.quantity("params.noise");
  params.bus = slot.bus_number();
  const bool on_i2c = slot.text("bus").starts_with("i2c");
  params.device = on_i2c ? io::Hmc5883l::kI2c_address : slot.number();
  return params;
}

Eigen::Matrix3d soft_iron_of(DeviceSlot& slot) {
  const auto scale = slot.triple("params.soft_iron"), cross = slot.triple("params.soft_iron_cross");
  Eigen::Matrix3d soft;
  soft << 1.0 + scale[0], cross[0], cross[1],  //
      cross[0], 1.0 + scale[1], cross[2],      //
      cross[1], cross[2], 1.0 + scale[2];
  return soft;
}

FieldParams field_of(DeviceSlot& slot) {
  FieldParams params{.mounting = mounting_of(slot.axes("axes")),
                     .hard_iron_B_T = Eigen::Vector3d(slot.triple("params.hard_iron").data()),
                     .pack_per_ampere_T = Eigen::Vector3d(slot.triple("params.pack_field").data()),
                     .soft_iron = soft_iron_of(slot),
                     .per_ampere_T = {}};
  for (std::size_t i = 0; i < params.per_ampere_T.size(); ++i) {
    params.per_ampere_T[i] = Eigen::Vector3d(slot.triple(motor_field(i + 1)).data());
  }
  return params;
}

class Hmc5883lDevice final : public RackDevice {
 public:
  explicit Hmc5883lDevice(DeviceSlot& slot)
      : field_(field_of(slot)),
        part_(
            slot.rack().events(), magnetometer_params(slot),
            [this](Nanoseconds) { return field_.along_part_T(); },
            slot.given("drdy") ? &slot.pin("drdy") : nullptr, &slot.rack().faults(),
            slot.rack().finding()) {
    slot.join_i2c(part_);
    if (!slot.given("drdy")) return;
    slot.pin("drdy").watch(
        [&happened = slot.rack().happened(), number = slot.number()](bool level, Nanoseconds now) {
          if (!level) happened.add(io::Kind::data_ready, number, now, nullptr, 0);
        });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { field_.set(message.as<io::BodyMotion>()); }

 private:
  SensedField field_;
  io::Hmc5883l part_;
};

class FieldNodeDevice final : public RackDevice {
 public:
  explicit FieldNodeDevice(DeviceSlot& slot)
      : field_(field_of(slot)),
        node_(
            slot.rack().events(), slot.can(),
            {.node = can_node_of(slot, "org.whirlstand.field", kNode),
             .part = magnetometer_params(slot),
             .to_body =
                 [this](const auto& in_part) { return turned_back(field_.mounting(), in_part); }},
            [this](Nanoseconds) { return field_.along_part_T(); }, &slot.rack().faults(),
            slot.rack().finding()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { field_.set(message.as<io::BodyMotion>()); }

 private:
  static constexpr int kNode = 52;
  SensedField field_;
  io::FieldNode node_;
};

void add_field_keys(std::vector<DeviceKey>& keys) {
  keys.push_back(axes_key("axes", "where its x, y, z point in the body").need());
  keys.push_back(quantity_key("params.noise", Dimension::magnetic_field, "uT", {0.0, kMost_T},
                              "RMS of one measurement")
                     .with(io::Hmc5883l::Params{}.noise_T));
  keys.push_back(triple_key("params.hard_iron", Dimension::magnetic_field, "uT",
                            {-kMost_T, kMost_T}, "that the frame adds, along x, y, z of the body")
                     .with(std::vector<double>{0.0, 0.0, 0.0}));
  keys.push_back(
      triple_key("params.soft_iron", Dimension::ratio, "%", {-kMost_soft, kMost_soft},
                 "of the earth's field, that the frame adds to its part along x, y, z of the body")
          .with(std::vector<double>{0.0, 0.0, 0.0}));
  keys.push_back(triple_key("params.soft_iron_cross", Dimension::ratio, "%",
                            {-kMost_soft, kMost_soft},
                            "that it turns from x to y and back, x to z, y to z")
                     .with(std::vector<double>{0.0, 0.0, 0.0}));
  keys.push_back(per_ampere_key("params.pack_field", Eigen::Vector3d::Zero(),
                                "that each ampere out of the pack adds"));
  const auto usual_T = usual_motor_fields_T();
  for (std::size_t motor = 1; motor <= io::kMostMotors; ++motor) {
    keys.push_back(per_ampere_key(motor_field(motor), usual_T[motor - 1],
                                  "that each ampere of this motor's adds"));
  }
}

}  // namespace

DeviceType hmc5883l_type() {
  DeviceKey address = address_key();
  address.limits = {io::Hmc5883l::kI2c_address, io::Hmc5883l::kI2c_address};
  std::vector<DeviceKey> keys = {bus_key("i2c", "the bus").need(), address.need(),
                                 pin_key("drdy", "data ready output, low for 5 us")};
  add_field_keys(keys);
  return {"hmc5883l",
          "magnetometer on I2C",
          std::move(keys),
          make_device<Hmc5883lDevice>,
          {},
          {"field_x", "field_y", "field_z"}};
}

DeviceType hmc5883l_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("52");
  add_field_keys(keys);
  return {"hmc5883l_dronecan",
          "magnetometer on CAN, by DroneCAN",
          std::move(keys),
          make_device<FieldNodeDevice>,
          {},
          {"field_x", "field_y", "field_z"}};
}

}  // namespace whirl::rack
