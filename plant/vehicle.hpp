// A rotorcraft as physics: a powertrain, a rotor on each of its shafts, a rigid body, ground.
//
//   Frame    W and B as in frames.hpp; motors and rotors by index = motor number - 1
//   Units    SI
//   Order    one step: commands and air at t -> powertrain over [t, t + dt] (powertrain.hpp)
//            -> rotor loads -> rigid body over [t, t + dt] -> contact -> state() at t + dt
//   Valid    dt from 0.1 to 2 ms; the rotor's loads are held over the step, except that shaft
//            torque follows the square of speed
//   Left out blade flexing, rotor-on-rotor wake (at most: plant/rotor/wake_bound.hpp), the ground's
//            effect beyond each rotor's (mirrored neighbours and body: by [SanchezCuevas] 9 % more
//            thrust of a quad one radius high, 8 % two), wind that varies inside a rotor's disc
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.hpp"
#include "plant/air/air_params.hpp"
#include "plant/airframe/airframe_params.hpp"
#include "plant/airframe/obstacle.hpp"
#include "plant/airframe/slung_load.hpp"
#include "plant/battery/battery_params.hpp"
#include "plant/motor/motor_params.hpp"
#include "plant/powertrain.hpp"

namespace whirl::plant {

class Blade;             // plant/rotor/blade.hpp
struct RotorConditions;  // plant/rotor/rotor.hpp
struct RotorLoads;
// What these loads, of a rotor at that speed, are to its shaft until the next ones: they follow the square of speed.
ShaftLoad shaft_load(const RotorLoads& loads, double at_speed_radps);

using RotorStep = std::function<RotorLoads(const RotorConditions& conditions, double dt_s)>;
using RotorSet = std::vector<RotorStep>;

// A blade-element rotor for each of the airframe's mounts, turning as it says.
RotorSet blade_element_rotors(std::shared_ptr<const Blade> blade, const AirframeParams& airframe);

struct VehicleParams {
  AirframeParams airframe;
  MotorParams motor;                // of each rotor
  std::vector<MotorParams> motors;  // or of one after the other; empty: they do not differ
  const MotorParams& motor_of(std::size_t i) const { return motors.empty() ? motor : motors.at(i); }
  BatteryParams battery;
  double avionics_current_A = 0.25;
  AirParams air;
  std::vector<Obstacle> obstacles;      // besides the floor
  std::optional<SlungLoadParams> load;  // below it on a line
};

VehicleParams hp_quad();  // the reference vehicle of [Bangura2017, ch. 3]

Result<Done> validate(const VehicleParams& params, const std::string& place);

struct VehicleState : PowertrainState {
  double t_s = 0.0;
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WB_B_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_B_mps2 = Eigen::Vector3d::Zero();  // at the centre of mass
  Eigen::Vector3d alpha_WB_B_radps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d wind_W_mps = Eigen::Vector3d::Zero();  // at the centre of mass
  double static_pressure_Pa = 0.0, air_temperature_K = 0.0, air_density_kgpm3 = 0.0;
  double contact_impulse_Ns = 0.0;  // what ground and obstacles gave in this step
  bool on_ground = false;           // something holds it from below: floor, slope, box
  bool touching = false;            // something else touches feet or hubs: a wall, a ceiling
  // Of a slung load:
  Eigen::Vector3d load_p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d load_v_W_mps = Eigen::Vector3d::Zero();
  double line_tension_N = 0.0;
};

// Where something that holds the body has it at the end of a step.
struct CarriedBody {
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WB_B_radps = Eigen::Vector3d::Zero();
};

class Vehicle {
 public:
  // Pre: validate(params) succeeded. The vehicle starts at rest on its gear at W's origin, nose
  // north. `rotors` has one for each of params.airframe.rotors, and rotors[i] turns as its spin says.
  // Its motors are averaged ones on its own bus;
  Vehicle(const VehicleParams& params, RotorSet rotors, std::uint64_t seed);
  // or its shafts are those of `powertrain`: one for each rotor, standing still, of the inertia that
  // params.motor says. (Of params, motor and battery otherwise count for nothing then.)
  Vehicle(const VehicleParams& params, RotorSet rotors, std::unique_ptr<Powertrain> powertrain,
          std::uint64_t seed);
  ~Vehicle();
  Vehicle(Vehicle&&) noexcept;
  Vehicle& operator=(Vehicle&&) noexcept;

  // Puts the vehicle elsewhere, at rest or moving, motors as they are.
  void place(const Eigen::Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB,
             const Eigen::Vector3d& v_WB_W_mps, const Eigen::Vector3d& w_WB_B_radps);
  void set_motor_speed(int index, double speed_radps);
  // In the next step the body moves as told, whatever pulls at it; then it is free again. Specific force and
  // angular acceleration are the means over the step.
  void carry(const CarriedBody& to);

  void command(int index, const MotorCommand& command);  // holds until the next one
  void set_steady_wind(const Eigen::Vector3d& wind_W_mps);
  void add_gust(const GustWindow& gust);
  void add_jet(const Jet& jet);
  void dip_supply(double below_V, double start_s, double duration_s);  // lowers the source
  void push(const Eigen::Vector3d& force_W_N, double duration_s);      // at the centre of mass

  void step(double dt_s);
  const VehicleState& state() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace whirl::plant
