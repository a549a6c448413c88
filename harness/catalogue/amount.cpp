#include "harness/catalogue/amount.hpp"

namespace whirl::catalogue {

double read_amount(const lua::Table& t, std::string_view key, Dimension dimension, double own_SI,
                   lua::Range range) {
  if (t.kind(key) != lua::Kind::text) return t.quantity(key, dimension, range);
  const auto share = parse_quantity_as(t.text(key), Dimension::ratio, "");
  if (!share) return t.quantity(key, dimension, range);
  if (!lua::between(-0.95, 10.0).holds(share.value())) {
    t.refuse(key, t.text(key) + " is outside -95 %..1000 %");
  }
  return own_SI * (1.0 + share.value());
}

}  // namespace whirl::catalogue
