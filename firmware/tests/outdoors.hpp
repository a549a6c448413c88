// Flight outdoors around the rigid body of vehicle_model.hpp, for tests.
#pragma once
#include <gtest/gtest.h>

#include <deque>

#include "firmware/tests/gps_model.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw::test {

// The model outdoors: 5 Hz of GPS, 110 ms late, with an error that a test sets.
struct Outdoors {
  explicit Outdoors(double yaw_rad = 0.0) : vehicle({}) {
    vehicle.capture_on_ = false;
    vehicle.q_WB_ = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  }
  void run(double seconds) {
    for (long i = std::lround(1000 * seconds); i > 0; --i, ++ms) step();
  }
  void step() {
    vehicle.step(flight);
    if (ms % 200 == 0 && gps_on) {
      GpsSolution s = solution_at(vehicle.p_W_ + p_error_m, vehicle.v_W_ + v_error_mps);
      s.fix_type = fix_type;
      s.level_accuracy_m = accuracy_m;
      if (stuck) s = last;
      last = s;
      on_the_way.push_back({ms + 110, s});
    }
    p_error_m += 1e-3 * drift_mps;
    if (!on_the_way.empty() && on_the_way.front().due_ms <= ms) {
      flight.on_gps(on_the_way.front().solution);
      on_the_way.pop_front();
    }
  }
  // From power-up into a hover at 6 m.
  void hover() {
    run(12.0);
    ASSERT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
    run(1.0);
    ASSERT_EQ(flight.take_off(6.0f), Reason::none);
    run(25.0);
  }
  struct Due {
    int due_ms;
    GpsSolution solution;
  };
  Flight flight;
  VehicleModel vehicle;
  Eigen::Vector3d p_error_m{0, 0, 0}, v_error_mps{0, 0, 0}, drift_mps{0, 0, 0};
  bool gps_on = true, stuck = false;
  GpsSolution last;
  std::uint8_t fix_type = 3;
  float accuracy_m = 3.0f;
  std::deque<Due> on_the_way;
  int ms = 0;
};

}  // namespace fw::test
