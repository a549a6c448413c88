#include "io_bridges/rack/models/power_stage.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "plant/parts/esc_stand.hpp"

namespace whirl::rack {
namespace {

constexpr double kShunt_VpA = 0.5e-3 * 50.9;
constexpr double kReference_V = 3.3;
constexpr double kLeast_source_ohm = 1e-3;  // leads; also keeps the bus capacitor's equation sane
constexpr double kLongest_step_s = 25e-6;
constexpr double kStands_radps = 5.0;
constexpr double kBackwards_radps = -30.0;  // a start swings a little to both sides
constexpr int kBackward_reports = 50;       // one each millisecond

plant::Leg leg_of(const std::array<bool, 2>& on) {
  if (on[0]) return plant::Leg::low;
  return on[1] ? plant::Leg::high : plant::Leg::off;
}

}  // namespace

PowerStage::PowerStage(const PowerStageParams& params, std::uint64_t seed, const std::string& name)
    : params_(params),
      motor_(params.motor),
      shunt_(params.shunt, seed, name + ".shunt"),
      window_(std::llround(1e9 / params.motor.pwm_Hz)) {
  for (const char* pin : {"a", "b", "c", "bus", "shunt"}) {
    noise_.emplace_back(seed, name + ".adc." + pin);
  }
}

// `nominal`: what the board's drawing makes of a volt there.
double PowerStage::at_pin(std::size_t pin, double volts, double nominal) {
  const PinErrors& e = params_.pins[pin];
  double shown = volts * nominal;
  if (e.divider != 0.0) shown *= 1.0 + e.divider;
  if (e.gain != 0.0 || e.offset_V != 0.0) shown = (1.0 + e.gain) * shown + e.offset_V;
  if (e.noise_V > 0.0) shown += e.noise_V * noise_[pin].normal();
  return std::clamp(shown, 0.0, kReference_V);
}

void PowerStage::wire(int leg, bool upper, io::Wire& wire) {
  wire.drive(wire.add_driver(), io::Drive::pull_low, now_ns_);
  on_[static_cast<std::size_t>(leg)][upper ? 1 : 0] = wire.level();
  wire.watch([this, leg, upper](bool level, Nanoseconds now) { switched(leg, upper, level, now); });
}

void PowerStage::switched(int leg, bool upper, bool on, Nanoseconds now) {
  advance(now);
  auto& both = on_[static_cast<std::size_t>(leg)];
  auto& since = both_since_[static_cast<std::size_t>(leg)];
  if (upper && on && !both[1]) window_.upper_switch_on();
  both[upper ? 1 : 0] = on;
  if (both[0] && both[1]) {
    since = now_ns_;
  } else {
    end_shot(leg, now_ns_);
  }
  plant::Bridge bridge;
  for (std::size_t k = 0; k < 3; ++k) bridge.leg[phase_at(k)] = leg_of(on_[k]);
  motor_.set_bridge(bridge);
}

std::size_t PowerStage::phase_at(std::size_t leg) const {
  return params_.swap_wires && leg != 0 ? 3 - leg : leg;
}

// Edges of one instant overlap for no time: they are no short circuit.
void PowerStage::end_shot(int leg, Nanoseconds now) {
  auto& since = both_since_[static_cast<std::size_t>(leg)];
  if (since < now && shot_) shot_(leg, since, now);
  since = io::kNever;
}

double PowerStage::phase_V(int leg, Nanoseconds now) {
  advance(now);
  const auto pin = static_cast<std::size_t>(leg);
  return at_pin(pin, motor_.phase_voltages()[phase_at(pin)], plant::kVoltageDivider);
}

double PowerStage::bus_V(Nanoseconds now) {
  advance(now);
  return at_pin(PowerStageParams::kBus, bus_V_, plant::kVoltageDivider);
}

double PowerStage::shunt_V(Nanoseconds now) {
  advance(now);
  return at_pin(PowerStageParams::kShunt, shunt_.sample_A(), kShunt_VpA);
}

void PowerStage::set_load(const io::ShaftLoad& load, Nanoseconds now) {
  advance(now);
  load_ = load;
  load_.source_ohm = std::max(load.source_ohm, kLeast_source_ohm);
  if (load.brake_Nm <= 0.0) motor_.release();
}

void PowerStage::advance(Nanoseconds now) {
  while (now_ns_ < now) {
    const double dt_s = std::min(static_cast<double>(now - now_ns_) * 1e-9, kLongest_step_s);
    const auto step_ns = std::min<Nanoseconds>(now - now_ns_, 25'000);
    const double charge_C = run(dt_s);
    now_ns_ += step_ns;
    window_.flow(charge_C, now_ns_);
  }
}

void PowerStage::hold_or_turn() {
  const double speed = motor_.speed_radps();
  const bool brakes = load_.brake_Nm > 0.0;
  if (brakes && std::abs(speed) < kStands_radps) return motor_.block();
  const double constant_Nm = brakes ? std::copysign(load_.brake_Nm, speed) : -load_.brake_Nm;
  motor_.set_load({.quadratic_Nm_s2 = load_.torque_Nm_s2, .constant_Nm = constant_Nm});
}

// Share of its way to where it settles that the capacitor between supply and bridge goes in a step.
double PowerStage::way_gone(double dt_s) const {
  return -charging_.expm1(-dt_s /
                          ((load_.source_ohm + params_.bus_esr_ohm) * params_.bus_capacitance_F));
}

// Exactly, for a bridge that draws the same current all the time. Source and bridge meet outside of the
// capacitor's series resistance.
PowerStage::Feed PowerStage::feed(double bridge_A, double dt_s, double gone) const {
  const double R = load_.source_ohm, E = params_.bus_esr_ohm, C = params_.bus_capacitance_F;
  if (R <= 0.0) return {capacitor_V_, capacitor_V_, 0.0, 0.0};  // nothing feeds it yet
  const double tau_s = (R + E) * C;
  const double settled_V = load_.source_V - R * bridge_A;
  const double first_A = (settled_V - capacitor_V_) / (R + E);  // into the capacitor
  const double charge_C = first_A * tau_s * gone;
  const double square_A2s = 0.5 * first_A * first_A * tau_s * gone * (2.0 - gone);
  return {
      .end_V = capacitor_V_ + (settled_V - capacitor_V_) * gone,
      .mean_V = settled_V - (settled_V - capacitor_V_) * gone * tau_s / dt_s + E * charge_C / dt_s,
      .charge_C = bridge_A * dt_s + charge_C,
      .heat_J = R * (bridge_A * bridge_A * dt_s + 2.0 * bridge_A * charge_C + square_A2s) +
                E * square_A2s};
}

// By converter and bridge: at the current of this instant, not at the step's mean.
double PowerStage::seen_V() const {
  const double R = load_.source_ohm, E = params_.bus_esr_ohm;
  if (E == 0.0 || R <= 0.0) return capacitor_V_;
  return (load_.source_V * E + capacitor_V_ * R - motor_.bus_current_A() * R * E) / (R + E);
}

// The motor is fed by the mean of the capacitor's voltage, as its current is foreseen; what it took by more or less
// than by the mean as it has come to be (0.04 % of a hover) is the capacitor's. With the voltage at the step's start
// 0.2 % of a hover's energy came from nowhere.
double PowerStage::run(double dt_s) {
  hold_or_turn();
  motor_.set_bus(bus_V_);
  const double gone = way_gone(dt_s);
  const double fed_V = feed(motor_.coming_bus_current_A(dt_s), dt_s, gone).mean_V;
  motor_.set_bus(fed_V);
  const plant::MotorBooks books = motor_.run(dt_s);
  const double bridge_A = books.bus_charge_C / dt_s;
  shunt_.flow(bridge_A, dt_s);
  plant::MotorBooks sum = books;
  sum.air_torque_Nm *= dt_s;  // a mean; here its integral is kept
  books_ += sum;

  const double C = params_.bus_capacitance_F;
  const Feed fed = feed(bridge_A, dt_s, gone);
  const double owed_J = (fed.mean_V - fed_V) * books.bus_charge_C;
  const double end_V = std::sqrt(std::max(0.0, fed.end_V * fed.end_V + 2.0 * owed_J / C));
  source_charge_C_ += fed.charge_C;
  state_.source_J += load_.source_V * fed.charge_C;
  state_.feed_J += fed.heat_J;
  state_.capacitor_J += 0.5 * C * (end_V * end_V - capacitor_V_ * capacitor_V_);
  capacitor_V_ = end_V;
  bus_V_ = seen_V();
  state_.bus_highest_V = std::max(state_.bus_highest_V, bus_V_);
  state_.bus_lowest_V = std::min(state_.bus_lowest_V, bus_V_);
  return books.bus_charge_C;
}

void PowerStage::watch_direction(double speed_radps, Nanoseconds now) {
  if (backward_reports_ == kBackward_reports) return;  // told
  backward_reports_ = speed_radps < kBackwards_radps ? backward_reports_ + 1 : 0;
  if (backward_reports_ == kBackward_reports && backwards_) backwards_(now);
}

io::ShaftState PowerStage::report(Nanoseconds now) {
  advance(now);
  const double dt_s = static_cast<double>(now - reported_ns_) * 1e-9;
  WHIRL_CHECK(dt_s > 0.0, now, reported_ns_);
  io::ShaftState told = state_;
  told.speed_radps = motor_.speed_radps();
  motor_.warm(books_, dt_s);
  watch_direction(told.speed_radps, now);
  told.angle_rad = motor_.electrical_angle_rad();
  told.air_torque_Nm = books_.air_torque_Nm / dt_s;
  told.source_current_A = source_charge_C_ / dt_s;
  told.bridge_current_A = books_.bus_charge_C / dt_s;
  told.bridge_peak_A = window_.take_peak_A();
  told.winding_peak_A = motor_.peak_current_A();
  told.bus_voltage_V = bus_V_;
  told.electrical_in_J = books_.electrical_in_J;
  told.copper_J = books_.copper_J;
  told.diode_J = books_.diode_J;
  told.no_load_J = books_.no_load_J;
  told.magnetic_J = books_.magnetic_J;
  told.kinetic_J = books_.kinetic_J;
  told.air_J = books_.air_J;
  state_ = {.bus_highest_V = bus_V_, .bus_lowest_V = bus_V_};
  books_ = {};
  source_charge_C_ = 0.0;
  motor_.clear_peak();
  reported_ns_ = now;
  return told;
}

}  // namespace whirl::rack
