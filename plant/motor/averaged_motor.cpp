#include "plant/motor/averaged_motor.hpp"

#include <algorithm>
#include <cmath>

#include "harness/base/check.hpp"

namespace whirl::plant {

// Charge through the winding over the sub-step as a function of the mean speed: Q = a - b w.
struct AveragedMotor::Winding {
  double a_C = 0.0, b_Cs = 0.0;
  double voltage_V = 0.0;  // mean voltage across the winding
  double blend = 0.0;      // 1 - exp(-dt/tau)
  double tau_s = 0.0;
  bool held = false;  // the current ends at held_A, whatever the mean speed turns out to be
  double held_A = 0.0, square_A2s = 0.0, fall_charge_C = 0.0;
};

namespace {

constexpr double kPi = 3.14159265358979323846;

// Mean of the pulses when every PWM period starts from zero current [Erickson2001, ch. 5].
struct Pulses {
  bool discontinuous = false;
  double mean_A = 0.0, mean_square_A2 = 0.0, fall_A = 0.0;  // fall: the share through the diodes
};

Pulses pulses(const MotorParams& p, double resistance, const Drive& drive, double emf_V) {
  const double tau = p.inductance_H / resistance, period = 1.0 / p.pwm_Hz;
  const double rise_s = drive.duty * period;
  const double peak = (drive.bus_V - emf_V) / resistance * -std::expm1(-rise_s / tau);
  if (!(peak > 0.0)) return {.discontinuous = drive.bus_V > emf_V};
  const double back = emf_V + p.diode_drop_V;
  const double fall_s = tau * std::log1p(peak * resistance / back);
  if (rise_s + fall_s >= period) return {};
  // Charge of each edge from its own balance: volt-seconds = L di + R charge.
  const double rise_C = ((drive.bus_V - emf_V) * rise_s - p.inductance_H * peak) / resistance;
  const double fall_C = (p.inductance_H * peak - back * fall_s) / resistance;
  const double stored = 0.5 * p.inductance_H * peak * peak;
  const double rise_square = ((drive.bus_V - emf_V) * rise_C - stored) / resistance;
  const double fall_square = (stored - back * fall_C) / resistance;
  return {.discontinuous = true,
          .mean_A = (rise_C + fall_C) / period,
          .mean_square_A2 = (rise_square + fall_square) / period,
          .fall_A = fall_C / period};
}

}  // namespace

MotorBooks& MotorBooks::operator+=(const MotorBooks& other) {
  winding_charge_C += other.winding_charge_C;
  bus_charge_C += other.bus_charge_C;
  electrical_in_J += other.electrical_in_J;
  copper_J += other.copper_J;
  diode_J += other.diode_J;
  no_load_J += other.no_load_J;
  magnetic_J += other.magnetic_J;
  kinetic_J += other.kinetic_J;
  air_J += other.air_J;
  air_torque_Nm += other.air_torque_Nm;
  return *this;
}

AveragedMotor::AveragedMotor(const MotorParams& params)
    : params_(params),
      temperature_K_(params.winding_ref_temp_K),
      resistance_(params.resistance_ohm) {
  WHIRL_CHECK(validate(params, "motor").ok());
}

MotorBooks AveragedMotor::step(const Drive& drive, const ShaftLoad& load, double dt_s) {
  WHIRL_CHECK(drive.duty >= 0.0 && drive.duty <= 1.0 && dt_s > 0.0, drive.duty, dt_s);
  prepare(dt_s);
  const Trial trial = attempt(drive, load, dt_s);
  accept(trial);
  return trial.books;
}

void AveragedMotor::prepare(double dt_s) {
  find_overlap();
  const double ohm = resistance_ + overlap_.drop_ohm;
  if (dt_s == prepared_dt_s_ && ohm == prepared_ohm_) return;
  prepared_dt_s_ = dt_s;
  prepared_ohm_ = ohm;
  overlap_.tau_s = params_.inductance_H / ohm;
  overlap_.blend = -std::expm1(-dt_s / overlap_.tau_s);
}

double AveragedMotor::bus_charge_per_volt(const Drive& drive, double dt_s) const {
  return drive.duty * drive.duty / prepared_ohm_ * (dt_s - overlap_.tau_s * overlap_.blend);
}

// Between commutations the pair's current recovers from I/2 to I, as an exponential towards
// `towards`; all figures per I. With x the sector's time over L/R.
void AveragedMotor::find_overlap() {
  const double electrical_radps = params_.pole_pairs * std::max(0.0, speed_ + 0.5 * rise_radps_);
  const double x = kPi / 3.0 / std::max(electrical_radps, 1.0) * resistance_ / params_.inductance_H;
  const double fade = std::exp(-x), left = 1.0 - fade;
  const double towards = (1.0 - 0.5 * fade) / left, gap = towards - 0.5;
  const double mean = towards - gap * left / x;
  const double square =
      towards * (towards - 2.0 * gap * left / x) + gap * gap * left * (1.0 + fade) / (2.0 * x);
  overlap_.drop_ohm = 3.0 / kPi * electrical_radps * 0.5 * params_.inductance_H / mean;
  overlap_.square_share = square / (mean * mean);
  overlap_.ripple_share = 1.0;
}

AveragedMotor::Winding AveragedMotor::conduct(double voltage_V, double dt_s) const {
  Winding w;
  w.tau_s = overlap_.tau_s;
  w.blend = overlap_.blend;
  w.voltage_V = voltage_V;
  const double settled_s = dt_s - w.tau_s * w.blend, ohm = prepared_ohm_;
  w.a_C = voltage_V / ohm * settled_s + current_ * w.tau_s * w.blend;
  w.b_Cs = params_.torque_constant_NmpA / ohm * settled_s;
  return w;
}

// Under diode freewheeling the current does not follow the mean voltage below the pulses' mean.
void AveragedMotor::diode_limit(const Drive& drive, double dt_s, Winding& w) const {
  const double emf = params_.torque_constant_NmpA * speed_;
  const double ends = (w.voltage_V - emf) / prepared_ohm_;  // where the mean voltage would lead
  const double ripple_A = (drive.bus_V + params_.diode_drop_V) * drive.duty * (1.0 - drive.duty) /
                          (params_.inductance_H * params_.pwm_Hz);
  if (ends > ripple_A && current_ > ripple_A) return;  // far from running dry
  const Pulses limit = pulses(params_, resistance_, drive, emf);
  const bool cut = drive.duty == 0.0 || drive.bus_V <= emf;  // no pulses at all
  if (!limit.discontinuous && !cut) return;
  const double floor_A = cut ? 0.0 : limit.mean_A;
  if (ends >= floor_A) return;
  double conducting_s = 0.0;  // the older, larger current runs down first
  if (current_ > floor_A) {
    conducting_s = std::min(dt_s, w.tau_s * std::log((current_ - ends) / (floor_A - ends)));
    if (conducting_s >= dt_s) return;
  }
  const double first = std::max(current_, floor_A) - ends;
  const double gone = -std::expm1(-conducting_s / w.tau_s);
  const double run_down_C = ends * conducting_s + first * w.tau_s * gone;
  const double rest_s = dt_s - conducting_s;
  w.held = true;
  w.held_A = floor_A;
  w.a_C = run_down_C + floor_A * rest_s;
  w.b_Cs = 0.0;
  w.square_A2s = ends * ends * conducting_s + 2.0 * ends * first * w.tau_s * gone +
                 first * first * 0.5 * w.tau_s * gone * (2.0 - gone) +
                 limit.mean_square_A2 * rest_s;
  w.fall_charge_C = (1.0 - drive.duty) * run_down_C + limit.fall_A * rest_s;
}

// Implicit midpoint: 2 J (w - w0) = Kt (a - b w) - dt (no-load + c + k w^2), solved for w.
double AveragedMotor::mean_speed(const Winding& winding, const ShaftLoad& load, double dt_s) const {
  if (blocked_) return 0.0;
  const double kt = params_.torque_constant_NmpA;
  const double drag = kt * params_.no_load_current_A + load.constant_Nm;
  const double a = dt_s * load.quadratic_Nm_s2;
  const double b = 2.0 * params_.inertia_kgm2 + kt * winding.b_Cs;
  const double c = 2.0 * params_.inertia_kgm2 * speed_ + kt * winding.a_C - dt_s * drag;
  const double mean = 2.0 * c / (b + std::sqrt(std::max(0.0, b * b + 4.0 * a * c)));
  return std::max(mean, 0.5 * speed_);  // friction stops the shaft, it does not turn it back
}

AveragedMotor::Trial AveragedMotor::attempt(const Drive& drive, const ShaftLoad& load,
                                            double dt_s) const {
  const double diode_V = drive.diode ? (1.0 - drive.duty) * params_.diode_drop_V : 0.0;
  Winding w = conduct(drive.duty * drive.bus_V - diode_V, dt_s);
  if (drive.diode) diode_limit(drive, dt_s, w);
  const double kt = params_.torque_constant_NmpA;
  const double mean = mean_speed(w, load, dt_s);

  Trial out;
  out.speed_radps = blocked_ ? 0.0 : 2.0 * mean - speed_;
  MotorBooks& books = out.books;
  double given_back_J = 0.0;  // the overlap's voltage drop returns to the bus what it does not burn
  books.winding_charge_C = w.a_C - w.b_Cs * mean;
  if (w.held) {
    out.current_A = w.held_A;
    books.copper_J = resistance_ * w.square_A2s;
    books.diode_J = params_.diode_drop_V * w.fall_charge_C;
  } else {
    const double ends = (w.voltage_V - kt * mean) / (resistance_ + overlap_.drop_ohm);
    const double gap = current_ - ends;
    out.current_A = ends + gap * (1.0 - w.blend);
    const double square = ends * ends * dt_s + 2.0 * ends * gap * w.tau_s * w.blend +
                          gap * gap * 0.5 * w.tau_s * w.blend * (2.0 - w.blend);
    const double ripple_A = drive.bus_V * drive.duty * (1.0 - drive.duty) /
                            (params_.inductance_H * params_.pwm_Hz);  // peak to peak
    books.copper_J = resistance_ * (overlap_.square_share * square +
                                    overlap_.ripple_share * ripple_A * ripple_A / 12.0 * dt_s);
    books.diode_J = diode_V * books.winding_charge_C;
    given_back_J = (resistance_ + overlap_.drop_ohm) * square - books.copper_J;
  }
  books.magnetic_J =
      0.5 * params_.inductance_H * (out.current_A * out.current_A - current_ * current_);
  const double converted_J = kt * mean * books.winding_charge_C;
  if (w.held) {  // the pulses' share of the bus charge follows from what they delivered
    books.electrical_in_J = books.copper_J + books.diode_J + books.magnetic_J + converted_J;
    books.bus_charge_C = drive.bus_V > 0.0 ? books.electrical_in_J / drive.bus_V : 0.0;
  } else {
    const double taken_J = drive.bus_V * drive.duty * books.winding_charge_C;
    books.electrical_in_J = taken_J - given_back_J;
    books.bus_charge_C = drive.bus_V > 0.0 ? books.electrical_in_J / drive.bus_V : 0.0;
  }
  books.air_torque_Nm = load.quadratic_Nm_s2 * mean * mean + load.constant_Nm;
  books.air_J = books.air_torque_Nm * mean * dt_s;
  books.kinetic_J =
      0.5 * params_.inertia_kgm2 * (out.speed_radps * out.speed_radps - speed_ * speed_);
  const bool stopped = out.speed_radps == 0.0;  // friction took what was left
  books.no_load_J = stopped ? converted_J - books.air_J - books.kinetic_J
                            : kt * params_.no_load_current_A * mean * dt_s;
  return out;
}

void AveragedMotor::block() {
  blocked_ = true;
  speed_ = 0.0;
}

void AveragedMotor::set_speed(double speed_radps) {
  WHIRL_CHECK(speed_radps >= 0.0 && std::isfinite(speed_radps), speed_radps);
  if (!blocked_) speed_ = speed_radps;
}

void AveragedMotor::warm(const MotorBooks& books, double dt_s) {
  if (params_.heat_capacity_JpK <= 0.0) return;
  const double share = params_.winding_resistance_ohm / params_.resistance_ohm;
  const double heat_W = (books.copper_J * share + books.no_load_J) / dt_s;
  const double settled_K = params_.ambient_temp_K + heat_W * params_.heat_resistance_KpW;
  const double time_s = params_.heat_capacity_JpK * params_.heat_resistance_KpW;
  temperature_K_ += (settled_K - temperature_K_) * -std::expm1(-dt_s / time_s);
  resistance_ = params_.resistance_ohm + params_.winding_resistance_ohm *
                                             params_.copper_temp_coefficient_pK *
                                             (temperature_K_ - params_.winding_ref_temp_K);
}

}  // namespace whirl::plant
