#include "plant/parts/part_number.hpp"

namespace whirl::plant {

std::optional<double> draw(const PartNumber& part, const Tolerances& chosen, std::uint64_t seed,
                           const std::string& stream) {
  const auto tolerance = chosen.find(part.group);
  if (tolerance == chosen.end() || tolerance->second == ToleranceClass::none) return std::nullopt;
  return draw(part.spread, tolerance->second, seed, stream);
}

}  // namespace whirl::plant
