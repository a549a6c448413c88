// The firmware's own logs out of a run's card images into its folder: flight.ulg, flight_2.ulg and so
// on, in the order of cards and numbers. A file that was not closed is copied as far as its messages go.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::results {

struct FlightLogRow {
  std::string file;        // "flight.ulg"; empty: it has no message, and was not copied
  std::string card, name;  // "card.img", "LOG00001.ULG"
  std::size_t bytes = 0, samples = 0, dropouts = 0;
  bool closed = false;
  double from_s = 0, to_s = 0;  // of the samples, by the firmware's clock
  std::string damage;
};

// An image without a FAT32 volume has no logs.
// Errors  host: a copy cannot be written
Result<std::vector<FlightLogRow>> copy_flight_logs(const std::string& folder);

}  // namespace whirl::results
