// Which sections a blade gets when nobody measured them: by its thickness alone.
//
//   Rule    thin (up to 0.085 of the chord at 0.75 R: slow flyers, GWS): the measured BW-3 cambered
//           plate inboard, changing to the measured NACA 6409 at 0.9 R. Thicker (electric, sport,
//           CAM slim): NACA 4412 all along, computed; no measured section of that kind is in the house.
//   Why so  a moulded slow flyer is an undercambered sheet that fills up towards the tip; NACA 6409
//           stalls early below Re 1e5, which thin blades with 2 to 5 deg less at the root never meet
//           and thick ones with their steep roots would, falsely.
//   Source  [UiucAirfoil], [Xflr5]
#pragma once
#include <string>
#include <vector>

namespace whirl::plant {

inline constexpr double kThin_up_to = 0.085;  // thickness over chord at 0.75 R

struct NamedSection {
  double r_over_R = 0.0;
  std::string polar;  // "bw3": plant/data/polars/bw3.polar
};

inline std::vector<NamedSection> sections_for(double thickness_over_chord) {
  if (thickness_over_chord > kThin_up_to) return {{0.2, "naca4412"}};
  return {{0.2, "bw3"}, {0.9, "naca6409"}};
}

}  // namespace whirl::plant
