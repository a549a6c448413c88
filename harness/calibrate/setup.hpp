// What is to be calibrated, and the points to measure.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace whirl::calibrate {

struct Setup {
  std::string file, image, board;
  std::uint16_t serial = 1;  // the ESC's line, as the stand numbers it
  double diameter_m = 0.0;
  double density_kgpm3 = 1.225;
  std::vector<double> still, blown;          // duties
  double low_duty = 0.47, high_duty = 0.54;  // of the transients
  std::vector<double> winds_mps;
  double updraft_mps = 3.0;  // 0: none
  // Of the density here, as a share: how far off it is when the ESC flies.
  double air_within = 0.03;
  std::int64_t warm_up_ms = 0, settle_ms = 700, measure_ms = 800;
  bool tell_motor = false;
  std::uint64_t seed = 1;
};

}  // namespace whirl::calibrate
