#include "plant/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/check.hpp"
#include "plant/air/air.hpp"
#include "plant/airframe/contact_world.hpp"
#include "plant/averaged_powertrain.hpp"
#include "plant/base/bounds.hpp"
#include "plant/base/frames.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/rotor/vortex_ring.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kFewTurns_radps = 20.0;

struct Dip {
  double below_V, start_s, end_s;
};
struct Push {
  Vector3d force_W_N;
  double end_s;
};

std::vector<MotorParams> motors_of(const VehicleParams& params) {
  const std::size_t count = params.airframe.rotors.size();
  if (params.motors.empty()) return std::vector<MotorParams>(count, params.motor);
  WHIRL_CHECK(params.motors.size() == count, params.motors.size(), count);
  return params.motors;
}

}  // namespace

ShaftLoad shaft_load(const RotorLoads& loads, double at_speed_radps) {
  const double torque = loads.shaft_torque_Nm;
  const bool brakes = torque * at_speed_radps > 0.0;
  if (!brakes || std::abs(at_speed_radps) < kFewTurns_radps) return {0.0, torque};
  return {torque / (at_speed_radps * std::abs(at_speed_radps)), 0.0};
}

struct Vehicle::Parts {
  Parts(const VehicleParams& vehicle, RotorSet rotor_set, std::unique_ptr<Powertrain> shafts_of,
        std::uint64_t seed)
      : params(vehicle),
        mass{vehicle.airframe.mass_kg, vehicle.airframe.inertia_kgm2},
        rotors(std::move(rotor_set)),
        powertrain(std::move(shafts_of)),
        air(vehicle.air, seed),
        contact(vehicle.airframe, vehicle.obstacles),
        load(vehicle.load ? std::optional<SlungLoad>(std::in_place, *vehicle.load, mass)
                          : std::nullopt),
        loads(rotors.size()),
        loads_at_radps(rotors.size(), 0.0),
        shaft(rotors.size()) {
    WHIRL_CHECK(rotors.size() == vehicle.airframe.rotors.size(), rotors.size(),
                vehicle.airframe.rotors.size());
    WHIRL_CHECK(rotors.size() == powertrain->count(), rotors.size(), powertrain->count());
    state.motors.resize(rotors.size());
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      rings.emplace_back(seed, "rotor" + std::to_string(i + 1) + ".vortex_ring");
    }
  }

  std::size_t count() const { return rotors.size(); }

  void load_shafts();
  void set_dip();
  Forcing run_rotors(double dt_s);
  void run_body(Forcing& forcing, double dt_s);
  void feel_motion(const BodyState& before, double dt_s);
  void strike();
  void publish_air();
  double fluctuation_mps(std::size_t i, const RotorConditions& conditions, double dt_s);
  Vector3d spin_B() const;
  Vector3d hub_W(std::size_t i) const {
    return body.p_WB_W_m + body.q_WB * params.airframe.rotors[i].p_BP_B_m;
  }

  VehicleParams params;
  MassProperties mass;
  RotorSet rotors;
  std::unique_ptr<Powertrain> powertrain;
  Air air;
  ContactWorld contact;
  std::optional<SlungLoad> load;
  // One of each for each motor:
  std::vector<RotorLoads> loads;
  std::vector<double> loads_at_radps;
  std::vector<ShaftLoad> shaft;
  std::vector<VortexRing> rings;
  std::vector<Dip> dips;
  std::vector<Push> pushes;
  std::optional<CarriedBody> carried;  // of the next step
  Vector3d spin_start_B_Nms = Vector3d::Zero();
  double viscosity_Pas = 0.0;
  BodyState body;
  VehicleState state;
};

Vector3d Vehicle::Parts::spin_B() const {
  double sum = 0.0;  // counter-clockwise seen from above is about -z
  for (std::size_t i = 0; i < count(); ++i) {
    const double share =  // of the inertia that all have
        params.motor_of(i).inertia_kgm2 / params.motor.inertia_kgm2;
    sum -= params.airframe.rotors[i].spin * powertrain->speed_radps(i) * share;
  }
  return {0.0, 0.0, params.motor.inertia_kgm2 * sum};
}

