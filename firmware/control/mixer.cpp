#include "firmware/control/mixer.hpp"

#include "firmware/config/vehicle.hpp"

namespace fw {
namespace {

using config::kThrustMin_N, config::kThrustUsable_N;

// The largest share (at most 1) of tilting for which the pairs find thrusts that keep all four rotors
// within their limits and the mean.
float share_that_fits(float mean, float pitching, float rolling) {
  const float lower = mean - kThrustMin_N, upper = kThrustUsable_N - mean;
  const float band = 0.5f * (kThrustUsable_N - kThrustMin_N);
  const float larger = std::max(pitching, rolling), both = pitching + rolling;
  float share = 1.0f;
  if (larger > 1e-6f) share = std::min(share, band / larger);
  if (both > 1e-6f) share = std::min(share, 2.0f * std::min(lower, upper) / both);
  return share;
}

// Two rotors that face each other: half their sum and half their difference.
struct Pair {
  ThrustRange positive,
      negative;  // of the rotor that a positive difference speeds up, and the other

  float difference(float wanted) const {
    return std::clamp(wanted, 0.5f * (positive.low_N - negative.high_N),
                      0.5f * (positive.high_N - negative.low_N));
  }
  ThrustRange room(float d) const {
    const float low = std::max(positive.low_N - d, negative.low_N + d);
    return {low, std::max(low, std::min(positive.high_N - d, negative.high_N + d))};
  }
};

// Where a pair has to carry more than its share, the other one lets go by so much of it. All of it would
// keep the thrust, but a step of 20 degrees then turns the nose by 18; none of it climbs by 0.3 m.
constexpr float kOthersShare = 0.3f;

float within(float value, const ThrustRange& range) {
  return std::clamp(value, range.low_N, range.high_N);
}

}  // namespace

ThrustRanges all_thrusts() {
  ThrustRanges ranges;
  ranges.fill({kThrustMin_N, kThrustUsable_N});
  return ranges;
}

PairLifts lifts_for(const ThrustAndAttitude& wanted) {
  constexpr float kShare = 1.5f;
  const Vector3 inertia(config::kInertia_kgm2);
  const Vector3 turn_radps2 =
      wanted.w_dot_B_radps2.cwiseAbs().cwiseMax(wanted.next_w_dot_B_radps2.cwiseAbs());
  const Vector3 lift_N = kShare / (2.0f * config::kArm_m) * inertia.cwiseProduct(turn_radps2);
  return {.fore_and_aft_N = lift_N.y(), .across_N = lift_N.x()};
}

RotorThrusts mix(float thrust_N, const Vector3& tau_B_Nm, const ThrustRanges& ranges,
                 const PairLifts& lifts) {
  const float x = tau_B_Nm.x() / (2.0f * config::kArm_m);
  const float y = tau_B_Nm.y() / (2.0f * config::kArm_m);
  const float z = tau_B_Nm.z() / (4.0f * config::kTorquePerThrust_m);
  const float mean = std::clamp(0.25f * thrust_N, kThrustMin_N, kThrustUsable_N);
  const float share = share_that_fits(mean, std::abs(y), std::abs(x));
  const Pair fore_and_aft{ranges[0], ranges[2]}, across{ranges[3], ranges[1]};
  const float py = fore_and_aft.difference(share * y), px = across.difference(share * x);
  const ThrustRange room_fore = fore_and_aft.room(py), room_across = across.room(px);
  const float fore_alone = within(mean + lifts.fore_and_aft_N, room_fore);
  const float sides_alone = within(mean + lifts.across_N, room_across);
  float fore = within(fore_alone - kOthersShare * (sides_alone - mean), room_fore);
  float sides = within(sides_alone - kOthersShare * (fore_alone - mean), room_across);
  const float least = std::max(room_fore.low_N - fore, sides - room_across.high_N);
  const float most = std::min(room_fore.high_N - fore, sides - room_across.low_N);
  const float turning = std::clamp(z, std::min(least, 0.0f), std::max(most, 0.0f));
  fore += turning;
  sides -= turning;
  return {fore + py, sides - px, fore - py, sides + px};
}

float collective_N(float share, float hover_N) {
  constexpr float kLeast_N = 4.0f * kThrustMin_N, kMost_N = 4.0f * kThrustUsable_N;
  const float off = 2.0f * std::clamp(share, 0.0f, 1.0f) - 1.0f;
  return off < 0.0f ? hover_N + off * (hover_N - kLeast_N) : hover_N + off * (kMost_N - hover_N);
}

std::uint16_t setpoint_for(float thrust_N) {
  const float span = (thrust_N - kThrustMin_N) / (config::kThrustMax_N - kThrustMin_N);
  return static_cast<std::uint16_t>(1.5f + 2046.0f * std::clamp(span, 0.0f, 1.0f));
}

}  // namespace fw
