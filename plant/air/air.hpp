// The air around one vehicle: what it weighs and where it goes, at any point.
//
//   Frame   W; `wind` is the velocity of the air
//   Order   step() moves time on, draws turbulence for where the vehicle is; wind_W_mps() may then be
//           asked at each rotor
//   Left out the vehicle's own wake (the rotor's business), walls
#pragma once
#include <cstdint>

#include "plant/air/air_params.hpp"
#include "plant/air/atmosphere.hpp"
#include "plant/air/dryden.hpp"

namespace whirl::plant {

class Air {
 public:
  Air(const AirParams& params, std::uint64_t seed);

  void step(const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& v_W_mps, double dt_s);

  Eigen::Vector3d wind_W_mps(const Eigen::Vector3d& p_W_m) const;
  Atmosphere at(const Eigen::Vector3d& p_W_m) const;
  double time_s() const { return t_s_; }

  void set_steady_wind(const Eigen::Vector3d& wind_W_mps) {
    params_.steady_wind_W_mps = wind_W_mps;
  }
  void add_gust(const GustWindow& gust) { params_.gusts.push_back(gust); }
  void add_jet(const Jet& jet) { params_.jets.push_back(jet); }

 private:
  Eigen::Vector3d mean_wind(double height_m) const;

  AirParams params_;
  Dryden dryden_;
  double t_s_ = 0.0;
  Eigen::Vector3d centre_W_m_ = Eigen::Vector3d::Zero();  // where the turbulence was drawn
  Eigen::Vector3d turbulence_W_mps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d turning_W_radps_ = Eigen::Vector3d::Zero();
};

double window(const GustWindow& gust, double t_s);              // 0..1
double profile(const Jet& jet, double north_m, double east_m);  // 0..1

}  // namespace whirl::plant
