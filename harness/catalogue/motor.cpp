#include "harness/catalogue/motor.hpp"

#include <algorithm>
#include <numbers>

#include "base/rpm.hpp"
#include "harness/catalogue/amount.hpp"
#include "harness/catalogue/motor_file.hpp"

namespace whirl::catalogue {
namespace {

using lua::above;
using lua::at_least;

// What a running motor shows as resistance beyond its own.
double commutation_ohm(const lua::Table& t, const plant::MotorParams& m) {
  const double fitted_radps =
      t.quantity_or("resistance_fitted_at", Dimension::angular_rate, 0.0, at_least(0.0));
  const double ohm = 1.5 / std::numbers::pi * m.pole_pairs * fitted_radps * m.inductance_H;
  if (fitted_radps <= 0.0 || ohm < m.resistance_ohm) return ohm;
  t.refuse("resistance_fitted_at",
           "at this speed commutation alone looks like more than the whole resistance");
  return 0.0;
}

}  // namespace

plant::MotorParams read_motor(const lua::Table& t, MissingKeys missing) {
  plant::MotorParams m;
  if (t.has("file") && t.kind("file") == lua::Kind::text) {
    const auto file = read_motor_file(t.sibling(t.text("file")));
    if (file) m = file.value().params;
    if (!file) t.refuse("file", file.error().message());
    missing = MissingKeys::as_in_plant;
  }
  const auto read = [&](const char* key, Dimension dimension, double& value, lua::Range range) {
    if (t.has(key)) {
      value = read_amount(t, key, dimension, value, range);
    } else if (missing == MissingKeys::refused) {
      t.quantity(key, dimension, range);
    }
  };
  double kv = rpm_of(1.0 / m.torque_constant_NmpA);
  read("kv_rpm_per_V", Dimension::none, kv, lua::between(10.0, 1e5));
  if (t.has("kv_rpm_per_V") && kv > 0.0) m.torque_constant_NmpA = torque_constant_NmpA_of(kv);
  read("resistance", Dimension::resistance, m.resistance_ohm, above(0.0));
  m.winding_resistance_ohm = t.quantity_or("winding_resistance", Dimension::resistance,
                                           m.winding_resistance_ohm, above(0.0));
  if (t.has("inductance")) {
    m.inductance_H =
        read_amount(t, "inductance", Dimension::inductance, m.inductance_H, above(0.0));
  } else if (missing == MissingKeys::refused) {
    // Data sheets keep quiet about it: 0.2 ms x resistance is usual among outrunners.
    m.inductance_H = 2e-4 * m.resistance_ohm;
  }
  read("no_load_current", Dimension::current, m.no_load_current_A, at_least(0.0));
  read("inertia", Dimension::inertia, m.inertia_kgm2, above(0.0));
  m.pole_pairs = static_cast<int>(t.integer_or("pole_pairs", m.pole_pairs, 1, 100));
  m.resistance_ohm -= commutation_ohm(t, m);
  m.winding_resistance_ohm = std::min(m.winding_resistance_ohm, m.resistance_ohm);
  return m;
}

}  // namespace whirl::catalogue
