#include "harness/plan/waypoint_file.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

namespace whirl::plan {
namespace {

constexpr std::size_t kMost_waypoints = 1000;

struct WaypointBounds {
  const char* what;
  double low, high;
};
constexpr WaypointBounds kBounds[] = {
    {"x", -1000.0, 1000.0}, {"y", -1000.0, 1000.0}, {"z", -1000.0, -0.01},
    {"yaw", -360.0, 360.0}, {"hold", 0.0, 3600.0},
};

std::string shown(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

// What is wrong with the line; empty: nothing, and the numbers are in `values`.
std::string read_numbers(const std::string& line, std::vector<double>& values) {
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    if (values.size() == std::size(kBounds)) return "more than x y z yaw hold";
    const WaypointBounds& bounds = kBounds[values.size()];
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
      return std::string(bounds.what) + ": '" + word + "' is no number";
    }
    if (!(value >= bounds.low && value <= bounds.high)) {
      return std::string(bounds.what) + ": " + word + " is outside " + shown(bounds.low) + " .. " +
             shown(bounds.high);
    }
    values.push_back(value);
  }
  return values.size() < 4 && !values.empty() ? "less than x y z yaw" : "";
}

}  // namespace

Result<std::vector<request::Waypoint>> waypoints_of(const std::string& name,
                                                    const std::string& text) {
  std::vector<request::Waypoint> all;
  std::istringstream lines(text);
  int number = 0;
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorKind::bad_input, name + ":" + std::to_string(number), what,
                 "write x y z yaw [hold]: metres, z downwards, degrees, seconds"};
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::vector<double> v;
    if (const std::string what = read_numbers(line.substr(0, line.find('#')), v); !what.empty()) {
      return wrong(what);
    }
    if (v.empty()) continue;
    if (all.size() == kMost_waypoints) return wrong("more than 1000 waypoints");
    all.push_back({v[0], v[1], v[2], v[3] * std::numbers::pi / 180.0, v.size() == 5 ? v[4] : 0.0});
  }
  if (all.empty()) return wrong("no waypoint in the whole file");
  return all;
}

}  // namespace whirl::plan
