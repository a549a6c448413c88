#include "plant/motor/averaged_motor.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::plant {

// Charge through the pair over the sub-step as a function of the mean speed: Q = a - b w.
struct AveragedMotor::Winding {
  double a_C = 0.0, b_Cs = 0.0;
  double from_A = 0.0;
  double push_C = 0.0;     // of the third phase, as if it were the pair's
  double voltage_V = 0.0;  // mean voltage across the pair, less the dips' constant part
  double diode_V = 0.0, ripple_A = 0.0;
  bool held = false;  // the current ends at held_A, whatever the mean speed turns out to be
  double held_A = 0.0, square_A2s = 0.0, fall_charge_C = 0.0;
};

namespace {

double ripple_A(const MotorParams& p, const Drive& drive) {  // peak to peak
  const double swing_V = drive.bus_V + (drive.diode ? p.diode_drop_V : 0.0);
  return swing_V * drive.duty * (1.0 - drive.duty) / (p.inductance_H * p.pwm_Hz);
}

// Under diodes every PWM period may start from zero current [Erickson2001, ch. 5].
Pulses pulses(const MotorParams& p, double resistance, const Drive& drive, double emf_V) {
  const double tau = p.inductance_H / resistance, period = 1.0 / p.pwm_Hz;
  const double rise_s = drive.duty * period;
  const double peak = (drive.bus_V - emf_V) / resistance * -std::expm1(-rise_s / tau);
  if (!(peak > 0.0)) return {.falls_s = 0.0};
  const double back = emf_V + p.diode_drop_V;
  if (back <= 0.0) return {};  // turned backward: the current grows between pulses, too
  const double fall_s = tau * std::log1p(peak * resistance / back);
  if (rise_s + fall_s >= period) {  // never dry for a whole period
    const double least = 0.5 * ripple_A(p, drive);
    return {least, 4.0 / 3.0 * least * least, (1.0 - drive.duty) * least, (rise_s + period) / 3.0,
            fall_s};
  }
  // Charge of each edge from its own balance: volt-seconds = L di + R charge.
  const double rise_C = ((drive.bus_V - emf_V) * rise_s - p.inductance_H * peak) / resistance;
  const double fall_C = (p.inductance_H * peak - back * fall_s) / resistance;
  const double stored = 0.5 * p.inductance_H * peak * peak;
  const double rise_square = ((drive.bus_V - emf_V) * rise_C - stored) / resistance;
  const double fall_square = (stored - back * fall_C) / resistance;
  return {(rise_C + fall_C) / period, (rise_square + fall_square) / period, fall_C / period,
          (2.0 * rise_s + fall_s) / 3.0, fall_s};
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
    : cold_(params),
      params_(params),
      temperature_K_(params.winding_ref_temp_K),
      resistance_(params.resistance_ohm) {
  WHIRL_CHECK(validate(params, "motor").ok());
  if (params.heat_capacity_JpK <= 0.0) return;
  temperature_K_ = params.start_temp_K;
  params_ = at_temperature(cold_, temperature_K_);
  resistance_ = params_.resistance_ohm;
}

MotorBooks AveragedMotor::step(const Drive& drive, const ShaftLoad& load, double dt_s) {
  WHIRL_CHECK(drive.duty >= 0.0 && drive.duty <= 1.0 && dt_s > 0.0, drive.duty, dt_s);
  prepare(drive, dt_s);
  const Trial trial = attempt(drive, load, dt_s);
  accept(trial);
  return trial.books;
}

void AveragedMotor::prepare(const Drive& about, double dt_s) {
  const double ahead = speed_ + 0.5 * rise_radps_;
  const double speed = speed_ < 0.0 ? std::min(0.0, ahead) : std::max(0.0, ahead);
  if (still_holds(about, speed, dt_s)) return;
  found_for_ = {about, speed, current_, resistance_, dt_s, blocked_};
  const double emf = params_.torque_constant_NmpA * speed;
  pulses_ = {};
  const double ripple = ripple_A(params_, about);
  if (about.diode) {
    const double low_V = about.duty * about.bus_V - (1.0 - about.duty) * params_.diode_drop_V;
    if (low_V - emf < 2.0 * ripple * resistance_ || current_ < 2.0 * ripple) {
      pulses_ = pulses(params_, resistance_, about, emf);
    }
  }
  commutation_ = {};
  if (!blocked_ && speed >= 0.0) {
    commutation_ = commutate(params_, {.bus_V = about.bus_V,
                                       .duty = about.duty,
                                       .diode = about.diode,
                                       .resistance_ohm = resistance_,
                                       .speed_radps = speed,
                                       .pair_A = current_,
                                       .dry_A = pulses_.least_A,
                                       .dry_s = pulses_.lasts_s,
                                       .ripple_A = ripple,
                                       .falls_s = pulses_.falls_s});
  }
  prepared_ohm_ = resistance_ + commutation_.ohm;
  tau_s_ = params_.inductance_H / prepared_ohm_;
  blend_ = -std::expm1(-dt_s / tau_s_);
}

// Commutation is found anew when what it depends on has moved by what cannot matter much.
bool AveragedMotor::still_holds(const Drive& about, double speed, double dt_s) const {
  const FoundFor& f = found_for_;
  return f.dt_s == dt_s && f.drive.duty == about.duty && f.drive.diode == about.diode &&
         f.ohm == resistance_ && f.blocked == blocked_ &&
         std::abs(f.drive.bus_V - about.bus_V) <= 1e-3 * about.bus_V &&
         std::abs(f.speed_radps - speed) <= 5e-4 * std::abs(speed) &&
         std::abs(f.current_A - current_) <= 0.01 * std::abs(current_);
}

double AveragedMotor::bus_charge_per_volt(const Drive& drive, double dt_s) const {
  return drive.duty * drive.duty / prepared_ohm_ * (dt_s - tau_s_ * blend_);
}

AveragedMotor::Winding AveragedMotor::conduct(double voltage_V, double dt_s) const {
  Winding w;
  w.voltage_V = voltage_V - commutation_.volts;
  const double settled_s = dt_s - tau_s_ * blend_;
  w.a_C = w.voltage_V / prepared_ohm_ * settled_s + current_ * tau_s_ * blend_;
  w.b_Cs = params_.torque_constant_NmpA / prepared_ohm_ * settled_s;
  w.push_C = commutation_.push_A * dt_s;
  w.from_A = current_;
  return w;
}

// All switches off and turned backward: no pair is held closed through which the back-EMF could drive
// a current. What still flowed returns to the bus.
void AveragedMotor::open_bridge(Winding& w) {
  w.held = true;
  w.held_A = w.a_C = w.b_Cs = w.push_C = 0.0;
}

// Under diode freewheeling the current does not follow the mean voltage below the pulses' mean.
void AveragedMotor::diode_limit(const Drive& drive, double dt_s, Winding& w) const {
  if (drive.duty == 0.0 && speed_ < 0.0) return open_bridge(w);
  const double emf = params_.torque_constant_NmpA * speed_;
  const double ends = (w.voltage_V - emf) / prepared_ohm_;  // where the mean voltage would lead
  const double floor_A = commutation_.dry_A;
  if (ends >= floor_A) {
    if (current_ < floor_A) {  // the first pulse brings that much
      w.from_A = floor_A;
      w.a_C += (floor_A - current_) * tau_s_ * blend_;
    }
    return;
  }
  double conducting_s = 0.0;  // the older, larger current runs down first
  if (current_ > floor_A) {
    conducting_s = std::min(dt_s, tau_s_ * std::log((current_ - ends) / (floor_A - ends)));
    if (conducting_s >= dt_s) return;
  }
  const double first = std::max(current_, floor_A) - ends;
  const double gone = -std::expm1(-conducting_s / tau_s_);
  const double run_down_C = ends * conducting_s + first * tau_s_ * gone;
  const double rest_s = dt_s - conducting_s;
  const double carried_A = floor_A - pulses_.least_A;  // by the third phase
  w.held = true;
  w.held_A = floor_A;
  w.a_C = run_down_C + floor_A * rest_s;
  w.b_Cs = 0.0;
  w.square_A2s = (ends * ends + w.ripple_A * w.ripple_A / 12.0) * conducting_s +
                 2.0 * ends * first * tau_s_ * gone +
                 first * first * 0.5 * tau_s_ * gone * (2.0 - gone) +
                 (pulses_.least_A2 + carried_A * (floor_A + pulses_.least_A)) * rest_s;
  w.fall_charge_C = (1.0 - drive.duty) * run_down_C +
                    pulses_.fall_A * (floor_A / std::max(pulses_.least_A, 1e-9)) * rest_s;
}

// Implicit midpoint: 2 J (w - w0) = Kt (a - b w) - dt (friction + c + k w |w|), solved for the mean speed
// w, which has the sign of what turns the shaft forward at no speed.
double AveragedMotor::balance(const Winding& winding, const ShaftLoad& load, double friction_Nm,
                              double dt_s) const {
  const double kt = params_.torque_constant_NmpA;
  const double a = dt_s * load.quadratic_Nm_s2;
  const double b = 2.0 * params_.inertia_kgm2 + kt * winding.b_Cs;
  const double drag = friction_Nm + load.constant_Nm;
  const double c =
      2.0 * params_.inertia_kgm2 * speed_ + kt * (winding.a_C + winding.push_C) - dt_s * drag;
  return 2.0 * c / (b + std::sqrt(b * b + 4.0 * a * std::abs(c)));
}

// Friction opposes the rotation: it stops the shaft and holds it, and never turns it.
AveragedMotor::Motion AveragedMotor::move(const Winding& winding, const ShaftLoad& load,
                                          double dt_s) const {
  if (blocked_) return {};
  const double friction_Nm = params_.torque_constant_NmpA * params_.no_load_current_A;
  if (speed_ == 0.0) {
    const double forward = balance(winding, load, friction_Nm, dt_s);
    if (forward > 0.0) return {forward, friction_Nm};
    const double backward = balance(winding, load, -friction_Nm, dt_s);
    return backward < 0.0 ? Motion{backward, -friction_Nm} : Motion{};
  }
  const double against_Nm = std::copysign(friction_Nm, speed_);
  const auto turned_round = [this](double mean) { return (2.0 * mean - speed_) * speed_ <= 0.0; };
  const double mean = balance(winding, load, against_Nm, dt_s);
  if (!turned_round(mean)) return {mean, against_Nm};
  const double unhindered = balance(winding, load, 0.0, dt_s);
  if (!turned_round(unhindered)) return {0.5 * speed_, against_Nm};  // friction has stopped it
  return {unhindered, 0.0};  // something stronger turns it round
}

// Where the pair's charge and the heat went.
void AveragedMotor::settle(const Winding& w, double mean, double dt_s, Trial& out) const {
  MotorBooks& books = out.books;
  const double pair_C = w.a_C - w.b_Cs * mean;
  if (w.held) {
    out.current_A = w.held_A;
    books.copper_J = resistance_ * w.square_A2s;
    books.diode_J = params_.diode_drop_V * w.fall_charge_C;
  } else {
    const double ends = (w.voltage_V - params_.torque_constant_NmpA * mean) / prepared_ohm_;
    const double gap = w.from_A - ends;
    out.current_A = ends + gap * (1.0 - blend_);
    const double square = ends * ends * dt_s + 2.0 * ends * gap * tau_s_ * blend_ +
                          gap * gap * 0.5 * tau_s_ * blend_ * (2.0 - blend_);
    books.copper_J = resistance_ * (square + w.ripple_A * w.ripple_A / 12.0 * dt_s);
    books.diode_J = w.diode_V * pair_C;
  }
  books.winding_charge_C = pair_C + 0.5 * commutation_.third_A * dt_s;
  books.copper_J += resistance_ * (commutation_.wobble_A2 + 0.75 * commutation_.third_A2) * dt_s;
  books.diode_J += params_.diode_drop_V * commutation_.diode_A * dt_s;
  books.magnetic_J =
      0.5 * params_.inductance_H * (out.current_A * out.current_A - current_ * current_);
}

AveragedMotor::Trial AveragedMotor::attempt(const Drive& drive, const ShaftLoad& load,
                                            double dt_s) const {
  const double diode_V = drive.diode ? (1.0 - drive.duty) * params_.diode_drop_V : 0.0;
  Winding w = conduct(drive.duty * drive.bus_V - diode_V, dt_s);
  w.diode_V = diode_V;
  w.ripple_A = ripple_A(params_, drive);
  if (drive.diode) diode_limit(drive, dt_s, w);
  const double kt = params_.torque_constant_NmpA;
  const Motion motion = move(w, load, dt_s);
  const double mean = motion.mean_radps;

  Trial out;
  out.speed_radps = blocked_ ? 0.0 : 2.0 * mean - speed_;
  settle(w, mean, dt_s, out);
  MotorBooks& books = out.books;
  const double converted_J = kt * mean * (w.a_C - w.b_Cs * mean + w.push_C);
  books.electrical_in_J = books.copper_J + books.diode_J + books.magnetic_J + converted_J;
  books.bus_charge_C = drive.bus_V > 0.0 ? books.electrical_in_J / drive.bus_V : 0.0;
  books.air_torque_Nm = load.quadratic_Nm_s2 * mean * std::abs(mean) + load.constant_Nm;
  books.air_J = books.air_torque_Nm * mean * dt_s;
  books.kinetic_J =
      0.5 * params_.inertia_kgm2 * (out.speed_radps * out.speed_radps - speed_ * speed_);
  const bool stopped = out.speed_radps == 0.0;  // friction took what was left
  books.no_load_J =
      stopped ? converted_J - books.air_J - books.kinetic_J : motion.friction_Nm * mean * dt_s;
  return out;
}

void AveragedMotor::block() {
  blocked_ = true;
  speed_ = 0.0;
}

void AveragedMotor::set_speed(double speed_radps) {
  WHIRL_CHECK(std::isfinite(speed_radps), speed_radps);
  if (!blocked_) speed_ = speed_radps;
}

void AveragedMotor::warm(const MotorBooks& books, double dt_s) {
  if (cold_.heat_capacity_JpK <= 0.0) return;
  const double heat_J = books.copper_J * winding_share(cold_, params_) + books.no_load_J;
  temperature_K_ = warmed_K(cold_, temperature_K_, heat_J / dt_s, dt_s);
  params_ = at_temperature(cold_, temperature_K_);
  resistance_ = params_.resistance_ohm;
}

}  // namespace whirl::plant
