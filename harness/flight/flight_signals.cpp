// The names of a flight's signals: truth of the vehicle, then what the ground station was told.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/flight/flight_world.hpp"

namespace whirl::flight {

void FlightWorld::add_signal(std::string name, Dimension dimension, std::string about,
                             std::function<double()> value) {
  signals_.push_back({std::move(name), dimension, std::move(about)});
  values_.push_back(std::move(value));
}

double FlightWorld::offset_from_target_m() const {
  if (!station_.target()) return 0.0;
  return (vehicle_.state().p_WB_W_m - station_.target()->p_W_m).head<2>().norm();
}

void FlightWorld::name_signals() {
  using D = Dimension;
  const auto state = [this]() -> const plant::VehicleState& { return vehicle_.state(); };
  add_signal("height", D::length, "of the centre of mass above the floor",
             [=] { return -state().p_WB_W_m.z(); });
  add_signal("north", D::length, "position", [=] { return state().p_WB_W_m.x(); });
  add_signal("east", D::length, "position", [=] { return state().p_WB_W_m.y(); });
  add_signal("climb", D::speed, "velocity upwards", [=] { return -state().v_WB_W_mps.z(); });
  add_signal("velocity_north", D::speed, "", [=] { return state().v_WB_W_mps.x(); });
  add_signal("velocity_east", D::speed, "", [=] { return state().v_WB_W_mps.y(); });
  const auto euler = [=] { return roll_pitch_yaw_rad(state().q_WB); };
  add_signal("roll", D::angle, "", [=] { return euler().x(); });
  add_signal("pitch", D::angle, "", [=] { return euler().y(); });
  add_signal("yaw", D::angle, "from north towards east", [=] { return euler().z(); });
  add_signal("tilt", D::angle, "between the body's z and the vertical", [=] {
    return std::acos(std::clamp(state().q_WB.toRotationMatrix()(2, 2), -1.0, 1.0));
  });
  add_signal("rate_x", D::angular_rate, "", [=] { return state().w_WB_B_radps.x(); });
  add_signal("rate_y", D::angular_rate, "", [=] { return state().w_WB_B_radps.y(); });
  add_signal("rate_z", D::angular_rate, "", [=] { return state().w_WB_B_radps.z(); });
  add_signal("offset", D::length, "horizontal distance from the commanded position",
             [this] { return offset_from_target_m(); });
  add_signal("path_error", D::length, "distance from the commanded place, which may move",
             [this, state] {
               const auto& target = station_.target();
               return target ? (state().p_WB_W_m - target->p_W_m).norm() : 0.0;
             });
  add_signal("waypoint", D::none, "how many of { waypoints = ... } were reached and held",
             [this] { return waypoints_ ? waypoints_->reached() : 0.0; });
  add_signal("bus_voltage", D::voltage, "at the ESCs", [=] { return state().bus_voltage_V; });
  add_signal("battery_current", D::current, "", [=] { return state().battery_current_A; });
  add_signal("charge_used", D::charge, "", [=] { return state().charge_used_C; });
  add_signal("wind_north", D::speed, "of the air", [=] { return state().wind_W_mps.x(); });
  add_signal("wind_east", D::speed, "of the air", [=] { return state().wind_W_mps.y(); });
  add_signal("wind_down", D::speed, "of the air", [=] { return state().wind_W_mps.z(); });
  add_signal("on_ground", D::none, "1: something holds it from below",
             [=] { return state().on_ground ? 1.0 : 0.0; });
  add_signal("touching", D::none, "1: a wall, a ceiling or the side of a box touches it",
             [=] { return state().touching ? 1.0 : 0.0; });
  add_signal("capture_poses", D::none, "that the capture system has passed on to the radio so far",
             [this] { return static_cast<double>(capture_.passed_on()); });
  name_fence_signals();
  if (has_load_) name_load_signals();
  name_motor_signals();
  if (far_) name_exchange_signals();
  name_telemetry_signals();
  name_estimate_signals();
  name_receiver_signals();
  name_sensor_signals();
}

void FlightWorld::name_load_signals() {
  using D = Dimension;
  const auto state = [this]() -> const plant::VehicleState& { return vehicle_.state(); };
  add_signal("load_height", D::length, "of the slung load above the floor",
             [=] { return -state().load_p_W_m.z(); });
  add_signal("load_north", D::length, "position", [=] { return state().load_p_W_m.x(); });
  add_signal("load_east", D::length, "position", [=] { return state().load_p_W_m.y(); });
  add_signal("load_speed", D::speed, "", [=] { return state().load_v_W_mps.norm(); });
  add_signal("line_tension", D::force, "", [=] { return state().line_tension_N; });
}

void FlightWorld::name_fence_signals() {
  if (!place_.fence) return;
  const auto margin_m = [this] { return place_.fence->margin_m(vehicle_.state().p_WB_W_m); };
  add_signal("inside_fence", Dimension::none, "1: it is",
             [=] { return margin_m() >= 0.0 ? 1.0 : 0.0; });
  add_signal("fence_margin", Dimension::length,
             "to the nearest face of the fence; negative outside", margin_m);
}

void FlightWorld::name_motor_signals() {
  using D = Dimension;
  for (std::size_t i = 0; i < airframe_.rotors.size(); ++i) {
    const std::string n = "_" + std::to_string(i + 1);
    const auto motor = [this, i]() -> const plant::MotorState& {
      return vehicle_.state().motors[i];
    };
    add_signal("thrust" + n, D::force, "", [=] { return motor().thrust_N; });
    add_signal("speed" + n, D::angular_rate, "negative: the air turns it backward",
               [=] { return motor().speed_radps; });
    add_signal("winding_current" + n, D::current, "largest magnitude in the step",
               [=] { return motor().winding_peak_A; });
    add_signal("bus_current" + n, D::current, "mean over the step",
               [=] { return motor().bus_current_A; });
    add_signal("flapping_cone" + n, D::angle, "mean of a turn, the tips up",
               [=] { return motor().coning_rad; });
    add_signal("flapping_back" + n, D::angle, "the disc's tilt: up ahead, down behind",
               [=] { return motor().flap_back_rad; });
    add_signal("flapping_left" + n, D::angle, "the disc's tilt: up on the right, down on the left",
               [=] { return motor().flap_left_rad; });
    if (!far_) name_controller_signals(i);
  }
}

void FlightWorld::name_controller_signals(std::size_t motor) {
  const std::string n = "_" + std::to_string(motor + 1);
  const MotorController& controller = *controllers_[motor];
  add_signal("esc_armed" + n, Dimension::none, "",
             [&controller] { return controller.armed() ? 1.0 : 0.0; });
  for (MotorController::NamedValue& named : controller.signals()) {
    add_signal(named.signal.name + n, named.signal.dimension, named.signal.about,
               std::move(named.value));
  }
}

void FlightWorld::name_exchange_signals() {
  add_signal("exchange_share", Dimension::ratio,
             "of the pack's energy so far: lost or gained between it and the boards' power stages",
             [this] { return far_->exchange_share(); });
  add_signal("exchange_of_bound", Dimension::ratio,
             "the same, of what the currents' changes from step to step can make it at most",
             [this] { return far_->exchange_of_bound(); });
  add_signal("stage_gap_share", Dimension::ratio,
             "of the pack's energy so far: what the power stages' own books do not name",
             [this] { return far_->gap_share(); });
}

void FlightWorld::name_telemetry_signals() {
  using D = Dimension;
  const auto reported = [this] { return station_.telemetry(now_ns_); };
  add_signal("setpoints_refused", D::none, "so far, by all ESCs: wrong length or CRC",
             [this] { return static_cast<double>(setpoints_refused_); });
  add_signal("told_state", D::none, "HEARTBEAT custom_mode", [=] { return reported().state; });
  add_signal("told_armed", D::none, "HEARTBEAT base_mode", [=] { return reported().armed; });
  add_signal("told_height", D::length, "", [=] { return reported().height_m; });
  add_signal("told_north", D::length, "", [=] { return reported().north_m; });
  add_signal("told_east", D::length, "", [=] { return reported().east_m; });
  add_signal("told_tilt", D::angle, "", [=] { return reported().tilt_rad; });
  add_signal("told_voltage", D::voltage, "", [=] { return reported().voltage_V; });
  add_signal("told_current", D::current, "", [=] { return reported().current_A; });
  add_signal("told_load", D::ratio, "processor load", [=] { return reported().load; });
  add_signal("told_logging", D::none, "1: SYS_STATUS says that it logs, or can",
             [=] { return reported().logging; });
  add_signal("told_ready", D::none, "1: its heartbeat says that it can be armed",
             [=] { return reported().ready; });
  add_signal("heartbeat_age", D::time, "", [=] { return reported().heartbeat_age_s; });
  add_signal("command_result", D::none, "of the last COMMAND_ACK; -1 waiting for it, -2 never came",
             [this] { return static_cast<double>(station_.last_result()); });
  add_signal("command_pending", D::none, "1: a command waits for its answer",
             [this] { return station_.command_pending() ? 1.0 : 0.0; });
  add_signal("parameter_result", D::none,
             "of the last { parameter = ... }: 0 holds, 2 refused, -1 waiting, -2 never answered",
             [this] { return static_cast<double>(station_.parameters().last_result()); });
  add_signal("parameter_value", D::none, "in that answer",
             [this] { return station_.parameters().last_value(); });
  add_signal("parameter_pending", D::none, "1: a parameter waits for its answer",
             [this] { return station_.parameters().pending() ? 1.0 : 0.0; });
}

void FlightWorld::name_receiver_signals() {
  const auto length = [this](const char* name, const char* about, std::function<double()> value) {
    add_signal(name, Dimension::length, about, std::move(value));
  };
  const char* error = "of the GPS receiver, in W";
  const char* shown = "where the receiver sees it, in the frame of GPS_GLOBAL_ORIGIN";
  length("gps_error_north", error, [this] { return receiver_.error_W_m().x(); });
  length("gps_error_east", error, [this] { return receiver_.error_W_m().y(); });
  length("gps_error_down", error, [this] { return receiver_.error_W_m().z(); });
  add_signal("gps_period", Dimension::time, "between the GPS receiver's two newest measurements",
             [this] { return receiver_.period_s(); });
  const auto seen_m = [this] { return receiver_.place_m(vehicle_.state().p_WB_W_m); };
  length("receiver_north", shown, [=] { return seen_m().x(); });
  length("receiver_east", shown, [=] { return seen_m().y(); });
  length("receiver_height", shown, [=] { return -seen_m().z(); });
}

void FlightWorld::name_estimate_signals() {
  using D = Dimension;
  const auto told = [this]() -> const Told& { return estimates_.told(); };
  add_signal("attitude_error", D::angle, "of the attitude that is flown by",
             [=] { return told().attitude_error_rad; });
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string n = "_" + std::to_string(i + 1);
    add_signal("attitude_error" + n, D::angle, "of the velocity-aided filter" + n,
               [=] { return told().filter_error_rad[i]; });
    add_signal("told_scale" + n, D::none, "latent scale of the filter" + n,
               [=] { return told().scale[i]; });
  }
  const char* axes[] = {"x", "y", "z"};
  const char* ways[] = {"north", "east", "down"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    add_signal(std::string("told_air_velocity_") + axes[i], D::speed, "through the air, in B",
               [=] { return told().v_AB_B_mps[i]; });
    add_signal(std::string("air_velocity_error_") + axes[i], D::speed, "",
               [=] { return told().v_AB_error_B_mps[i]; });
    add_signal(std::string("velocity_error_") + ways[i], D::speed, "over ground, as flown by",
               [=] { return told().v_WB_error_W_mps[i]; });
    add_signal(std::string("told_wind_") + ways[i], D::speed, "",
               [=] { return told().wind_W_mps[i]; });
    add_signal(std::string("wind_error_") + ways[i], D::speed, "",
               [=] { return told().wind_error_W_mps[i]; });
  }
  add_signal("drag_s_per_m", D::none,
             "of the plant's forces in the last 20 s, over thrust and air speed",
             [this] { return drag_truth_.coefficient_spm(); });
  add_signal("told_drag_s_per_m", D::none, "as identified", [=] { return told().drag_spm; });
  add_signal("told_drag_sigma_s_per_m", D::none, "its standard deviation, as told",
             [=] { return told().drag_sigma_spm; });
  add_signal("told_velocity_source", D::none, "0 none, 1 motion capture, 2 drag, 3 GPS",
             [=] { return told().velocity_source; });
  add_signal("told_baro_height", D::length, "by the barometer",
             [=] { return told().baro_height_m; });
  add_signal("baro_height_error", D::length, "", [=] { return told().baro_height_error_m; });
  add_signal("told_baro_climb", D::speed, "", [=] { return told().baro_climb_mps; });
  add_signal("baro_climb_error", D::speed, "", [=] { return told().baro_climb_error_mps; });
}

// ---- In a line

std::string FlightWorld::status() const {
  const Telemetry reported = station_.telemetry(now_ns_);
  const plant::VehicleState& s = vehicle_.state();
  const char* state = s.on_ground ? "on the ground" : "in the air";
  if (!(reported.frames > 0)) state = "silent";
  char text[80];
  std::snprintf(text, sizeof text, "%s, %.2f m", state, -s.p_WB_W_m.z());
  return text;
}

}  // namespace whirl::flight
