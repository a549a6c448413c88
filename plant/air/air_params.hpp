// What the air may do: all of it off by default.
//
//   Frame   W. Wind is the velocity of the air: (0, 2, 0) blows towards the east.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

namespace whirl::plant {

struct GustWindow {  // one gust, everywhere: rises and falls over `edge_s` as (1 - cos)/2
  double start_s = 0.0, duration_s = 0.0, edge_s = 0.05;  // duration includes both edges
  Eigen::Vector3d wind_W_mps = Eigen::Vector3d::Zero();
};

struct Jet {  // a round vertical stream: full inside, falling to 0 over the edge
  double north_m = 0.0, east_m = 0.0;
  double radius_m = 0.35;  // where it has fallen to half
  double edge_m = 0.10;    // width of the cosine edge
  double upward_mps = 3.5;
};

struct DrydenParams {  // MIL-F-8785C, low altitude; strength by the wind at 6 m (20 ft)
  double wind_at_6m_mps = 0.0;
  double wingspan_m = 0.5;  // the scale below which gusts average out over the vehicle
};

struct AirParams {
  double ground_temperature_offset_K = 0.0;                     // from the standard atmosphere
  double ground_height_m = 0.0;                                 // of W's origin above sea level
  std::optional<double> temperature_gradient_Kpm;               // upwards; none: the standard's
  Eigen::Vector3d steady_wind_W_mps = Eigen::Vector3d::Zero();  // at shear_height_m and above
  double shear_height_m = 0.0;  // logarithmic profile below it; 0: no shear
  double roughness_length_m = 0.03;
  DrydenParams dryden;
  std::vector<GustWindow> gusts;
  std::vector<Jet> jets;
};

}  // namespace whirl::plant
