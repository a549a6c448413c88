// A GPS receiver's fixes: few, late, with errors that wander.
//
//   Frame   W (the receiver's own datum is the protocol's matter)
//   Method  every period a fix is taken; it comes out after the latency. Position error: wander of second
//           order + white; velocity error white. Dropouts by window or by chance.
//   Level   2.12 m per axis: half of all fixes lie within 2.5 m (CEP = 1.1774 sigma), as data sheets of
//           single-frequency receivers state. Down: 4.5 m, a VDOP of 1.5 times the HDOP. Velocity: 0.1 m/s
//           for half of all fixes is 0.085 m/s per axis
//   Rate    a receiver's own filter carries its place along by the Doppler shifts, so place and velocity
//           agree: the wander's rate, 2 level / time = 0.071 m/s per axis, is of the velocity's error. Of
//           first order it would leap by 0.17 m a fix, a velocity of 0.9 m/s that no receiver shows
//   Error   CEP within 5 % over seeds (tests/slow_sensors_test.cpp)
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "plant/sensors/noise.hpp"
#include "plant/sensors/truth.hpp"

namespace whirl::plant {

struct GpsParams {
  double period_s = 0.2;
  double latency_s = 0.12;
  double wander_level_m = 2.12, wander_down_m = 4.5, wander_time_s = 60.0;
  double white_level_m = 0.05, white_down_m = 0.1;
  double velocity_level_mps = 0.085, velocity_down_mps = 0.15;
  double dropout_chance = 0.0;  // of each fix
};

struct Outage {  // of a sensor, by time
  double start_s = 0.0, duration_s = 0.0;
  bool covers(double t_s) const { return t_s >= start_s && t_s < start_s + duration_s; }
};

struct GpsFix {
  double taken_s = 0.0;
  Eigen::Vector3d p_WB_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB_W_mps = Eigen::Vector3d::Zero();
  double level_accuracy_m = 0.0, down_accuracy_m = 0.0, velocity_accuracy_mps = 0.0;
};

class Gps {
 public:
  Gps(const GpsParams& params, std::uint64_t seed, const std::string& name = "gps");
  void add_outage(const Outage& outage) { outages_.push_back(outage); }

  // A fix taken now, whatever the period. Times must not fall; the errors grow by error_scale.
  GpsFix measure(double t_s, const Truth& truth, double error_scale = 1.0);
  // Call at least once per millisecond or so; returns a fix when one comes out.
  std::optional<GpsFix> step(double t_s, const Truth& truth);

 private:
  GpsParams params_;
  std::vector<SmoothWander> wander_;
  std::vector<RandomStream> white_, velocity_;
  RandomStream chance_;
  std::vector<Outage> outages_;
  std::deque<GpsFix> on_the_way_;
  std::int64_t taken_ = 0;
  double measured_s_ = 0.0;
};

}  // namespace whirl::plant
