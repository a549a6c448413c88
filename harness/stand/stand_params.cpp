#include "harness/stand/stand_params.hpp"

#include "harness/flight/propeller_file.hpp"

namespace whirl::stand {
namespace {

constexpr const char* kModes[] = {"duty",  "rpm",   "thrust_by_rpm",
                                  "servo", "power", "thrust_by_power"};

void read_feed(const lua::Table& t, plant::BatteryParams& battery) {
  if (t.has("battery") == t.has("supply")) {
    return t.refuse("battery", "a stand has a battery or a supply, one of the two");
  }
  if (t.has("supply")) {
    battery = plant::lab_supply(
        t.quantity("supply", Dimension::voltage, lua::between(1.0, 60.0)),
        t.quantity_or("supply_resistance", Dimension::resistance, 0.01, lua::between(0.001, 1.0)));
    return;
  }
  std::ignore = t.choice("battery", {"4s_2200"});
  battery = plant::lipo_4s_2200();
  battery.initial_depth_of_discharge =
      t.quantity_or("depth_of_discharge", Dimension::ratio, 0.0, lua::between(0.0, 1.0));
  // The others of a vehicle draw the rest: this motor sees as much of the pack.
  const double share = t.quantity_or("battery_share", Dimension::ratio, 1.0, lua::between(0.01, 1));
  battery.capacity_C *= share;
  battery.series_resistance_ohm /= share;
  battery.relaxation_resistance_ohm /= share;
}

io::EscMode read_mode(const lua::Table& t) {
  if (!t.has("mode")) return io::EscMode::thrust_by_rpm;
  const std::string word = t.choice("mode", {std::begin(kModes), std::end(kModes)});
  for (std::size_t i = 0; i < std::size(kModes); ++i) {
    if (word == kModes[i]) return static_cast<io::EscMode>(i);
  }
  return io::EscMode::thrust_by_rpm;  // refused by choice() already
}

double read_pulse_rate(const lua::Table& t) {
  const bool pulses = t.has("throttle") && t.choice("throttle", {"i2c", "pwm"}) == "pwm";
  if (!pulses) return 0.0;
  return t.quantity_or("pulse_rate", Dimension::frequency, 50.0, lua::between(50.0, 400.0));
}

}  // namespace

Result<StandParams> read_stand(const lua::Table& t, const std::string& propellers) {
  StandParams p;
  const std::string prop = t.text("prop");
  read_feed(t, p.battery);
  p.stage = read_stage(t);
  p.mode = read_mode(t);
  p.address = static_cast<std::uint8_t>(t.integer_or("address", p.address, 0x08, 0x77));
  p.pulse_rate_Hz = read_pulse_rate(t);
  p.i2c = static_cast<std::uint16_t>(t.integer_or("i2c", p.i2c, 1, 3));
  p.serial = static_cast<std::uint16_t>(t.integer_or("serial", p.serial, 1, 8));
  if (const auto good = t.finish(); !good) return good.error();
  auto blade = flight::read_propeller(propellers + "/" + prop + ".lua");
  if (!blade) return blade.error();
  p.blade = blade.value();
  return p;
}

}  // namespace whirl::stand
