// A flight with a pilot of ten lines in the firmware's place: he reads truth and writes set-points at
// 50 Hz, as the flight image does through its buses.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "harness/catalogue/vehicle_file.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/tests/milliseconds.hpp"
#include "harness/flight/tests/paths.hpp"
#include "harness/lua/table.hpp"
#include "harness/plan/requests.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::flight {

inline FlightParams hp_quad_file() {
  auto params =
      catalogue::read_vehicle(std::string(kSourceFolder) + "/test_plans/vehicles/hp_quad.lua");
  EXPECT_TRUE(params.ok()) << (params.ok() ? "" : params.error().message());
  return params.value();
}

inline lua::Table table(const std::string& text) {
  return lua::read_text("return " + text, "plan.lua").value();
}

struct Flight {
  FlightWorld world;
  io::Batch happened, sensed;
  std::int64_t t_ns = 0;
  double height_m = 0.0;  // wanted; 0: motors stopped
  double height_integral_N = 0.0;

  explicit Flight(const FlightParams& params = hp_quad_file()) : world(params, 1) {
    world.step(0, happened, sensed);
  }

  double value(const std::string& name) const {
    const auto& signals = world.signals();
    std::vector<double> values(signals.size());
    world.read(values);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (signals[i].name == name) return values[i];
    }
    ADD_FAILURE() << "no signal " << name;
    return std::nan("");
  }
  // T from the height, torques from position and attitude; geometry as in the vehicle file.
  std::array<double, 4> pilot() {
    const plant::VehicleState& s = world.truth();
    const Eigen::Vector3d rpy = roll_pitch_yaw_rad(s.q_WB);
    const double error = height_m + s.p_WB_W_m.z();
    height_integral_N = std::clamp(height_integral_N + 0.05 * error, -2.0, 2.0);
    const double T = 0.9 * 9.81 + 6.0 * error + 5.0 * s.v_WB_W_mps.z() + height_integral_N;
    const auto tilt = [](double x, double v) {
      return std::clamp(0.08 * x + 0.12 * v, -0.25, 0.25);
    };
    const double roll = -tilt(s.p_WB_W_m.y(), s.v_WB_W_mps.y());
    const double pitch = tilt(s.p_WB_W_m.x(), s.v_WB_W_mps.x());
    const double tau_x = 0.35 * (roll - rpy.x()) - 0.10 * s.w_WB_B_radps.x();
    const double tau_y = 0.35 * (pitch - rpy.y()) - 0.10 * s.w_WB_B_radps.y();
    const double yaw = -0.3 * rpy.z() - 1.0 * s.w_WB_B_radps.z();  // in newtons of each pair
    const double x = tau_y / 0.25 / 2, y = tau_x / 0.25 / 2;
    return {T / 4 + x + yaw, T / 4 - y - yaw, T / 4 - x + yaw, T / 4 + y - yaw};
  }
  void step() {
    happened.clear();
    sensed.clear();
    if (t_ns / kMs % 20 == 0) {
      const auto wanted = pilot();
      for (std::uint16_t m = 1; m <= 4; ++m) {
        const std::uint16_t v =
            height_m > 0.0 ? io::setpoint_of_value(io::EscMode::thrust_by_rpm, wanted[m - 1u]) : 0;
        happened.add(io::Kind::esc_setpoint, m, t_ns, io::EscSetpoint{v, 1, {}, t_ns});
      }
    }
    t_ns += kMs;
    world.step(t_ns, happened, sensed);
  }
  void run(double seconds) {
    for (int i = 0; i < std::lround(seconds * 1000.0); ++i) step();
  }
};

}  // namespace whirl::flight
