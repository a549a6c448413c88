// Whirlstand's own messages for inertial samples at 1 kHz, which RawIMU (7 frames) is too long for.
//
//   Imu14    12 bytes, two frames: six values of 14 bits, then time modulo 40.96 ms
//   Imu16    14 bytes, three frames: the same at 16 bits, time modulo 655.36 ms
//   Frame    the sensor's body: x forward, y right, z down
//   Ranges   full scale is +-2000 deg/s and +-16 g; the positive end is one step short of it
//   Time     units of 10 us of the sender's clock, at which the sample was taken
//   Load     at 1 kHz and 1 Mbit/s, interframe space counted: 26 to 32 % (Imu14), 35 to 43 % (Imu16)
//   Ids      20100 and 20101, of the range that the protocol leaves to vendors (20000..20999)
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

inline constexpr double kImu_rate_full_radps = 34.906585039886592;  // 2000 deg/s
inline constexpr double kImu_acceleration_full_mps2 = 156.9064;     // 16 * 9.80665

template <int kBits, int kTime_bits>
struct ImuSample {
  static constexpr double kRate_step_radps = kImu_rate_full_radps / (1 << (kBits - 1));
  static constexpr double kAcceleration_step_mps2 =
      kImu_acceleration_full_mps2 / (1 << (kBits - 1));
  static constexpr std::int64_t kTime_step_ns = 10'000;
  static constexpr std::int64_t kTime_span_ns = kTime_step_ns << kTime_bits;

  std::array<std::int16_t, 3> rate{}, acceleration{};  // steps
  std::uint16_t time = 0;                              // steps

  template <typename F>
  void layout(F& f) {
    for (std::int16_t& axis : rate) f.i(axis, kBits);
    for (std::int16_t& axis : acceleration) f.i(axis, kBits);
    f.u_cut(time, kTime_bits);
  }
};

struct Imu14 : ImuSample<14, 12> {
  static constexpr DataType kType{
      Kind::message, 20100,
      signature_of("whirl.Imu14\nsaturated int14[3] rate\nsaturated int14[3] acceleration\n"
                   "truncated uint12 time"),
      12, "whirl.Imu14"};
};

struct Imu16 : ImuSample<16, 16> {
  static constexpr DataType kType{
      Kind::message, 20101,
      signature_of("whirl.Imu16\nsaturated int16[3] rate\nsaturated int16[3] acceleration\n"
                   "truncated uint16 time"),
      14, "whirl.Imu16"};
};

// Full steps of a physical value; beyond the range: the nearest that there is. NaN is zero.
template <typename Sample>
std::int16_t to_steps(double value, double step) {
  constexpr double kLeast = -kImu_rate_full_radps / Sample::kRate_step_radps;
  const double steps = value / step;
  if (!(steps > kLeast)) return steps <= kLeast ? static_cast<std::int16_t>(kLeast) : 0;
  const double most = -kLeast - 1;
  const double nearest = steps + (steps < 0 ? -0.5 : 0.5);
  return static_cast<std::int16_t>(nearest > most ? most : nearest);
}

}  // namespace whirl::io::dronecan
