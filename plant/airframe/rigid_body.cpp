#include "plant/airframe/rigid_body.hpp"

#include <cmath>

#include "plant/base/frames.hpp"

namespace whirl::plant {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond exponential(const Vector3d& turn) {
  const double half = 0.5 * turn.norm();
  // sin(x)/x by its series near 0, where the quotient would be 0/0.
  const double ratio = half < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  Quaterniond q;
  q.w() = std::cos(half);
  q.vec() = 0.5 * ratio * turn;
  return q;
}

// Inverse of the differential of the exponential, for q = q0 exp(u) and body rates w.
Vector3d turn_rate(const Vector3d& u, const Vector3d& w) {
  const Vector3d u_x_w = u.cross(w);
  return w + 0.5 * u_x_w + u.cross(u_x_w) / 12.0;
}

struct Slope {
  Vector3d turn, momentum;
};

}  // namespace

Vector3d angular_momentum_W(const BodyState& s, const MassProperties& body,
                            const Vector3d& spin_B_Nms) {
  return s.q_WB * (body.inertia_kgm2.cwiseProduct(s.w_WB_B_radps) + spin_B_Nms);
}

Vector3d angular_acceleration_B(const BodyState& s, const MassProperties& body, const Forcing& f,
                                double dt_s) {
  const Vector3d momentum_B = body.inertia_kgm2.cwiseProduct(s.w_WB_B_radps) + f.spin_end_B_Nms;
  const Vector3d spin_up = (f.spin_end_B_Nms - f.spin_start_B_Nms) / dt_s;
  return (f.tau_B_Nm - s.w_WB_B_radps.cross(momentum_B) - spin_up).cwiseQuotient(body.inertia_kgm2);
}

BodyState step_free(const BodyState& s, const MassProperties& body, const Forcing& f, double dt_s) {
  const Vector3d L0 = angular_momentum_W(s, body, f.spin_start_B_Nms);
  const Vector3d spin_gain = f.spin_end_B_Nms - f.spin_start_B_Nms;
  auto rates = [&](const Quaterniond& q, const Vector3d& L, double part) -> Vector3d {
    const Vector3d momentum_B = q.conjugate() * L - f.spin_start_B_Nms - part * spin_gain;
    return momentum_B.cwiseQuotient(body.inertia_kgm2);
  };
  auto slope = [&](const Vector3d& u, const Vector3d& L, double part) -> Slope {
    const Quaterniond q = s.q_WB * exponential(u);
    return {turn_rate(u, rates(q, L, part)), q * f.tau_B_Nm};
  };
  const double h = dt_s;
  const Slope k1 = slope(Vector3d::Zero(), L0, 0.0);
  const Slope k2 = slope(0.5 * h * k1.turn, L0 + 0.5 * h * k1.momentum, 0.5);
  const Slope k3 = slope(0.5 * h * k2.turn, L0 + 0.5 * h * k2.momentum, 0.5);
  const Slope k4 = slope(h * k3.turn, L0 + h * k3.momentum, 1.0);
  const Vector3d u = h / 6.0 * (k1.turn + 2.0 * k2.turn + 2.0 * k3.turn + k4.turn);
  const Vector3d L1 =
      L0 + h / 6.0 * (k1.momentum + 2.0 * k2.momentum + 2.0 * k3.momentum + k4.momentum);

  BodyState next;
  next.q_WB = (s.q_WB * exponential(u)).normalized();
  next.w_WB_B_radps = rates(next.q_WB, L1, 1.0);
  const Quaterniond middle = s.q_WB * exponential(0.5 * u);
  const Vector3d a =
      (middle * f.f_B_N + f.f_W_N) / body.mass_kg + Vector3d(0.0, 0.0, kGravity_mps2);
  next.v_WB_W_mps = s.v_WB_W_mps + h * a;
  next.p_WB_W_m = s.p_WB_W_m + h * (s.v_WB_W_mps + 0.5 * h * a);
  return next;
}

}  // namespace whirl::plant
