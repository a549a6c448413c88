#include "harness/live/stick_file.hpp"

#include <algorithm>

#include "harness/lua/table.hpp"

namespace whirl::live {
namespace {

constexpr int kMostAxes = 16, kMostButtons = 128;

io::AxisCalibration calibration_of(const lua::Table& t, bool has_middle) {
  io::AxisCalibration axis;
  axis.min = t.number("min");
  axis.max = t.number("max");
  axis.has_middle = has_middle;
  const double middle = 0.5 * (axis.min + axis.max);
  axis.centre = has_middle ? t.number_or("centre", middle) : middle;
  axis.dead_zone = has_middle ? t.number_or("dead_zone", 0.0) : 0.0;
  axis.reversed = t.flag_or("reversed", false);
  if (!axis.rises()) t.refuse("max", "min, centre and max do not rise");
  return axis;
}

// An axis of the device that no stick is mapped to has no calibration of its own.
constexpr io::AxisCalibration kUnused{0.0, 0.5, 1.0};

void read_axes(const lua::Table& t, StickMap& map) {
  const char* names[] = {"roll", "pitch", "yaw", "thrust"};
  for (std::size_t i = 0; i < map.axis.size(); ++i) {
    if (!t.has(names[i])) continue;
    const lua::Table one = t.table(names[i]);
    const auto number = static_cast<std::size_t>(one.integer("axis", 1, kMostAxes));
    map.axis[i] = number;
    if (map.calibrations.size() < number) map.calibrations.resize(number, kUnused);
    map.calibrations[number - 1] = calibration_of(one, i != StickMap::thrust);
  }
  if (map.axis[StickMap::thrust] == 0) t.refuse("thrust", "is missing: nothing would lift it");
}

}  // namespace

Result<StickMap> read_stick(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  StickMap map;
  map.device.kind = t.text("stick");
  map.device.vendor = static_cast<std::uint16_t>(t.integer("vendor", 0, 0xFFFF));
  map.device.product = static_cast<std::uint16_t>(t.integer("product", 0, 0xFFFF));
  map.device.serial = t.text_or("serial", "");
  read_axes(t.table("axes"), map);
  map.arm = static_cast<std::size_t>(t.integer_or("arm", 0, 0, kMostButtons));
  if (t.has("modes")) {
    for (const double number : t.numbers("modes", lua::between(1.0, kMostButtons))) {
      map.modes.push_back(static_cast<std::size_t>(number));
    }
    if (map.modes.size() > 3) t.refuse("modes", "the switch has three positions");
  }
  if (const auto good = t.finish(); !good) return good.error();
  return map;
}

}  // namespace whirl::live