// What the powertrain has to bear from now on.
void Vehicle::Parts::load_shafts() {
  for (std::size_t i = 0; i < count(); ++i) shaft[i] = shaft_load(loads[i], loads_at_radps[i]);
  powertrain->set_loads(shaft);
  set_dip();
}

void Vehicle::Parts::set_dip() {
  double below_V = 0.0;
  for (const Dip& dip : dips) {
    if (state.t_s >= dip.start_s && state.t_s < dip.end_s) below_V += dip.below_V;
  }
  powertrain->set_dip(below_V);
}

// What the vortex ring adds to a rotor's descent; its strength goes with the thrust of the step before.
double Vehicle::Parts::fluctuation_mps(std::size_t i, const RotorConditions& c, double dt_s) {
  const double down_mps = c.v_AP_P_mps.z(), radius_m = params.airframe.rotors[i].radius_m;
  const double thrust_N = loads[i].thrust_N;
  if (!(down_mps > 0.0 && thrust_N > 0.0 && radius_m > 0.0)) return 0.0;
  const double hover_mps =
      std::sqrt(thrust_N / (2.0 * c.density_kgpm3 * std::numbers::pi * radius_m * radius_m));
  return rings[i].step({down_mps, c.v_AP_P_mps.head<2>().norm(), hover_mps}, radius_m, dt_s);
}

Forcing Vehicle::Parts::run_rotors(double dt_s) {
  Forcing sum;
  const Eigen::Matrix3d R_BW = body.q_WB.conjugate().toRotationMatrix();
  const Vector3d v_WB_B = R_BW * body.v_WB_W_mps;
  RotorConditions conditions;
  conditions.w_WP_P_radps = body.w_WB_B_radps;
  conditions.density_kgpm3 = state.air_density_kgpm3;
  conditions.viscosity_Pas = viscosity_Pas;
  for (std::size_t i = 0; i < count(); ++i) {
    const Vector3d& arm_B = params.airframe.rotors[i].p_BP_B_m;
    const Vector3d p_W = hub_W(i);
    conditions.omega_radps = state.motors[i].speed_radps;
    conditions.v_AP_P_mps = v_WB_B + body.w_WB_B_radps.cross(arm_B) - R_BW * air.wind_W_mps(p_W);
    conditions.v_AP_P_mps.z() += fluctuation_mps(i, conditions, dt_s);
    conditions.height_m = height_above_m(params.obstacles, p_W);
    loads[i] = rotors[i](conditions, dt_s);
    loads_at_radps[i] = conditions.omega_radps;
    Vector3d f_B = loads[i].f_P_N;
    f_B.head<2>() -= params.airframe.rotor_drag_spm * std::abs(loads[i].thrust_N) *
                     conditions.v_AP_P_mps.head<2>();
    sum.f_B_N += f_B;
    sum.tau_B_Nm += loads[i].tau_P_Nm + arm_B.cross(f_B);
    state.motors[i].thrust_N = loads[i].thrust_N;
    state.motors[i].shaft_torque_Nm = loads[i].shaft_torque_Nm;
    state.motors[i].coning_rad = loads[i].flap_rad.x();
    state.motors[i].flap_back_rad = loads[i].flap_rad.y();
    state.motors[i].flap_left_rad = loads[i].flap_rad.z();
  }
  const Vector3d against_B = v_WB_B - R_BW * state.wind_W_mps;
  sum.f_B_N -= 0.5 * state.air_density_kgpm3 * against_B.norm() *
               params.airframe.drag_area_m2.cwiseProduct(against_B);
  for (const Push& push : pushes) {
    if (state.t_s < push.end_s) sum.f_W_N += push.force_W_N;
  }
  return sum;
}

