#include "plant/airframe/slung_load.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "plant/base/frames.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kReturn_radps = 100.0;
constexpr double kTaut_m =
    1e-4;  // of slack that still counts as taut, or round-off would rattle it
constexpr double kFloor_friction = 0.6;
const Vector3d kGravity_W_mps2(0.0, 0.0, kGravity_mps2);

}  // namespace

struct SlungLoad::End {  // where the line is fixed to the body
  Vector3d p_W_m, v_W_mps, a_W_mps2;
  Vector3d along_W;  // from there to the load, of length 1
  double length_m = 0.0;
  double mobility_pkg = 0.0;  // its acceleration along the line per newton
};

SlungLoad::SlungLoad(const SlungLoadParams& params, const MassProperties& body)
    : params_(params), body_(body) {
  WHIRL_CHECK(params.mass_kg > 0.0 && params.line_m > 0.0, params.mass_kg, params.line_m);
}

void SlungLoad::hang(const BodyState& body) {
  p_W_m_ = body.p_WB_W_m + body.q_WB * params_.attach_B_m + params_.line_m * Vector3d::UnitZ();
  p_W_m_.z() = std::min(p_W_m_.z(), 0.0);
  v_W_mps_ = p_W_m_.z() < 0.0 ? body.v_WB_W_mps : Vector3d::Zero();
  tension_N_ = 0.0;
}

double SlungLoad::tension_of(const End& end, const Vector3d& a_load_W_mps2) const {
  const double stretch_m = end.length_m - params_.line_m;
  if (stretch_m < -kTaut_m) return 0.0;
  const Vector3d v_W = v_W_mps_ - end.v_W_mps;
  const double rate_mps = end.along_W.dot(v_W);
  const double across2 = std::max(0.0, v_W.squaredNorm() - rate_mps * rate_mps);
  const double parting_mps2 =
      end.along_W.dot(a_load_W_mps2 - end.a_W_mps2) + across2 / end.length_m;
  const double wanted_mps2 =
      parting_mps2 + kReturn_radps * (2.0 * rate_mps + kReturn_radps * stretch_m);
  return std::max(0.0, wanted_mps2 / (end.mobility_pkg + 1.0 / params_.mass_kg));
}

// The floor stops it, and its friction what it does along it.
void SlungLoad::rest_on_floor(double dt_s) {
  if (p_W_m_.z() < 0.0) return;
  p_W_m_.z() = 0.0;
  v_W_mps_.z() = std::min(v_W_mps_.z(), 0.0);
  const double level_mps = v_W_mps_.head<2>().norm();
  const double lost_mps = kFloor_friction * kGravity_mps2 * dt_s;
  v_W_mps_.head<2>() *= level_mps > lost_mps ? 1.0 - lost_mps / level_mps : 0.0;
}

void SlungLoad::step(const BodyState& body, Forcing& forcing, double density_kgpm3,
                     const Vector3d& wind_W_mps, double dt_s) {
  const Eigen::Matrix3d R_WB = body.q_WB.toRotationMatrix();
  const Vector3d& r_B = params_.attach_B_m;
  const Vector3d& w_B = body.w_WB_B_radps;
  const Vector3d alpha_B = angular_acceleration_B(body, body_, forcing, dt_s);
  End end;
  end.p_W_m = body.p_WB_W_m + R_WB * r_B;
  end.v_W_mps = body.v_WB_W_mps + R_WB * w_B.cross(r_B);
  end.a_W_mps2 = kGravity_W_mps2 + (R_WB * forcing.f_B_N + forcing.f_W_N) / body_.mass_kg +
                 R_WB * (alpha_B.cross(r_B) + w_B.cross(w_B.cross(r_B)));
  // As it lies in the middle of the step: a pull along where it was would drive a swing.
  const Vector3d line_W = p_W_m_ - end.p_W_m + 0.5 * dt_s * (v_W_mps_ - end.v_W_mps);
  end.length_m = std::max(line_W.norm(), 1e-6);
  end.along_W = line_W / end.length_m;
  const Vector3d arm_B = r_B.cross(R_WB.transpose() * end.along_W);
  end.mobility_pkg = 1.0 / body_.mass_kg + arm_B.dot(arm_B.cwiseQuotient(body_.inertia_kgm2));

  const Vector3d against_W = v_W_mps_ - wind_W_mps;
  const double drag_ps =
      0.5 * density_kgpm3 * params_.drag_area_m2 * against_W.norm() / params_.mass_kg;
  // At most as much as takes away what there is: of a feather's, more would throw it back faster.
  const Vector3d a_free_W_mps2 = kGravity_W_mps2 - drag_ps / (1.0 + drag_ps * dt_s) * against_W;
  tension_N_ = tension_of(end, a_free_W_mps2);
  const Vector3d pull_W_N = tension_N_ * end.along_W;  // on the body
  forcing.f_W_N += pull_W_N;
  forcing.tau_B_Nm += r_B.cross(R_WB.transpose() * pull_W_N);

  const Vector3d a_W_mps2 = a_free_W_mps2 - pull_W_N / params_.mass_kg;
  p_W_m_ += dt_s * v_W_mps_ + 0.5 * dt_s * dt_s * a_W_mps2;
  v_W_mps_ += dt_s * a_W_mps2;
  rest_on_floor(dt_s);
}

}  // namespace whirl::plant
