#include "plant/parts/spread.hpp"

#include <cmath>

#include "base/check.hpp"
#include "base/random.hpp"

namespace whirl::plant {
namespace {

constexpr ToleranceClass kAll[] = {ToleranceClass::none, ToleranceClass::typical,
                                   ToleranceClass::worst};

double typical(const Spread& s, RandomStream& random) {
  switch (s.law) {
    case Spread::Law::normal:
      for (;;) {  // what lies beyond the limit is not sold
        const double off = s.sigma * random.normal();
        if (std::abs(off) <= s.limit) return s.middle + off;
      }
    case Spread::Law::even:
      return s.middle + s.limit * (2.0 * random.uniform() - 1.0);
    case Spread::Law::level:
      return s.middle + s.sigma * (2.0 * random.uniform() - 1.0);
  }
  return s.middle;
}

}  // namespace

const char* name(ToleranceClass tolerance) {
  switch (tolerance) {
    case ToleranceClass::none:
      return "none";
    case ToleranceClass::typical:
      return "typical";
    case ToleranceClass::worst:
      return "worst";
  }
  return "";
}

std::optional<ToleranceClass> tolerance_named(std::string_view word) {
  for (const ToleranceClass each : kAll) {
    if (word == name(each)) return each;
  }
  return std::nullopt;
}

double draw(const Spread& s, ToleranceClass tolerance, std::uint64_t seed,
            const std::string& stream) {
  WHIRL_CHECK(tolerance != ToleranceClass::none && s.sigma >= 0.0 && s.limit >= 0.0, stream);
  RandomStream random(seed, stream);
  if (tolerance == ToleranceClass::typical) return typical(s, random);
  if (s.law == Spread::Law::level) return s.middle + s.limit;
  return random.uniform() < 0.5 ? s.middle - s.limit : s.middle + s.limit;
}

DrawRange bounds(const Spread& s, ToleranceClass tolerance) {
  WHIRL_CHECK(tolerance != ToleranceClass::none);
  if (s.law != Spread::Law::level) return {s.middle - s.limit, s.middle + s.limit};
  if (tolerance == ToleranceClass::typical) return {s.middle - s.sigma, s.middle + s.sigma};
  return {s.middle + s.limit, s.middle + s.limit};
}

}  // namespace whirl::plant
