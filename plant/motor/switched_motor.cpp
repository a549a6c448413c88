#include "plant/motor/switched_motor.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/check.hpp"

namespace whirl::plant {
namespace {

constexpr double kMostTurn_rad = 2.0 * kPi / 180.0;
constexpr double kMostStep_s = 1e-5;
// Sinusoidal phases: amplitude that gives the same mean line-to-line EMF over a 60 degree sector.
constexpr double kSineShare = kPi / (3.0 * 1.7320508075688772);

// The first turns on both sides as fmod() has them, to the bit, in a tenth of its time.
double wrapped(double angle) {
  if (angle >= 0.0 && angle < 2.0 * kPi) return angle;
  if (angle < 0.0 && angle > -2.0 * kPi) return angle + 2.0 * kPi;
  if (angle >= 0.0 && angle < 4.0 * kPi) return angle - 2.0 * kPi;
  angle = std::fmod(angle, 2.0 * kPi);
  return angle < 0.0 ? angle + 2.0 * kPi : angle;
}

// Flat over 120 degrees, straight over 60; rises through zero at 0.
double trapezoid(double angle) {
  const double x = wrapped(angle) / (kPi / 6.0);  // in twelfths of a turn
  if (x < 1.0) return x;
  if (x < 5.0) return 1.0;
  if (x < 7.0) return 6.0 - x;
  if (x < 11.0) return -1.0;
  return x - 12.0;
}

}  // namespace

Bridge six_step(int sector, bool pwm_on, bool synchronous) {
  constexpr int kHigh[] = {0, 0, 1, 1, 2, 2}, kLow[] = {1, 2, 2, 0, 0, 1};
  Bridge bridge{.pwm_on = pwm_on, .synchronous = synchronous};
  bridge.leg[kHigh[sector]] = Leg::pwm;
  bridge.leg[kLow[sector]] = Leg::low;
  return bridge;
}

int sector_of(double angle_rad) {
  return static_cast<int>(wrapped(angle_rad - kPi / 6.0) / (kPi / 3.0)) % 6;
}

// Which terminals are tied to what, and where the star point lies.
struct SwitchedMotor::Circuit {
  std::array<double, 3> terminal_V{}, emf_Vspr{}, emf_V{};
  std::array<double, 3> admittance;  // of each phase, relative
  std::array<bool, 3> tied{}, diode{}, to_bus{};
  double star_V = 0.0;
  int count = 0;
  void find_star() {
    count = 0;
    double sum = 0.0, weights = 0.0;
    for (int k = 0; k < 3; ++k) {
      if (!tied[k]) continue;
      sum += (terminal_V[k] - emf_V[k]) * admittance[k];
      weights += admittance[k];
      ++count;
    }
    if (count > 0) star_V = sum / weights;
  }
  void tie(int k, double volts, bool bus, bool through_diode) {
    tied[k] = true;
    terminal_V[k] = volts;
    to_bus[k] = bus;
    diode[k] = through_diode;
  }
};

SwitchedMotor::SwitchedMotor(const MotorParams& params)
    : cold_(params), params_(params), temperature_K_(params.winding_ref_temp_K) {
  WHIRL_CHECK(validate(params, "motor").ok());
  for (int k = 0; k < 3; ++k) admittance_[k] = 1.0 / impedance(k);
  if (params.heat_capacity_JpK <= 0.0) return;
  temperature_K_ = params.start_temp_K;
  params_ = at_temperature(cold_, temperature_K_);
}

void SwitchedMotor::warm(const MotorBooks& books, double dt_s) {
  if (cold_.heat_capacity_JpK <= 0.0) return;
  const double heat_J = books.copper_J * winding_share(cold_, params_) + books.no_load_J;
  temperature_K_ = warmed_K(cold_, temperature_K_, heat_J / dt_s, dt_s);
  params_ = at_temperature(cold_, temperature_K_);
}

void SwitchedMotor::set_angle(double electrical_rad) {
  angle_ = wrapped(electrical_rad);
}

double SwitchedMotor::back_emf(int phase, double angle) const {
  const double own = angle - phase * 2.0 * kPi / 3.0;
  const double sine = params_.phases.sine_share;
  double shape =
      params_.back_emf == BackEmf::trapezoidal ? 0.5 * trapezoid(own) : kSineShare * std::sin(own);
  if (sine > 0.0) shape += sine * (kSineShare * std::sin(own) - shape);
  return params_.torque_constant_NmpA * shape * (1.0 + params_.phases.emf[phase]);
}

// Ties the terminal of a phase whose switches are off to a diode's rail if one conducts.
bool SwitchedMotor::conducts(int k, Circuit& c) const {
  const double above = bus_V_ + params_.diode_drop_V, below = -params_.diode_drop_V;
  const double floating = c.star_V + c.emf_V[k];
  const double i = current_[k];
  if (i > 0.0 || (i == 0.0 && floating < below)) {
    c.tie(k, below, false, true);
  } else if (i < 0.0 || floating > above) {
    c.tie(k, above, true, true);
  } else {
    c.terminal_V[k] = floating;
    return false;
  }
  return true;
}

SwitchedMotor::Circuit SwitchedMotor::circuit(double angle, double speed) const {
  Circuit c{.admittance = admittance_};
  for (int k = 0; k < 3; ++k) {
    c.emf_Vspr[k] = back_emf(k, angle);
    c.emf_V[k] = c.emf_Vspr[k] * speed;
    Leg leg = bridge_.leg[k];
    if (leg == Leg::pwm) {
      leg = bridge_.pwm_on ? Leg::high : bridge_.synchronous ? Leg::low : Leg::off;
    }
    if (leg == Leg::high) c.tie(k, bus_V_, true, false);
    if (leg == Leg::low) c.tie(k, 0.0, false, false);
  }
  const std::array<bool, 3> switched = c.tied;
  for (int k = 0; k < 3; ++k) {  // first the phases that carry current
    if (!switched[k] && current_[k] != 0.0) conducts(k, c);
  }
  c.find_star();
  if (c.count == 0) {  // all free: the sensing dividers pull the terminals down to the lowest diode
    const double lowest = std::min({c.emf_V[0], c.emf_V[1], c.emf_V[2]});
    const double mean = (c.emf_V[0] + c.emf_V[1] + c.emf_V[2]) / 3.0;
    c.star_V = std::max(-mean, -params_.diode_drop_V - lowest);
  }
  for (int k = 0; k < 3; ++k) {  // then those that the star point pushes beyond a rail
    if (!c.tied[k] && conducts(k, c)) c.find_star();
  }
  for (int k = 0; k < 3; ++k) {
    if (!c.tied[k]) c.terminal_V[k] = c.star_V + c.emf_V[k];
  }
  return c;
}

MotorBooks SwitchedMotor::run(double dt_s) {
  MotorBooks books;
  double left = dt_s;
  while (left > 1e-15) left -= advance(left, books);
  books.air_torque_Nm = dt_s > 0.0 ? books.air_torque_Nm / dt_s : 0.0;
  return books;
}

void SwitchedMotor::set_bridge(const Bridge& bridge) {
  const auto driven = [](Leg leg) { return leg == Leg::high || leg == Leg::pwm; };
  bridge_ = bridge;
  patterned_ = std::any_of(bridge.leg.begin(), bridge.leg.end(), driven) &&
               std::find(bridge.leg.begin(), bridge.leg.end(), Leg::low) != bridge.leg.end();
}

// A charge into phase k, counted along the pattern: in at the driven leg, out at the low one.
double SwitchedMotor::along(int k, double charge) const {
  if (!patterned_ || bridge_.leg[k] == Leg::off) return std::abs(charge);
  return bridge_.leg[k] == Leg::low ? -charge : charge;
}

// One inner step; returns how far it went (a diode that stops conducting ends it early).
double SwitchedMotor::advance(double dt_s, MotorBooks& books) {
  const double pace = params_.pole_pairs * std::abs(speed_);
  double h = std::min(dt_s, kMostStep_s);
  if (pace > 0.0) h = std::min(h, kMostTurn_rad / pace);
  const double half_R = 0.5 * params_.resistance_ohm, half_L = 0.5 * params_.inductance_H,
               tau = half_L / half_R;
  const double speed = speed_ + 0.5 * h * acceleration_;
  const double angle = angle_ + 0.5 * h * params_.pole_pairs * speed;
  const Circuit c = circuit(angle, speed);

  std::array<double, 3> ends{};
  int dies = -1;
  for (int k = 0; k < 3; ++k) {
    if (!c.tied[k] || c.count < 2) continue;
    ends[k] = (c.terminal_V[k] - c.star_V - c.emf_V[k]) / (half_R * impedance(k));
    if (!c.diode[k] || current_[k] == 0.0 || ends[k] * current_[k] >= 0.0) continue;
    const double when = tau * std::log1p(-current_[k] / ends[k]);
    if (when <= h) h = when, dies = k;
  }
  const double blend = -settling_.expm1(-h / tau);
  double impulse = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (!c.tied[k] || c.count < 2) continue;
    const double R = half_R * impedance(k), L = half_L * impedance(k);
    const double gap = current_[k] - ends[k];
    const double charge = ends[k] * h + gap * tau * blend;
    const double square = ends[k] * ends[k] * h + 2.0 * ends[k] * gap * tau * blend +
                          gap * gap * 0.5 * tau * blend * (2.0 - blend);
    const double next = k == dies ? 0.0 : ends[k] + gap * (1.0 - blend);
    books.copper_J += R * square;
    books.magnetic_J += 0.5 * L * (next * next - current_[k] * current_[k]);
    if (c.diode[k]) books.diode_J += params_.diode_drop_V * std::abs(charge);
    if (c.to_bus[k]) books.bus_charge_C += charge, books.electrical_in_J += bus_V_ * charge;
    books.winding_charge_C += 0.5 * along(k, charge);
    impulse += c.emf_Vspr[k] * charge;
    peak_A_ = std::max({peak_A_, std::abs(next), std::abs(current_[k])});
    current_[k] = next;
  }
  if (c.count < 2) current_ = {};
  turn(impulse, h, params_.pole_pairs * h, books);
  return h;
}

