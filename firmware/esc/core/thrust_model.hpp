// The rotor as the ESC believes in it: thrust and aerodynamic power coefficients over the stream's
// inflow ratio, and the inverse, from measured power to thrust (Algorithm 1).
//
//   Units   CT in N/(rad/s)^2, CP in W/(rad/s)^3; inflow ratios are speed/(w R), with the R that
//           c0..c4 were identified with
//   Model   CT = c1 (c2 - lambda), lambda = li + ls; CT = c4 li lambda; kappa = d0 + d1 CT;
//           CP = c3 + CT (kappa li + ls) c0               [Bangura 2017, eq. 4.64, 5.8 to 5.11]
//   Valid   axial flow with the stream going down through the disc (lambda > 0), mu^2 << 1.
//   Error   the inverse of the forward model to 1e-3 relative in thrust (tests/thrust_model_test.cpp)
//   Left out  vortex ring and windmill: reported as not observable or outside the model, never guessed
#pragma once
#include <cstdint>

namespace fw::esc {

struct ThrustModel {
  float c0, c1, c2, c3, c4, d0, d1;
};

struct RotorPoint {
  float CT = 0.0f;
  float CP = 0.0f;
  float li = 0.0f;
  float kappa = 0.0f;
  bool real = false;  // false: momentum theory knows no flow through the disc here
};

RotorPoint at_inflow(const ThrustModel& model, float ls);

enum class Estimate : std::uint8_t {
  converged,
  not_observable,  // two inflows share this power, or power hardly changes with inflow here
  out_of_model,    // no inflow within the bounds gives this power
  no_convergence,  // the iteration limit was reached
};

struct ThrustEstimate {
  Estimate status = Estimate::out_of_model;
  std::uint8_t iterations = 0;  // evaluations of the forward model
  float CT = 0.0f;              // valid if converged
  float ls = 0.0f;              // valid if converged
  float slope = 0.0f;           // dCP/dls at the solution: what a watt can tell about inflow
};

class ThrustSolver {
 public:
  struct Bounds {
    float ls_min = -0.02f;
    float ls_max = 0.16f;
    float start_distance = 0.004f;  // Delta: between the two starts
    float tolerance = 2e-4f;        // of CP, relative
    float flat = 0.05f;             // |dCP/dls| under flat * CP / (ls_max - ls_min) decides nothing
  };
  static constexpr int kMaxIterations = 20;

  ThrustSolver(const ThrustModel& model, const Bounds& bounds);
  explicit ThrustSolver(const ThrustModel& model) : ThrustSolver(model, Bounds{}) {}

  // One call per control period; keeps the solution as the next start. CP_measured in W/(rad/s)^3.
  ThrustEstimate solve(float CP_measured);
  void restart(float ls = 0.0f) { ls_ = ls; }

  // Power falls with inflow from here on, and rises (or is undefined) before: where two inflows meet.
  float turning_inflow() const { return ls_turn_; }

 private:
  bool shared_by_two(float CP) const { return CP >= CP_first_ && ls_turn_ > ls_first_; }

  ThrustModel model_;
  Bounds bounds_;
  float ls_first_;  // lowest inflow with a real solution
  float CP_first_;
  float ls_turn_;
  float CP_turn_;
  float CP_last_;
  float ls_ = 0.0f;
};

}  // namespace fw::esc
