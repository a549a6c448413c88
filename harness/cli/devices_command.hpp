// whirl devices: the types of devices that a board file may name, and their keys.
#pragma once

namespace whirl::cli {

int devices_command();

}  // namespace whirl::cli
