#include "harness/flight/drag_truth.hpp"

#include <cmath>
#include <limits>

namespace whirl::flight {
namespace {

constexpr double kWindow_s = 20.0;
constexpr double kLeast = 2.0 * 9.8 * 9.8;  // (m/s)^2 s, times the thrust per mass squared

}  // namespace

void DragTruth::step(const plant::VehicleState& truth, double dt_s) {
  const double keep = std::exp(-dt_s / kWindow_s);
  force_speed_ *= keep;
  speed2_ *= keep;
  if (truth.on_ground || truth.touching) return;
  const Eigen::Vector3d v_AB_B = truth.q_WB.conjugate() * (truth.v_WB_W_mps - truth.wind_W_mps);
  const double frame_ps = 0.5 * truth.air_density_kgpm3 * v_AB_B.norm() / airframe_.mass_kg;
  const Eigen::Vector3d f =
      truth.specific_force_B_mps2 + frame_ps * airframe_.drag_area_m2.cwiseProduct(v_AB_B);
  const Eigen::Vector2d thrust_speed = -f.z() * v_AB_B.head<2>();
  force_speed_ -= dt_s * f.head<2>().dot(thrust_speed);
  speed2_ += dt_s * thrust_speed.squaredNorm();
}

double DragTruth::coefficient_spm() const {
  if (!(speed2_ >= kLeast)) return std::numeric_limits<double>::quiet_NaN();
  return force_speed_ / speed2_;
}

}  // namespace whirl::flight
