#include "harness/catalogue/shunt.hpp"

namespace whirl::catalogue {

plant::CurrentShuntParams read_shunt(const lua::Table& t) {
  plant::CurrentShuntParams s;
  const auto amperes = [&t](const char* key, double fallback_A) {
    return t.quantity_or(key, Dimension::current, fallback_A, lua::between(0.0, 20.0));
  };
  if (t.has("gain") && t.has("gain_tolerance")) {
    t.refuse("gain", "is known, or drawn within a tolerance", "one of the two");
  }
  s.gain_tolerance =
      t.quantity_or("gain_tolerance", Dimension::ratio, s.gain_tolerance, lua::between(0.0, 0.5));
  if (t.has("gain")) {
    s.gain_error = t.quantity("gain", Dimension::ratio, lua::between(-0.5, 0.5));
    s.gain_tolerance = 0.0;
  }
  if (t.has("offset")) s.offset_low_A = s.offset_high_A = amperes("offset", 0.0);
  s.warm_up_A = amperes("warm_up", s.warm_up_A);
  s.wander_A = amperes("wander", s.wander_A);
  if (t.has("noise")) {
    s.noise_A = amperes("noise", 0.0);
    s.noise_per_A = 0.0;
  }
  return s;
}

}  // namespace whirl::catalogue
