#include "io_bridges/board_description/board_description.hpp"

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdio>

#include "io_bridges/board_description/bus_kind.hpp"
#include "io_bridges/board_description/bus_name.hpp"

namespace whirl {
namespace {

bool set_whole(const KeyValue& value, int& into) {
  const double* number = std::get_if<double>(&value);
  if (number == nullptr || !(std::abs(*number) <= INT_MAX) || *number != std::floor(*number)) {
    return false;
  }
  into = static_cast<int>(*number);
  return true;
}

}  // namespace

std::optional<KeyValue> BoardDevice::value(std::string_view path) const {
  if (path == "bus") return bus.empty() ? std::nullopt : std::optional<KeyValue>(bus);
  if (path == "address")
    return address == -1 ? std::nullopt : std::optional<KeyValue>(address * 1.0);
  if (path == "motor") return motor == 0 ? std::nullopt : std::optional<KeyValue>(motor * 1.0);
  const auto it = keys.find(path);
  return it == keys.end() ? std::nullopt : std::optional<KeyValue>(it->second);
}

bool BoardDevice::set(const std::string& path, KeyValue value) {
  if (path == "address") return set_whole(value, address);
  if (path == "motor") return set_whole(value, motor);
  if (path == "bus") {
    const auto* text = std::get_if<std::string>(&value);
    if (text != nullptr) bus = *text;
    return text != nullptr;
  }
  keys[path] = std::move(value);
  return true;
}

std::vector<std::string> BoardDevice::paths() const {
  std::vector<std::string> all;
  for (const char* path : {"bus", "address", "motor"}) {
    if (value(path)) all.emplace_back(path);
  }
  for (const auto& [path, given] : keys) all.push_back(path);
  return all;
}

const BoardDevice* BoardDescription::find(const std::string& device) const {
  const int i = number(device);
  return i < 0 ? nullptr : &devices[static_cast<std::size_t>(i)];
}

int BoardDescription::number(const std::string& device) const {
  const auto it = std::find_if(devices.begin(), devices.end(),
                               [&](const BoardDevice& d) { return d.name == device; });
  return it == devices.end() ? -1 : static_cast<int>(it - devices.begin());
}

std::map<int, double> BoardDescription::bauds_Hz() const {
  std::map<int, double> all;
  for (const BoardDevice& device : devices) {
    const auto number = bus_number(device.bus);
    const auto baud = device.value("baud");
    if (!number || !baud || !std::holds_alternative<double>(*baud)) continue;
    if (!is_uart(device.bus)) continue;
    all[*number] = std::get<double>(*baud);
  }
  return all;
}

int BoardDescription::watch_number(const std::string& function) const {
  const auto it = std::find(watch.begin(), watch.end(), function);
  return it == watch.end() ? -1 : static_cast<int>(it - watch.begin());
}

std::string BoardDescription::timing_profile() const {
  char text[80];
  std::snprintf(text, sizeof text, "crystal ready after %g ms",
                static_cast<double>(hse_start_ns) * 1e-6);
  std::string clocks = text;
  if (hse_error != 0) {
    std::snprintf(text, sizeof text, ", %+g ppm off", hse_error * 1e6);
    clocks += text;
  }
  if (hsi_error != 0) {
    std::snprintf(text, sizeof text, ", HSI %+g %% off", hsi_error * 1e2);
    clocks += text;
  }
  const std::string rate = ns_per_instruction == 0
                               ? "CPU cycles (+-10 %)"
                               : std::to_string(ns_per_instruction) + " ns per instruction";
  return rate + ", " + clocks;
}

}  // namespace whirl