void Vehicle::Parts::run_body(Forcing& forcing, double dt_s) {
  forcing.spin_start_B_Nms = spin_start_B_Nms;
  forcing.spin_end_B_Nms = spin_B();
  const BodyState before = body;
  if (load) {
    load->step(body, forcing, state.air_density_kgpm3, air.wind_W_mps(load->p_W_m()), dt_s);
  }
  const bool held = carried.has_value();
  const bool may_touch = !held && contact.in_reach(body, dt_s);
  const Touch touch = may_touch ? contact.step(body, forcing, dt_s) : Touch{};
  state.contact_impulse_Ns = touch.sum_Ns;
  state.on_ground = touch.from_below_Ns > 0.0;
  state.touching = touch.sum_Ns > touch.from_below_Ns;
  if (held) {
    body = {carried->p_WB_W_m, carried->v_WB_W_mps, carried->q_WB, carried->w_WB_B_radps};
    carried.reset();
    feel_motion(before, dt_s);
  } else if (touch.sum_Ns > 0.0) {
    feel_motion(before, dt_s);
  } else {
    body = step_free(body, mass, forcing, dt_s);
    state.specific_force_B_mps2 =
        (forcing.f_B_N + body.q_WB.conjugate() * forcing.f_W_N) / mass.mass_kg;
    state.alpha_WB_B_radps2 = angular_acceleration_B(body, mass, forcing, dt_s);
  }
  spin_start_B_Nms = forcing.spin_end_B_Nms;
}

// What the sensors feel of a motion that forces alone do not tell.
void Vehicle::Parts::feel_motion(const BodyState& before, double dt_s) {
  const Vector3d a_W = (body.v_WB_W_mps - before.v_WB_W_mps) / dt_s;
  state.specific_force_B_mps2 = body.q_WB.conjugate() * (a_W - Vector3d(0.0, 0.0, kGravity_mps2));
  state.alpha_WB_B_radps2 = (body.w_WB_B_radps - before.w_WB_B_radps) / dt_s;
}

// A disc with a point in the ground or an obstacle: the propeller stops, and stays stopped.
void Vehicle::Parts::strike() {
  const Vector3d axis_W = body.q_WB * Vector3d::UnitZ();
  const double slope = std::sqrt(std::max(0.0, 1.0 - axis_W.z() * axis_W.z()));
  for (std::size_t i = 0; i < count(); ++i) {
    const double radius_m = params.airframe.rotors[i].radius_m;
    const bool struck =
        std::any_of(params.obstacles.begin(), params.obstacles.end(),
                    [&](const Obstacle& o) { return disc_enters(o, hub_W(i), axis_W, radius_m); });
    if (!struck && hub_W(i).z() + radius_m * slope <= 0.0) continue;
    powertrain->block(i);
    state.motors[i].blocked = true;
    state.motors[i].speed_radps = powertrain->speed_radps(i);
  }
}

void Vehicle::Parts::publish_air() {
  const Atmosphere here = air.at(body.p_WB_W_m);
  state.wind_W_mps = air.wind_W_mps(body.p_WB_W_m);
  state.static_pressure_Pa = here.pressure_Pa;
  state.air_temperature_K = here.temperature_K;
  state.air_density_kgpm3 = here.density_kgpm3;
  viscosity_Pas = here.viscosity_Pas;
  if (load) {
    state.load_p_W_m = load->p_W_m();
    state.load_v_W_mps = load->v_W_mps();
    state.line_tension_N = load->tension_N();
  }
  state.p_WB_W_m = body.p_WB_W_m;
  state.v_WB_W_mps = body.v_WB_W_mps;
  state.q_WB = body.q_WB;
  state.w_WB_B_radps = body.w_WB_B_radps;
}

Vehicle::Vehicle(const VehicleParams& params, RotorSet rotors, std::uint64_t seed)
    : Vehicle(params, std::move(rotors),
              std::make_unique<AveragedPowertrain>(motors_of(params), params.battery,
                                                   params.avionics_current_A),
              seed) {}

