#include "harness/catalogue/feed.hpp"

#include "harness/catalogue/battery_file.hpp"

namespace whirl::catalogue {
namespace {

using lua::between;

const std::vector<std::string> kPacks = {"4s_2200"};

plant::BatteryParams whose(const lua::Table& t) {
  if (t.has("file") && t.has("pack")) {
    t.refuse("file", "a file or one of the plant's packs is wanted, one of the two");
  }
  if (!t.has("file")) {
    std::ignore = t.choice("pack", kPacks);
    return plant::lipo_4s_2200();
  }
  const auto read = read_battery_file(t.sibling(t.text("file")));
  if (read) return read.value();
  t.refuse("file", read.error().message());
  return plant::lipo_4s_2200();
}

plant::BatteryParams read_pack(const lua::Table& t) {
  plant::BatteryParams b = whose(t);
  b.capacity_C = t.quantity_or("capacity", Dimension::charge, b.capacity_C, lua::above(0.0));
  b.series_resistance_ohm = t.quantity_or("resistance", Dimension::resistance,
                                          b.series_resistance_ohm, lua::at_least(0.0));
  b.initial_depth_of_discharge = t.quantity_or("depth_of_discharge", Dimension::ratio,
                                               b.initial_depth_of_discharge, between(0.0, 1.0));
  b.temperature_K = t.quantity_or("temperature", Dimension::temperature, b.temperature_K);
  if (t.has("temperature") && b.resistance_over_temperature.empty()) {
    t.refuse("temperature", "this pack tells nothing of its resistance over temperature",
             "a file with resistance_over_temperature, or no temperature");
  }
  const double share = t.quantity_or("share", Dimension::ratio, 1.0, between(0.01, 1.0));
  if (share > 0.0) {
    b.capacity_C *= share;
    b.series_resistance_ohm /= share;
    b.relaxation_resistance_ohm /= share;
    b.slow_relaxation_resistance_ohm /= share;
  }
  if (const auto good = plant::validate(b, "battery"); !good) {
    t.refuse(t.has("temperature") ? "temperature" : "pack", good.error().what);
  }
  return b;
}

plant::BatteryParams read_battery(const lua::Table& t) {
  if (t.kind("battery") == lua::Kind::table) return read_pack(t.table("battery"));
  std::ignore = t.choice("battery", kPacks);
  return plant::lipo_4s_2200();
}

plant::BatteryParams read_supply(const lua::Table& t) {
  constexpr double kLeads_ohm = 0.01;
  const lua::Range volts = between(1.0, 60.0);
  if (t.kind("supply") != lua::Kind::table) {
    return plant::lab_supply(t.quantity("supply", Dimension::voltage, volts), kLeads_ohm);
  }
  const lua::Table supply = t.table("supply");
  return plant::lab_supply(
      supply.quantity("voltage", Dimension::voltage, volts),
      supply.quantity_or("resistance", Dimension::resistance, kLeads_ohm, between(0.0, 1.0)));
}

}  // namespace

plant::BatteryParams read_feed(const lua::Table& t) {
  if (t.has("battery") != t.has("supply")) {
    return t.has("battery") ? read_battery(t) : read_supply(t);
  }
  t.refuse("battery", "a battery or a supply is wanted, one of the two",
           "battery = \"4s_2200\", or supply = \"16 V\"");
  return plant::lipo_4s_2200();
}

}  // namespace whirl::catalogue
