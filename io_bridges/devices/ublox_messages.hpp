// A solution as UBX messages of class NAV, and the version message; field by field in ublox.hpp.
#pragma once
#include <optional>

#include "io_bridges/devices/gnss_epoch.hpp"
#include "io_bridges/devices/ublox_config.hpp"

namespace whirl::io::ublox {

// Empty: no message of that id is modelled.
std::optional<UbxFrame> nav_message(std::uint8_t id, const GnssEpoch& epoch);
UbxFrame version_message(UbloxModel model, const std::string& hardware);
std::string hardware_version(UbloxModel model);  // "00040007"

}  // namespace whirl::io::ublox
