// Tumbling against Jacobi's elliptic functions, bouncing against restitution.
#include <algorithm>
#include <cmath>

#include "plant/airframe/contact_world.hpp"
#include "plant/base/frames.hpp"
#include "plant/validation/validation.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

using Eigen::Vector3d;

constexpr double kFlightStep_s = 1e-3;

struct Jacobi {
  double sn, cn, dn;
};

Jacobi jacobi(double u, double k2) {  // by the arithmetic-geometric mean
  double a[12] = {1.0}, c[12] = {std::sqrt(k2)}, b = std::sqrt(1.0 - k2);
  int n = 0;
  for (; std::abs(c[n]) > 1e-16 && n < 11; ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, n);
  for (int i = n; i > 0; --i) phi = 0.5 * (phi + std::asin(c[i] / a[i] * std::sin(phi)));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1.0 - k2 * sn * sn)};
}

Proof tumbling() {
  const MassProperties m{0.9, {0.010, 0.016, 0.022}};
  const Vector3d I = m.inertia_kgm2, w0(6.0, 0.0, 8.0);
  const double E2 = I.dot(w0.cwiseAbs2()), M2 = I.cwiseProduct(w0).squaredNorm();
  const double k2 = (I[1] - I[0]) * (E2 * I[2] - M2) / ((I[2] - I[1]) * (M2 - E2 * I[0]));
  const double rate = std::sqrt((I[2] - I[1]) * (M2 - E2 * I[0]) / I.prod());
  const double size2 = std::sqrt((E2 * I[2] - M2) / (I[1] * (I[2] - I[1])));
  BodyState s;
  s.w_WB_B_radps = w0;
  const Vector3d L0 = angular_momentum_W(s, m, Vector3d::Zero());
  Curve model{"w_y", {}, {}}, exact{"w_y, Jacobi", {}, {}};
  double off = 0.0, energy = 0.0, momentum = 0.0;
  for (int k = 1; k <= 10000; ++k) {
    s = step_free(s, m, {}, kFlightStep_s);
    const Jacobi f = jacobi(rate * k * kFlightStep_s, k2);
    const Vector3d want(w0.x() * f.cn, size2 * f.sn, w0.z() * f.dn);
    off = std::max(off, (s.w_WB_B_radps - want).norm() / w0.norm());
    energy = std::max(energy, std::abs(I.dot(s.w_WB_B_radps.cwiseAbs2()) / E2 - 1.0));
    momentum =
        std::max(momentum, (angular_momentum_W(s, m, Vector3d::Zero()) - L0).norm() / L0.norm());
    if (k % 10 || k > 3000) continue;
    model.x.push_back(k * kFlightStep_s), model.y.push_back(s.w_WB_B_radps.y());
    exact.x.push_back(k * kFlightStep_s), exact.y.push_back(want.y());
  }
  return {.title = "Torque-free tumbling of an asymmetric body, 10 s at 1 ms",
          .x_label = "time / s",
          .y_label = "rate / rad/s",
          .source = "Landau1976, section 37",
          .model = {model},
          .reference = {exact},
          .figures = {{"worst rate against the analytic one", off, 1e-6, "relative"},
                      {"worst energy", energy, 1e-6, "relative"},
                      {"worst momentum", momentum, 1e-6, "relative"}}};
}

Proof dropping() {
  const AirframeParams frame = hp_quad().airframe;
  const MassProperties m{frame.mass_kg, frame.inertia_kgm2};
  constexpr double kGear_m = 0.11, kDrop_m = 1.0;
  BodyState s;
  s.p_WB_W_m.z() = -kGear_m - kDrop_m;
  ContactWorld ground(frame);
  Curve model{"height of the feet", {}, {}};
  double top = 0.0, fastest = 0.0;
  bool touched = false;
  for (int k = 1; k <= 4000; ++k) {
    const double impulse =
        ground.in_reach(s, kFlightStep_s) ? ground.step(s, {}, kFlightStep_s).sum_Ns : 0.0;
    if (impulse == 0.0) s = step_free(s, m, {}, kFlightStep_s);
    touched |= impulse > 0.0;
    if (touched) top = std::max(top, -kGear_m - s.p_WB_W_m.z());
    if (k > 3000) fastest = std::max(fastest, s.v_WB_W_mps.norm() + s.w_WB_B_radps.norm());
    if (k % 10 == 0) {
      model.x.push_back(k * kFlightStep_s);
      model.y.push_back(-kGear_m - s.p_WB_W_m.z());
    }
  }
  const double e = frame.contact.restitution, want = e * e * kDrop_m;
  return {.title = "Vehicle dropped from 1 m on its gear",
          .x_label = "time / s",
          .y_label = "height / m",
          .source = "closed form: e^2 h",
          .model = {model},
          .reference = {{"e^2 h", {0.45, 1.0}, {want, want}}},
          .figures = {{"first bounce", 100.0 * (top / want - 1.0), 5.0, "%"},
                      {"speed at rest, m/s + rad/s", fastest, 1e-6, ""}}};
}

}  // namespace

std::vector<Proof> airframe_proofs() {
  return {tumbling(), dropping()};
}

}  // namespace whirl::plant
