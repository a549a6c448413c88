// The vehicle's own drag coefficient, out of states made here by the law of drag.
#include "harness/flight/drag_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"

namespace whirl::flight {
namespace {

using Eigen::Vector3d;

plant::AirframeParams airframe(double area_m2) {
  plant::AirframeParams params;
  params.mass_kg = 0.9;
  params.drag_area_m2 = Vector3d::Constant(area_m2);
  return params;
}

// Turned by half a right angle to the left, in a wind; the frame drags along.
plant::VehicleState state(double drag_spm, double area_m2, const Vector3d& v_AB_B_mps) {
  plant::VehicleState s;
  s.q_WB = Eigen::AngleAxisd(-M_PI / 4, Vector3d::UnitZ());
  s.wind_W_mps = {2.0, -1.0, 0.5};
  s.v_WB_W_mps = s.wind_W_mps + s.q_WB * v_AB_B_mps;
  s.air_density_kgpm3 = 1.2;
  const double thrust_mps2 = 9.5;
  s.specific_force_B_mps2 = Vector3d(-drag_spm * thrust_mps2 * v_AB_B_mps.x(),
                                     -drag_spm * thrust_mps2 * v_AB_B_mps.y(), -thrust_mps2) -
                            0.5 * 1.2 * area_m2 * v_AB_B_mps.norm() / 0.9 * v_AB_B_mps;
  return s;
}

double found_spm(double drag_spm, double area_m2) {
  DragTruth truth(airframe(area_m2));
  for (int i = 0; i < 10'000; ++i) {
    truth.step(state(drag_spm, area_m2, {std::cos(1e-3 * i), 0.5, 0.0}), 1e-3);
  }
  return truth.coefficient_spm();
}

TEST(DragTruth, IsTheRotorsCoefficientWhateverTheFrameAddsInAnyWind) {
  EXPECT_TRUE(near(found_spm(0.03, 0.0), 0.03, round_off(1000, 0.03)));
  EXPECT_TRUE(near(found_spm(0.05, 0.02), 0.05, round_off(1000, 0.05)));
}

TEST(DragTruth, IsNotKnownWithoutAirSpeedNorOnTheGround) {
  DragTruth truth(airframe(0.01));
  EXPECT_TRUE(std::isnan(truth.coefficient_spm()));
  for (int i = 0; i < 10'000; ++i) truth.step(state(0.04, 0.01, Vector3d::Zero()), 1e-3);
  EXPECT_TRUE(std::isnan(truth.coefficient_spm()));
  for (int i = 0; i < 10'000; ++i) {
    plant::VehicleState standing = state(0.04, 0.01, {1.0, 0.0, 0.0});
    standing.on_ground = true;
    truth.step(standing, 1e-3);
  }
  EXPECT_TRUE(std::isnan(truth.coefficient_spm()));
}

}  // namespace
}  // namespace whirl::flight