void SwitchedMotor::turn(double impulse, double h, double angle_gain, MotorBooks& books) {
  if (blocked_) return;
  const double before = speed_, J = params_.inertia_kgm2;
  const double air = load_.quadratic_Nm_s2 * before * std::abs(before) + load_.constant_Nm;
  const double cogging =
      params_.phases.cogging_Nm == 0.0
          ? 0.0
          : params_.phases.cogging_Nm *
                std::sin(PhaseErrors::kCogs * (angle_ + 0.5 * angle_gain * before));
  const double free = before + (impulse - h * (air + cogging)) / J;
  const double friction =
      h * params_.torque_constant_NmpA * params_.no_load_current_A / J;  // as a change of speed
  speed_ = std::abs(free) <= friction ? 0.0 : free - std::copysign(friction, free);
  const double mean = 0.5 * (before + speed_);
  books.kinetic_J += 0.5 * J * (speed_ * speed_ - before * before);
  books.air_J += air * mean * h;
  books.air_torque_Nm += air * h;
  books.no_load_J += J * (free - speed_) * mean + h * cogging * mean;
  acceleration_ = h > 0.0 ? (speed_ - before) / h : 0.0;
  angle_ = wrapped(angle_ + angle_gain * mean);
}

std::array<double, 3> SwitchedMotor::phase_voltages() const {
  return circuit(angle_, speed_).terminal_V;
}

double SwitchedMotor::coming_bus_current_A(double dt_s) const {
  const Circuit c = circuit(angle_, speed_);
  const double half_R = 0.5 * params_.resistance_ohm, tau = 0.5 * params_.inductance_H / half_R;
  if (c.count < 2) return 0.0;
  double charge = 0.0;
  for (int k = 0; k < 3; ++k) {
    if (!c.tied[k] || !c.to_bus[k]) continue;
    const double end = (c.terminal_V[k] - c.star_V - c.emf_V[k]) / (half_R * impedance(k));
    const double gap = current_[k] - end;
    double h = dt_s;
    if (c.diode[k] && end * current_[k] < 0.0)
      h = std::min(h, tau * std::log1p(-current_[k] / end));
    charge += end * h - gap * tau * settling_.expm1(-h / tau);
  }
  return charge / dt_s;
}

double SwitchedMotor::bus_current_A() const {
  const Circuit c = circuit(angle_, speed_);
  double sum = 0.0;
  for (int k = 0; k < 3; ++k) sum += c.to_bus[k] ? current_[k] : 0.0;
  return sum;
}

}  // namespace whirl::plant
