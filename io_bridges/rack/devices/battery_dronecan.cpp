// A battery monitor on CAN: BatteryInfo of the pack's voltage and current, ten times a second.
//
//   Errors    gain drawn evenly within a tolerance, white noise; half precision on the bus (16 mV at 16 V)
//   Left out  temperature, charge and capacity: told as not known (NaN, 0 %)
#include <cmath>

#include "base/random.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kPeriod_ns = 100'000'000, kPhase_ns = 37'000'000;
constexpr std::uint8_t kPriority = 20;

class BatteryNodeDevice final : public RackDevice {
 public:
  explicit BatteryNodeDevice(DeviceSlot& slot)
      : node_(slot.rack().events(), slot.can(), can_node_of(slot, "org.whirlstand.battery", kNode)),
        noise_(slot.rack().seed(), slot.name() + ".noise"),
        noise_V_(slot.quantity("params.noise")),
        noise_A_(slot.quantity("params.noise_current")),
        due_(slot.rack().events(), [this] { publish(); }) {
    RandomStream drawn(slot.rack().seed(), slot.name() + ".gain");
    const double tolerance = slot.quantity("params.tolerance");
    gain_ = 1.0 + tolerance * (2.0 * drawn.uniform() - 1.0);
    due_.in(kPhase_ns);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { motion_ = message.as<io::BodyMotion>(); }

 private:
  void publish() {
    io::dronecan::BatteryInfo info;
    for (float* unknown : {&info.temperature_K, &info.mean_power_10s_W, &info.remaining_Wh,
                           &info.full_Wh, &info.hours_to_full}) {
      *unknown = std::nanf("");
    }
    const double voltage_V = gain_ * motion_.bus_voltage_V + noise_V_ * noise_.normal();
    const double current_A = motion_.battery_current_A + noise_A_ * noise_.normal();
    info.voltage_V = static_cast<float>(voltage_V);
    info.current_A = static_cast<float>(current_A);
    node_.send(info, kPriority);
    due_.in(kPeriod_ns);
  }

  static constexpr int kNode = 54;

  io::DroneCanNode node_;
  RandomStream noise_;
  double noise_V_, noise_A_, gain_ = 1.0;
  io::BodyMotion motion_;
  io::Event due_;
};

}  // namespace

DeviceType battery_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("54");
  keys.push_back(quantity_key("params.tolerance", Dimension::ratio, "%", {0.0, 0.2},
                              "of the voltage, drawn evenly")
                     .with(0.005));
  keys.push_back(
      quantity_key("params.noise", Dimension::voltage, "mV", {0.0, 1.0}, "RMS").with(5e-3));
  keys.push_back(
      quantity_key("params.noise_current", Dimension::current, "A", {0.0, 10.0}, "RMS").with(0.05));
  return {"battery_dronecan", "battery monitor on CAN, by DroneCAN", std::move(keys),
          make_device<BatteryNodeDevice>};
}

}  // namespace whirl::rack
