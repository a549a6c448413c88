// An attitude that is asked for, by sticks or by steps, made flyable: roll, pitch and yaw rate as the
// vehicle can follow them, with the angular acceleration that its rotors have to be asked for in time.
//
//   Shape    roll, pitch: three moving means with a limit of speed after the first; so a step is an S of
//            finite length whose angular acceleration is continuous, and steps of any size and streams of
//            sticks add up. Yaw rate: limit of acceleration, then one mean
//   Lead     the ESC is a lag, its set-points are held for 20 ms. So the vehicle is asked for what the
//            profile was 40 ms ago, and the rotors for the mean of acceleration + lag x its change over
//            the 20 ms that the set-point will hold: then the thrust's own impulse is the profile's. What the
//            next hold will ask for is told with it, so that the rotors can be brought up in time (mixer.hpp)
//   Limits   roll, pitch 35 deg, yaw rate 120 deg/s; the lengths by the room that the rotors have about
//            hover, see attitude_reference.cpp
//   Step     5 ms, the attitude task's
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "firmware/control/desired_attitude.hpp"
#include "firmware/math.hpp"

namespace fw {

struct AttitudeDemand {
  float roll_rad = 0.0f, pitch_rad = 0.0f, yaw_rate_radps = 0.0f;
  std::optional<float> yaw_rad = {};  // where the heading shall come to be, beside its rate
};
// Of an attitude less than 90 degrees from level.
AttitudeDemand demand_of(const Quaternion& q_WB, float yaw_rate_radps);

// The mean of the last kSteps values.
template <std::size_t kSteps>
class MovingMean {
 public:
  void fill(float value) { last_.fill(value); }
  float step(float value) {
    last_[next_] = value;
    next_ = (next_ + 1) % kSteps;
    float sum = 0.0f;  // anew each time: a running sum would gather round-off
    for (const float each : last_) sum += each;
    return sum / static_cast<float>(kSteps);
  }

 private:
  std::array<float, kSteps> last_{};
  std::size_t next_ = 0;
};

class AttitudeReference {
 public:
  static constexpr float kTiltLimit_rad = 35.0f * kPi / 180.0f;
  static constexpr float kYawRateLimit_radps = 120.0f * kPi / 180.0f;

  void start(const Quaternion& q_WB);  // at rest there
  // takes_it: else what it was told before goes on. Taken always at the same step of a hold, a demand has
  // the same shape for the rotors whenever it comes.
  void step(const AttitudeDemand& demand, bool takes_it);

  // For the attitude controller; its thrust and velocity are left as they are.
  void put(ThrustAndAttitude& wanted) const;
  // The whole turn of the profile's own end: where a hold would go on from.
  float yaw_rad() const { return yaw_rad_; }

 private:
  static constexpr std::size_t kFirst = 20, kSecond = 9, kThird = 12;  // steps of 5 ms
  static constexpr std::size_t kLead = 4;                              // the hold of a set-point

  struct Point {
    Quaternion q_WB = Quaternion::Identity();
    Vector3 w_B_radps = Vector3::Zero(), alpha_B_radps2 = Vector3::Zero();
  };
  struct Angle {  // one that is asked for by value
    float limited_rad = 0.0f, rad = 0.0f, rate_radps = 0.0f;
    MovingMean<kFirst> first;
    MovingMean<kSecond> second;
    MovingMean<kThird> third;
    void start(float value_rad);
    void step(float demand_rad);
  };

  Vector3 mean_alpha(std::size_t newest) const;  // over a hold that ends with that point

  AttitudeDemand demand_;
  Angle roll_, pitch_;
  float yaw_rad_ = 0.0f, limited_yaw_rate_radps_ = 0.0f;
  MovingMean<kSecond> mean_yaw_rate_;
  std::array<Point, 2 * kLead + 1> points_{};  // newest first
};

}  // namespace fw
