#include "io_bridges/rack/devices/imu_keys.hpp"

namespace whirl::rack {
namespace {

void read_triad(const DeviceSlot& slot, const std::string& group, plant::TriadParams& triad) {
  const std::string path = "params." + group + ".";
  triad.noise_density = slot.quantity(path + "noise_density");
  triad.bias_instability = slot.quantity(path + "bias_instability");
  triad.turn_on_bias = slot.quantity(path + "turn_on_bias");
  triad.scale_error = slot.quantity(path + "scale_error");
  triad.cross_axis = slot.quantity(path + "cross_axis");
  triad.vibration_per_radps2 = slot.quantity(path + "vibration");
}

void add_triad(std::vector<DeviceKey>& keys, const std::string& group, const std::string& unit,
               Dimension dimension, const plant::TriadParams& usual) {
  const std::string path = "params." + group + ".";
  const auto bare = [&](const char* name, const std::string& of, double high, const char* about) {
    return quantity_key(path + name, Dimension::none, of, {0.0, high}, about);
  };
  const auto own = [&](const char* name, double high, const char* about) {
    return quantity_key(path + name, dimension, unit, {0.0, high}, about);
  };
  keys.push_back(bare("noise_density", unit + "/sqrt(Hz)", 10.0, "white noise, a bare number")
                     .with(usual.noise_density));
  keys.push_back(own("bias_instability", 10.0, "Allan floor / 0.664").with(usual.bias_instability));
  keys.push_back(own("turn_on_bias", 20.0, "standard deviation per axis").with(usual.turn_on_bias));
  keys.push_back(quantity_key(path + "scale_error", Dimension::ratio, "%", {0.0, 0.5},
                              "standard deviation per axis")
                     .with(usual.scale_error));
  keys.push_back(quantity_key(path + "cross_axis", Dimension::ratio, "%", {0.0, 0.5},
                              "of one axis in each other, standard deviation")
                     .with(usual.cross_axis));
  keys.push_back(bare("vibration", unit + "/(rad/s)^2", 1.0, "by rotor speed squared, bare")
                     .with(usual.vibration_per_radps2));
}

}  // namespace

plant::ImuParams imu_physics_of(const DeviceSlot& slot) {
  plant::ImuParams params = plant::mpu6000_physics();
  read_triad(slot, "accelerometer", params.accelerometer);
  read_triad(slot, "gyroscope", params.gyroscope);
  params.unbalance_second = slot.quantity("params.unbalance_second");
  params.unbalance_blades = slot.quantity("params.unbalance_blades");
  params.blade_count = slot.whole("params.blade_count");
  const auto place_m = slot.triple("params.place");
  const auto turn_rad = slot.triple("params.misalignment");
  params.p_BS_B_m = {place_m[0], place_m[1], place_m[2]};
  params.misalignment_rad = {turn_rad[0], turn_rad[1], turn_rad[2]};
  return params;
}

void add_imu_keys(std::vector<DeviceKey>& keys) {
  const plant::ImuParams usual = plant::mpu6000_physics();
  keys.push_back(
      axes_key("axes", "where its x, y, z point in the body (x forward, y right, z down)")
          .with(std::vector<std::string>{"+x", "-y", "-z"}));
  keys.push_back(
      triple_key("params.place", Dimension::length, "m", {-5.0, 5.0}, "from the centre of mass")
          .with(std::vector<double>{0.0, 0.0, 0.0}));
  keys.push_back(
      triple_key("params.misalignment", Dimension::angle, "deg", {-0.5, 0.5}, "a small turn")
          .with(std::vector<double>{0.0, 0.0, 0.0}));
  add_triad(keys, "accelerometer", "m/s2", Dimension::acceleration, usual.accelerometer);
  add_triad(keys, "gyroscope", "rad/s", Dimension::angular_rate, usual.gyroscope);
  const auto share = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::none, "", {0.0, 10.0}, about);
  };
  keys.push_back(
      share("params.unbalance_second", "twice a turn, of what a rotor's unbalance shakes")
          .with(usual.unbalance_second));
  keys.push_back(
      share("params.unbalance_blades", "at the blades' passing, along the shaft, likewise")
          .with(usual.unbalance_blades));
  DeviceKey blade_count =
      quantity_key("params.blade_count", Dimension::none, "", {1.0, 12.0}, "of a propeller");
  blade_count.kind = KeyKind::whole;
  keys.push_back(blade_count.with(static_cast<double>(usual.blade_count)));
}

}  // namespace whirl::rack
