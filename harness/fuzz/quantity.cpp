// Fuzzes quantities with units, and the way back.
#include <cmath>
#include <tuple>

#include "base/units.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto quantity = whirl::parse_quantity(text, "");
  if (!quantity) return 0;
  WHIRL_CHECK(std::isfinite(quantity.value().value_SI));
  WHIRL_CHECK(!std::isnan(whirl::in_unit(quantity.value().value_SI, whirl::unit_symbol(text))));
  std::ignore = whirl::parse_duration_ns(text, "").ok();
  return 0;
}
