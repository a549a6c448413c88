#include "harness/catalogue/kind.hpp"

#include "harness/lua/table.hpp"

namespace whirl::catalogue {

Result<std::string> read_kind(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  return file.value().text_or("kind", "");
}

Error no_part(const std::string& path) {
  const auto kind = read_kind(path);
  if (kind && kind.value() == "battery") {
    return {
        ErrorKind::bad_input, path, "is a battery: it has no steady curve to sweep",
        "sweep a vehicle whose battery = { file = ... } names it: hover's current and time; whirl "
        "validate without a file: measured discharges"};
  }
  return {ErrorKind::bad_input, path, "is no propeller, motor, stand or vehicle",
          R"(kind = "propeller", "motor", "calibration" (a stand) or "vehicle")"};
}

}  // namespace whirl::catalogue
