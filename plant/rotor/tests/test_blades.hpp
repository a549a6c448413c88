// Blades for the tests: the Hobbyking from its data, and a plain one with a straight lift line.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "plant/rotor/blade_rings.hpp"
#include "plant/rotor/hobbyking_10x4_5.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::plant {

inline std::string data_text(const std::string& path) {
  std::ifstream in(std::string(WHIRL_DATA) + "/" + path);
  EXPECT_TRUE(in) << path;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::shared_ptr<const PolarFamily> section(const std::string& name) {
  return std::make_shared<PolarFamily>(
      read_polar(data_text("polars/" + name + ".polar"), name).value());
}

inline std::shared_ptr<const Blade> hobbyking() {
  static const auto blade = make_blade(hobbyking_10x4_5(section("bw3"), section("e63"))).value();
  return blade;
}

// cl = cl0 + slope alpha up to 45 deg, cd = cd0 + K cl^2.
struct StraightSection {
  double cl0 = 0.0;
  double slope = 5.7;
  double cd0 = 0.01;
  double K = 0.0;

  std::shared_ptr<const PolarFamily> family() const {
    PolarCurve curve{1e3, {}};
    for (double deg = -45.0; deg <= 45.0; deg += 0.5) {
      const double alpha = deg * 3.14159265358979323846 / 180.0;
      const double cl = cl0 + slope * alpha;
      curve.rows.push_back({alpha, cl, cd0 + K * cl * cl});
    }
    PolarCurve same = curve;  // whatever the Reynolds number
    same.reynolds = 1e8;
    return std::make_shared<PolarFamily>("straight", std::vector<PolarCurve>{curve, same});
  }
};

inline RotorConditions hover(double rpm) {
  RotorConditions c;
  c.omega_radps = rpm * 3.14159265358979323846 / 30.0;
  return c;
}

}  // namespace whirl::plant
