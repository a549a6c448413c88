// InvenSense MPU-6000 on SPI, or in a DroneCAN node: the part register by register (io_bridges/devices),
// what it senses by the plant's IMU, soldered as the board file's `axes` say.
#include <cmath>

#include "io_bridges/devices/imu_node.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/imu_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/inertial_sensor.hpp"

namespace whirl::rack {
namespace {

io::Mpu6000::Params imu_params(const DeviceSlot& slot) {
  io::Mpu6000::Params params;
  params.name = slot.name();
  params.bus = slot.bus_number();
  params.device = slot.number();
  return params;
}

class Mpu6000Device final : public RackDevice {
 public:
  Mpu6000Device(DeviceSlot& slot, const plant::ImuParams& physics)
      : sensor_(physics, mounting_of(slot.axes("axes")), slot.rack().seed(), slot.name()),
        part_(
            slot.rack().events(), imu_params(slot),
            [this](Nanoseconds now) { return sensor_.sample(now); },
            slot.given("int") ? &slot.pin("int") : nullptr, &slot.rack().faults(),
            slot.rack().finding()) {
    slot.join_spi(part_);
    if (!slot.given("int")) return;
    slot.pin("int").watch(
        [&happened = slot.rack().happened(), number = slot.number()](bool level, Nanoseconds now) {
          if (level) happened.add(io::Kind::data_ready, number, now, nullptr, 0);
        });
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    sensor_.set_motion(message.as<io::BodyMotion>(), message.header().t_ns);
  }

 private:
  InertialSensor sensor_;
  io::Mpu6000 part_;
};

constexpr int kImuNode = 50;
constexpr double kImuNode_samples_Hz = 1000.0, kImuNode_mostRaw_Hz = 250.0;

io::ImuNode::Setup::Form form_of(const std::string& message) {
  using Form = io::ImuNode::Setup::Form;
  return message == "raw" ? Form::raw : message == "imu16" ? Form::imu16 : Form::imu14;
}

// Never more often than asked.
int samples_of_a_message(double rate_Hz) {
  return static_cast<int>(std::ceil(kImuNode_samples_Hz / rate_Hz));
}

class ImuNodeDevice final : public RackDevice {
 public:
  ImuNodeDevice(DeviceSlot& slot, const plant::ImuParams& physics)
      : mounting_(mounting_of(slot.axes("axes"))),
        sensor_(physics, mounting_, slot.rack().seed(), slot.name()),
        node_(
            slot.rack().events(), slot.can(),
            {.node = can_node_of(slot, "org.whirlstand.imu", kImuNode),
             .part = imu_params(slot),
             .form = form_of(slot.text("params.message")),
             .every = samples_of_a_message(slot.quantity("params.raw_rate")),
             .to_body = [this](const auto& in_part) { return turned_back(mounting_, in_part); },
             .on_ready =
                 [&happened = slot.rack().happened(), number = slot.number()](Nanoseconds now) {
                   happened.add(io::Kind::data_ready, number, now, nullptr, 0);
                 }},
            [this](Nanoseconds now) { return sensor_.sample(now); }, &slot.rack().faults(),
            slot.rack().finding()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override {
    sensor_.set_motion(message.as<io::BodyMotion>(), message.header().t_ns);
  }

 private:
  Mounting mounting_;
  InertialSensor sensor_;
  io::ImuNode node_;
};

template <typename Device>
std::unique_ptr<RackDevice> make_imu(DeviceSlot& slot) {
  const plant::ImuParams physics = imu_physics_of(slot);
  if (slot.failed(plant::validate(physics, slot.place()))) return nullptr;
  return std::make_unique<Device>(slot, physics);
}

const std::vector<std::string> kImuSenses = {"accel_x", "accel_y", "accel_z",
                                             "gyro_x",  "gyro_y",  "gyro_z"};

}  // namespace

DeviceType mpu6000_type() {
  std::vector<DeviceKey> keys = {bus_key("spi", "the bus").need(),
                                 pin_key("cs", "chip select, active low").need(),
                                 pin_key("int", "interrupt output")};
  add_imu_keys(keys);
  return {
      "mpu6000", "accelerometer and gyroscope on SPI", std::move(keys), make_imu<Mpu6000Device>, {},
      kImuSenses};
}

DeviceType mpu6000_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("50");
  keys.push_back(word_key("params.message", "imu14 or imu16 or raw",
                          "of two frames or of three; raw: ahrs.RawIMU, of seven")
                     .with(std::string("imu14")));
  keys.push_back(quantity_key("params.raw_rate", Dimension::frequency, "Hz",
                              {1.0, kImuNode_mostRaw_Hz},
                              "of ahrs.RawIMU at most: every n-th sample of 1 kHz")
                     .with(kImuNode_mostRaw_Hz));
  add_imu_keys(keys);
  return {"mpu6000_dronecan",
          "accelerometer and gyroscope on CAN, by DroneCAN",
          std::move(keys),
          make_imu<ImuNodeDevice>,
          {},
          kImuSenses};
}

}  // namespace whirl::rack
