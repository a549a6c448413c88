// A solution as the NMEA sentences that a u-blox receiver sends by default. GSV (satellites in view)
// is left out: no satellite has a place in the sky here.
//
//   Source  u-blox 6 receiver description, chapter NMEA; the layout of each sentence is NMEA 0183's
#pragma once
#include <optional>
#include <string>

#include "io_bridges/devices/gnss_epoch.hpp"

namespace whirl::io::ublox {

// id as in UBX CFG-MSG, class F0. Whole, with checksum and line end; empty: not modelled.
std::optional<std::string> nmea_message(std::uint8_t id, const GnssEpoch& epoch);

}  // namespace whirl::io::ublox
