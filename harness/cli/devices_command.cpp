#include "harness/cli/devices_command.hpp"

#include <cstdio>

#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/type_table.hpp"

namespace whirl::cli {

int devices_command() {
  std::fputs(rack::type_table(rack::device_types()).c_str(), stdout);
  return 0;
}

}  // namespace whirl::cli
