#include "harness/flight/still_air.hpp"

#include <string>

#include "harness/flight/native_esc.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "plant/air/air.hpp"
#include "plant/averaged_powertrain.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kStillTick_ns = 1'000'000;
constexpr double kTick_s = 1e-3;
constexpr int kZeros_ms = 600, kSet_point_ms = 20;

// By its map alone: an ESC that does not know still air's power yet takes it for a wind.
EscParams by_speed(EscParams esc) {
  esc.calibration.mode = fw::esc::Mode::thrust_by_speed;
  return esc;
}

// One motor of the vehicle with its rotor, its ESC and the pack, held fast.
class Rig {
 public:
  Rig(const FlightParams& params, std::size_t motor, std::uint64_t seed)
      : powertrain_({params.vehicle.motor_of(motor)}, params.vehicle.battery,
                    params.vehicle.avionics_current_A),
        esc_(by_speed(params.esc), seed, static_cast<int>(motor) + 1) {
    plant::AirframeParams alone = params.vehicle.airframe;
    alone.rotors = {params.vehicle.airframe.rotors.at(motor)};
    rotor_ = plant::blade_element_rotors(params.blade, alone).front();
    const plant::Atmosphere air = plant::Air(params.vehicle.air, seed).at(Eigen::Vector3d::Zero());
    conditions_.density_kgpm3 = air.density_kgpm3;
    conditions_.viscosity_Pas = air.viscosity_Pas;
    state_.motors.resize(1);
    state_.bus_voltage_V = powertrain_.source_V();
  }

  void hold(std::uint16_t setpoint, std::int64_t ms) {
    for (std::int64_t i = 0; i < ms; ++i) {
      if (i % kSet_point_ms == 0) esc_.write(setpoint);
      tick();
    }
  }
  NativeEsc& esc() { return esc_; }
  double winding_temperature_K() const { return state_.motors[0].winding_temperature_K; }
  void tick() {
    powertrain_.command(0, esc_.step(now_ns_, state_.motors[0], state_.bus_voltage_V));
    conditions_.omega_radps = powertrain_.speed_radps(0);
    const plant::ShaftLoad load =
        plant::shaft_load(rotor_(conditions_, kTick_s), conditions_.omega_radps);
    powertrain_.set_loads({&load, 1});
    powertrain_.step(kTick_s, state_);
    now_ns_ += kStillTick_ns;
  }

 private:
  plant::AveragedPowertrain powertrain_;
  NativeEsc esc_;
  plant::RotorStep rotor_;
  plant::RotorConditions conditions_;
  plant::PowertrainState state_;
  std::int64_t now_ns_ = 0;
};

}  // namespace

Result<Done> tell_still_air(FlightParams& params, std::uint64_t seed) {
  if (!params.still_air) return Done{};
  if (!params.far_shafts.empty()) {
    return Error{ErrorKind::bad_input, "esc.still_air",
                 "the vehicle's controllers are boards of their own", "type `still` to them"};
  }
  const auto setpoint =
      io::setpoint_of_value(io::EscMode::thrust_by_rpm, params.still_air->thrust_N);
  std::vector<fw::esc::Calibration> told;
  for (std::size_t i = 0; i < params.vehicle.airframe.rotors.size(); ++i) {
    Rig rig(params, i, seed);
    rig.hold(0, kZeros_ms);
    rig.hold(setpoint, params.still_air->warm_up_ns / kStillTick_ns);
    const auto share = rig.esc().take_still_air([&] { rig.hold(setpoint, 1); });
    const std::string motor = "motor " + std::to_string(i + 1);
    if (!share) {
      return Error{
          ErrorKind::bad_input, "esc.still_air", motor + ": its ESC refuses `still` at this thrust",
          "a thrust by which it was calibrated, and a calibration that fits its motor to 15 %"};
    }
    told.push_back(rig.esc().core().calibration());
    told.back().mode = params.esc.calibration.mode;
    if (!params.vehicle.motors.empty()) {
      params.vehicle.motors[i].start_temp_K = rig.winding_temperature_K();
    }
    params.drawn.push_back({motor + " still_air", *share - 1.0, ""});
  }
  params.calibrations = std::move(told);
  return Done{};
}

}  // namespace whirl::flight
