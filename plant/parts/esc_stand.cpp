#include "plant/parts/esc_stand.hpp"

#include "plant/parts/motor_numbers.hpp"

namespace whirl::plant {
namespace {

using Law = Spread::Law;

constexpr double kCount_V = 3.3 / 4096.0;

constexpr const char* kStandGroups[] = {"converter", "dividers", "shunt", "motor",
                                        "heat",      "bus",      "clock", "instruments"};

constexpr const char* kOffset = "[F103] EO 1.5 counts typical, 2.5 at most";
constexpr const char* kGain = "[F103] EG 1.5 counts of full scale typical, 3 at most";
constexpr const char* kNoise =
    "estimate: 1 to 2 counts rms of an F103 beside a switching bridge; worst 3.7 (3 mV)";
constexpr const char* kResistor = "1 % thick film";
constexpr const char* kWindings = "estimate: hand-wound, soldered in a joint of three";

constexpr Spread kOffset_V{Law::normal, 0.0, 1.5 * kCount_V, 2.5 * kCount_V};
constexpr Spread kGain_share{Law::normal, 0.0, 1.5 / 4096.0, 3.0 / 4096.0};
constexpr Spread kNoise_V{Law::level, 1.5 * kCount_V, 0.5 * kCount_V, 3e-3 - 1.5 * kCount_V};
constexpr Spread kOne_percent{Law::even, 0.0, 0.0, 0.01};
constexpr Spread kPhase_impedance{Law::normal, 0.0, 0.01, 0.03};
constexpr Spread kPhase_emf{Law::normal, 0.0, 0.003, 0.01};

constexpr PartNumber kNumbers[] = {
    {"converter",
     "reference",
     "",
     false,
     {Law::normal, 0.0, 0.005, 0.015},
     "AMS1117-3.3: 1 % at 25 degC, 1.5 % over temperature; scales every channel"},
    {"converter", "adc.offset.a", "V", false, kOffset_V, kOffset},
    {"converter", "adc.offset.b", "V", false, kOffset_V, kOffset},
    {"converter", "adc.offset.c", "V", false, kOffset_V, kOffset},
    {"converter", "adc.offset.bus", "V", false, kOffset_V, kOffset},
    {"converter", "adc.offset.shunt", "V", false, kOffset_V, kOffset},
    {"converter", "adc.gain.a", "", false, kGain_share, kGain},
    {"converter", "adc.gain.b", "", false, kGain_share, kGain},
    {"converter", "adc.gain.c", "", false, kGain_share, kGain},
    {"converter", "adc.gain.bus", "", false, kGain_share, kGain},
    {"converter", "adc.gain.shunt", "", false, kGain_share, kGain},
    {"converter", "adc.noise.a", "V", false, kNoise_V, kNoise},
    {"converter", "adc.noise.b", "V", false, kNoise_V, kNoise},
    {"converter", "adc.noise.c", "V", false, kNoise_V, kNoise},
    {"converter", "adc.noise.bus", "V", false, kNoise_V, kNoise},
    {"converter", "adc.noise.shunt", "V", false, kNoise_V, kNoise},
    {"dividers", "divider.a.upper", "", false, kOne_percent, kResistor},
    {"dividers", "divider.a.lower", "", false, kOne_percent, kResistor},
    {"dividers", "divider.b.upper", "", false, kOne_percent, kResistor},
    {"dividers", "divider.b.lower", "", false, kOne_percent, kResistor},
    {"dividers", "divider.c.upper", "", false, kOne_percent, kResistor},
    {"dividers", "divider.c.lower", "", false, kOne_percent, kResistor},
    {"dividers", "divider.bus.upper", "", false, kOne_percent, kResistor},
    {"dividers", "divider.bus.lower", "", false, kOne_percent, kResistor},
    {"shunt",
     "shunt.gain_error",
     "",
     false,
     {Law::even, 0.0, 0.0, 0.10},
     "[Bangura2017, 3.3.2]: within 10 % from board to board"},
    {"shunt",
     "shunt.offset",
     "A",
     false,
     {Law::even, 4.35, 0.0, 0.25},
     "[Bangura2017, 3.3.2]: 8.5e6 to 9.5e6 counts of 483 nA"},
    {"shunt",
     "shunt.pole",
     "",
     true,
     {Law::normal, 0.0, 0.07, 0.20},
     "5 % resistor and 10 % ceramic capacitor about the amplifier"},
    parts::torque_constant("motor"),
    parts::resistance("motor"),
    {"motor",
     "inductance",
     "",
     true,
     {Law::normal, 0.0, 0.10, 0.30},
     "estimate: air gap and lamination"},
    parts::no_load_current("motor"),
    parts::inertia("motor"),
    {"motor", "impedance.a", "", false, kPhase_impedance, kWindings},
    {"motor", "impedance.b", "", false, kPhase_impedance, kWindings},
    {"motor", "impedance.c", "", false, kPhase_impedance, kWindings},
    {"motor", "emf.a", "", false, kPhase_emf, kWindings},
    {"motor", "emf.b", "", false, kPhase_emf, kWindings},
    {"motor", "emf.c", "", false, kPhase_emf, kWindings},
    {"motor",
     "sine_share",
     "",
     false,
     {Law::even, 0.5, 0.0, 0.5},
     "between trapezoid and sine: outrunners with 12 slots and 14 magnets lie anywhere there"},
    {"motor",
     "cogging",
     "N m",
     false,
     {Law::level, 3e-3, 2e-3, 5e-3},
     "estimate: felt as 84 weak steps in a turn, less than the friction of 10 mN m"},
    {"motor",
     "diode_drop",
     "V",
     false,
     {Law::normal, 0.7, 0.07, 0.2},
     "body diodes: 0.5 V hot and little current, 0.9 V cold and much"},
    parts::heat_capacity("heat"),
    {"heat",
     "heat_resistance",
     "K/W",
     false,
     {Law::normal, 3.0, 0.3, 0.8},
     "22 to 27 K at 3 to 4 N in the propeller's wash"},
    {"heat",
     "ambient",
     "K",
     false,
     {Law::normal, 293.15, 5.0, 15.0},
     "a hall, or a field in summer"},
    parts::bearing_share("heat"),
    {"bus",
     "bus_esr",
     "ohm",
     false,
     {Law::level, 0.035, 0.015, 0.065},
     "470 uF 25 V low impedance, 30 to 50 mohm at 100 kHz; worst: an aged or a cold one"},
    {"bus", "bus_capacitance", "", true, {Law::normal, 0.0, 0.07, 0.20}, "electrolytic, 20 %"},
    parts::hse_error("clock"),
    {"clock",
     "hsi_error",
     "",
     false,
     {Law::normal, 0.0, 0.004, 0.01},
     "[F103] -1.1 to 1.8 % at 25 degC, after trimming 1 %"},
    {"instruments",
     "cell.thrust_gain",
     "",
     false,
     {Law::normal, 0.0, 0.002, 0.005},
     "bought stand (RCbenchmark 1580): 0.5 %"},
    {"instruments", "cell.torque_gain", "", false, {Law::normal, 0.0, 0.002, 0.005}, "the same"},
    {"instruments",
     "cell.thrust_offset",
     "N",
     false,
     {Law::normal, 0.0, 0.005, 0.015},
     "left by taring: a gram or so"},
    {"instruments",
     "cell.torque_offset",
     "N m",
     false,
     {Law::normal, 0.0, 2e-4, 6e-4},
     "left by taring"},
    {"instruments",
     "ammeter.gain",
     "",
     false,
     {Law::normal, 0.0, 0.004, 0.01},
     "bought stand: 1 %"},
    {"instruments", "ammeter.offset", "A", false, {Law::normal, 0.0, 0.01, 0.03}, "of 55 A"},
    {"instruments",
     "voltmeter.gain",
     "",
     false,
     {Law::normal, 0.0, 0.002, 0.005},
     "bought stand: 0.5 %"},
    {"instruments", "voltmeter.offset", "V", false, {Law::normal, 0.0, 0.01, 0.02}, "of 50 V"},
    {"instruments",
     "anemometer.gain",
     "",
     false,
     {Law::normal, 0.0, 0.02, 0.05},
     "thermal anemometer of the trade: 5 %"},
    {"instruments",
     "anemometer.offset",
     "m/s",
     false,
     {Law::normal, 0.0, 0.04, 0.1},
     "and 0.1 m/s"},
};

constexpr double kUpper_share = 10.0 / 11.5;  // of the divider's whole

}  // namespace

std::span<const PartNumber> esc_stand_numbers() {
  return kNumbers;
}

std::span<const char* const> esc_stand_groups() {
  return kStandGroups;
}

double divider_error(double upper_error, double lower_error) {
  const double upper = kUpper_share * (1.0 + upper_error);
  const double lower = (1.0 - kUpper_share) * (1.0 + lower_error);
  return lower / (upper + lower) / (1.0 - kUpper_share) - 1.0;
}

}  // namespace whirl::plant
