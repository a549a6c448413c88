// The rotor as the ESC believes in it: thrust and aerodynamic power coefficients over the stream's
// inflow ratio, and the inverse, from measured power to thrust (Algorithm 1).
//
//   Units   CT in N/(rad/s)^2, CP in W/(rad/s)^3; inflow ratios are speed/(w R), with the R that
//           c0..c4 were identified with
//   Model   CT = c1 (c2 - lambda), lambda = li + ls; CT = c4 li lambda; kappa = d0 + d1 CT;
//           CP = c3 + CT (kappa li + ls) c0               [Bangura 2017, eq. 4.64, 5.8 to 5.11]
//   Method  the secant of Algorithm 1 between two nodes of a table, which hold the solution from the
//           start: at most kMaxIterations evaluations of the model, from any state
//   Valid   axial flow with the stream going down through the disc (lambda > 0), mu^2 << 1.
//   Error   the inverse of the forward model to 1e-3 relative in thrust (tests/thrust_model_test.cpp)
//   Left out vortex ring and windmill: reported as not observable or outside the model, never guessed
#pragma once
#include <array>
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
  float slope = 0.0f;           // dCP/dls around the solution: what a watt can tell about inflow
  float leverage = 0.0f;        // relative change of thrust over relative change of power there
};

class ThrustSolver {
 public:
  struct Bounds {
    float ls_min = -0.008f;  // half a metre per second up: momentum theory still holds
    float ls_max = 0.16f;
    float tolerance = 1e-4f;     // of CP, relative
    float most_leverage = 5.0f;  // beyond, half a percent of power is over two of thrust
  };
  static constexpr int kMaxIterations = 6;

  ThrustSolver(const ThrustModel& model, const Bounds& bounds);
  explicit ThrustSolver(const ThrustModel& model) : ThrustSolver(model, Bounds{}) {}

  // One call per control period; keeps the solution as the next start. CP_measured in W/(rad/s)^3.
  ThrustEstimate solve(float CP_measured);
  void restart() { ls_ = CP_solved_ = 0.0f; }

  // Power falls with inflow from here on, and rises (or is undefined) before: where two inflows meet.
  float turning_inflow() const { return node_ls(turn_); }

 private:
  static constexpr int kCells = 16;

  float node_ls(int i) const {
    return bounds_.ls_min + (bounds_.ls_max - bounds_.ls_min) * static_cast<float>(i) / kCells;
  }
  bool shared_by_two(float CP) const { return turn_ > first_ && CP >= CP_[first_]; }
  ThrustEstimate search(int cell, float CP_measured);

  ThrustModel model_;
  Bounds bounds_;
  std::array<float, kCells + 1> CP_{}, CT_{};       // at the nodes
  std::array<float, kCells> slope_{}, leverage_{};  // of the cells behind them
  std::uint8_t first_ = 0;                          // lowest node with a real solution
  std::uint8_t turn_ = 0;                           // node with the largest CP
  std::uint8_t last_ = 0;                           // CP falls from turn_ to here
  float ls_ = 0.0f, CP_solved_ = 0.0f;              // the last solution
};

}  // namespace fw::esc
