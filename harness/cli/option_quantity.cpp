#include "harness/cli/option_quantity.hpp"

namespace whirl::cli {

Result<Done> read_within(const std::string& text, Dimension dimension, const char* option,
                         const char* low, const char* high, double& into) {
  if (text.empty()) return Done{};
  const auto value = parse_quantity_as(text, dimension, option);
  if (!value) return value.error();
  const double least = parse_quantity_as(low, dimension, "").value();
  const double most = parse_quantity_as(high, dimension, "").value();
  if (!(value.value() >= least && value.value() <= most)) {
    return Error{ErrorKind::bad_input, option, "'" + text + "' is outside " + low + " to " + high,
                 ""};
  }
  into = value.value();
  return Done{};
}

}  // namespace whirl::cli
