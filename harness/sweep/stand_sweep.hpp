// A thrust stand (motor, propeller, feed) beside measured rows of it.
//
//   With a duty   in each row: the drive at that duty; speed, current, thrust and torque are foretold
//   Without one   the drive that turns as fast as the row; current, thrust and torque are foretold, for pulse
//                 lengths tell no duty
//   Bus           the row's V; without that column the stand's own feed, under the current that is foretold
//   Judged        WMAPE of each
#pragma once
#include <map>
#include <string>
#include <vector>

#include "harness/sweep/drive_rows.hpp"
#include "harness/sweep/sweep.hpp"

namespace whirl::sweep {

// What of a drive may be off: speed 3 %, and thrust, torque and current as much as nine in ten propellers that
// were left out are.
struct Allowed {
  const char* what;
  double percent;
};
inline constexpr Allowed kStand_allowed[] = {
    {"speed", 3.0}, {"current", 14.0}, {"thrust", 12.0}, {"torque", 14.0}};

struct StandSweep {
  std::vector<results::Chart> charts;
  std::map<std::string, double>
      off_percent;  // WMAPE of what was measured, by kStand_allowed's names
  int rows = 0;
};
// `stand`: its motor, battery, blade and controller count. Rows alone, and with the curves of the drive.
Result<StandSweep> stand_rows(const flight::FlightParams& stand, const Options& options,
                              const std::vector<DriveFile>& measured);
Result<StandSweep> stand_sweep(const flight::FlightParams& stand, const Options& options,
                               const std::vector<DriveFile>& measured);

}  // namespace whirl::sweep