Vehicle::Vehicle(const VehicleParams& params, RotorSet rotors,
                 std::unique_ptr<Powertrain> powertrain, std::uint64_t seed)
    : parts_(std::make_unique<Parts>(params, std::move(rotors), std::move(powertrain), seed)) {
  double gear_m = 0.0;
  for (const auto& foot : params.airframe.contact.gear_B_m) gear_m = std::max(gear_m, foot.z());
  parts_->body.p_WB_W_m.z() = -gear_m - params.airframe.contact.foot_radius_m;
  parts_->state.specific_force_B_mps2.z() = -kGravity_mps2;
  if (parts_->load) parts_->load->hang(parts_->body);
  parts_->state.bus_voltage_V = parts_->powertrain->source_V();
  parts_->publish_air();
}
Vehicle::~Vehicle() = default;
Vehicle::Vehicle(Vehicle&&) noexcept = default;
Vehicle& Vehicle::operator=(Vehicle&&) noexcept = default;

void Vehicle::place(const Vector3d& p_WB_W_m, const Eigen::Quaterniond& q_WB,
                    const Vector3d& v_WB_W_mps, const Vector3d& w_WB_B_radps) {
  parts_->body = {p_WB_W_m, v_WB_W_mps, q_WB.normalized(), w_WB_B_radps};
  if (parts_->load) parts_->load->hang(parts_->body);
  // Until a step has told more, what is in the air falls.
  const bool supported = parts_->contact.in_reach(parts_->body, 1e-3);
  parts_->state.specific_force_B_mps2 = {0.0, 0.0, supported ? -kGravity_mps2 : 0.0};
  parts_->publish_air();
}

void Vehicle::set_motor_speed(int index, double speed_radps) {
  const auto i = static_cast<std::size_t>(index);
  parts_->powertrain->set_speed(i, speed_radps);
  parts_->state.motors[i].speed_radps = parts_->powertrain->speed_radps(i);
  parts_->spin_start_B_Nms = parts_->spin_B();
}

void Vehicle::carry(const CarriedBody& to) {
  WHIRL_CHECK(to.p_WB_W_m.allFinite() && to.v_WB_W_mps.allFinite() && to.w_WB_B_radps.allFinite());
  parts_->carried = to;
}

void Vehicle::command(int index, const MotorCommand& command) {
  WHIRL_CHECK(std::isfinite(command.duty), index, command.duty);
  parts_->powertrain->command(static_cast<std::size_t>(index), command);
}

void Vehicle::set_steady_wind(const Vector3d& wind) {
  parts_->air.set_steady_wind(wind);
}
void Vehicle::add_gust(const GustWindow& gust) {
  parts_->air.add_gust(gust);
}
void Vehicle::add_jet(const Jet& jet) {
  parts_->air.add_jet(jet);
}

void Vehicle::dip_supply(double below_V, double start_s, double duration_s) {
  parts_->dips.push_back({below_V, start_s, start_s + duration_s});
  parts_->set_dip();
}

void Vehicle::push(const Vector3d& force_W_N, double duration_s) {
  parts_->pushes.push_back({force_W_N, parts_->state.t_s + duration_s});
}

void Vehicle::step(double dt_s) {
  WHIRL_CHECK(dt_s > 0.0 && dt_s <= 0.005, dt_s);
  Parts& p = *parts_;
  p.air.step(p.body.p_WB_W_m, p.body.v_WB_W_mps, dt_s);
  p.powertrain->step(dt_s, p.state);
  Forcing forcing = p.run_rotors(dt_s);
  p.run_body(forcing, dt_s);
  p.strike();
  p.state.t_s += dt_s;
  p.load_shafts();
  p.publish_air();
}

const VehicleState& Vehicle::state() const {
  return parts_->state;
}

}  // namespace whirl::plant
