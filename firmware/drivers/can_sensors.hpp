// The sensors as nodes on CAN: inertial samples, field, air, GNSS and battery, as they come.
//
//   Inertial  whirl.Imu14 or Imu16 in the body's axes at 1 kHz, full scale +-2000 deg/s and +-16 g. Their stamps
//             (10 us of the node's clock) tell samples that were lost and one that came twice
//   Others    MagneticFieldStrength2, StaticPressure, StaticTemperature, gnss.Fix2, BatteryInfo. A value that
//             cannot be is no sample, and counted. Of a fix the six variances are asked for
//   Source    the first node that tells a thing is heard alone, until it is silent for a second
//   Contract  on_frame() with each frame that came, from a task; is_imu_end() from an interrupt
//   Clock     none is shared with the nodes: a fix is as old as one from a UART's receiver, from the first
//             frame of its transfer on
#pragma once
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "firmware/dronecan/dronecan.hpp"

namespace fw {

struct CanImuSample {
  std::array<std::int16_t, 3> rate{}, acceleration{};  // steps of 16 bits
  bool operator==(const CanImuSample&) const = default;
  // A rate at a rail is no measurement. `kRail` of 14 bits, in steps of 16.
  bool rate_saturated() const {
    constexpr int kRail = 4 * 8191;
    for (const std::int16_t r : rate) {
      if (r >= kRail || r <= -32768) return true;
    }
    return false;
  }
};

struct CanFix {
  std::int32_t latitude_e7_deg = 0, longitude_e7_deg = 0, height_mm = 0;  // over the ellipsoid
  std::array<float, 3> v_W_mps{}, place_m2{}, speed_m2ps2{};              // the last: variances
  std::uint8_t satellites = 0, status = 0;                                // 3: 3D
  std::uint32_t begun_us = 0;                                             // its first frame
};

class CanSensors {
 public:
  // What the hardware must let through.
  static constexpr std::uint32_t kOfType = 0x00FF'FF80;
  static constexpr std::array<dronecan::Type, 7> kTypes{dronecan::kImu14,
                                                        dronecan::kImu16,
                                                        dronecan::kMagneticField2,
                                                        dronecan::kStaticPressure,
                                                        dronecan::kStaticTemperature,
                                                        dronecan::kFix2,
                                                        dronecan::kBatteryInfo};

  // The last frame of an inertial sample from the node that is heard: time for a tick.
  bool is_imu_end(const hal::CanFrame& frame) const {
    if (!is_imu(frame) || frame.length == 0) return false;
    const std::uint8_t node = imu_.node;
    return (frame.data[frame.length - 1u] & dronecan::kEnd) != 0 &&
           (node == 0 || node == dronecan::source_of(frame.id));
  }
  // False: no message of a sensor.
  bool on_frame(const hal::CanFrame& frame, std::uint32_t now_us);

  // Each once.
  std::optional<CanImuSample> take_imu() { return std::exchange(sample_, std::nullopt); }
  std::optional<std::array<float, 3>> take_field_uT() {
    return std::exchange(field_uT_, std::nullopt);
  }
  std::optional<float> take_pressure_Pa() { return std::exchange(pressure_Pa_, std::nullopt); }
  std::optional<CanFix> take_fix() { return std::exchange(fix_, std::nullopt); }
  float temperature_degC() const { return temperature_degC_; }
  // The last one for a second.
  std::optional<float> voltage_V(std::uint32_t now_us) const {
    if (voltage_V_ && now_us - battery_.heard_us > kSilent_us) return std::nullopt;
    return voltage_V_;
  }

  // Never decremented.
  std::uint32_t imu_lost() const { return imu_lost_; }          // by their stamps
  std::uint32_t imu_repeated() const { return imu_repeated_; }  // a stamp that came before
  std::uint32_t imu_bad() const { return imu_.transfer.spoiled(); }
  std::uint32_t field_bad() const { return field_.transfer.spoiled() + field_odd_; }
  std::uint32_t air_bad() const { return pressure_.transfer.spoiled() + air_odd_; }
  std::uint32_t fix_bad() const { return gnss_.transfer.spoiled() + fix_odd_; }

 private:
  static constexpr std::uint32_t kSilent_us = 1'000'000, kStamp_us = 10;

  template <std::size_t kMost>
  struct Source {
    volatile std::uint8_t node = 0;  // 0: none yet
    std::uint32_t heard_us = 0, begun_us = 0;
    dronecan::Reassembly<kMost> transfer;

    // True: its transfer is whole.
    bool take(const hal::CanFrame& frame, const dronecan::Type& type, std::uint32_t now_us) {
      const std::uint8_t from = dronecan::source_of(frame.id);
      if (node != from && node != 0 && now_us - heard_us <= kSilent_us) return false;
      node = from;
      heard_us = now_us;
      const bool starts =
          frame.length > 0 && (frame.data[frame.length - 1u] & dronecan::kStart) != 0;
      if (starts) begun_us = now_us;
      return transfer.take(frame, type);
    }
  };

  static bool is_imu(const hal::CanFrame& frame) {
    return dronecan::is_message(frame.id, dronecan::kImu14) ||
           dronecan::is_message(frame.id, dronecan::kImu16);
  }
  void on_imu(const hal::CanFrame& frame, unsigned bits, std::uint32_t now_us);
  void on_stamp(std::uint32_t stamp, std::uint32_t span, const CanImuSample& sample,
                std::uint32_t now_us);
  void on_field(std::span<const std::uint8_t> payload);
  void on_fix(std::span<const std::uint8_t> payload);

  Source<14> imu_;
  Source<25> field_;
  Source<6> pressure_;
  Source<4> temperature_;
  Source<222> gnss_;
  Source<54> battery_;
  std::optional<CanImuSample> sample_;
  std::optional<std::array<float, 3>> field_uT_;
  std::optional<float> pressure_Pa_, voltage_V_;
  std::optional<CanFix> fix_;
  float temperature_degC_ = 0.0f;
  std::uint32_t stamp_ = 0, stamped_us_ = 0;
  bool stamped_ = false;
  std::uint32_t imu_lost_ = 0, imu_repeated_ = 0, field_odd_ = 0, air_odd_ = 0, fix_odd_ = 0;
};

inline bool CanSensors::on_frame(const hal::CanFrame& frame, std::uint32_t now_us) {
  using namespace dronecan;
  if (is_message(frame.id, kImu14)) {
    on_imu(frame, 14, now_us);
  } else if (is_message(frame.id, kImu16)) {
    on_imu(frame, 16, now_us);
  } else if (is_message(frame.id, kMagneticField2)) {
    if (field_.take(frame, kMagneticField2, now_us)) on_field(field_.transfer.payload());
  } else if (is_message(frame.id, kStaticPressure)) {
    if (!pressure_.take(frame, kStaticPressure, now_us)) return true;
    const float pressure_Pa = std::bit_cast<float>(BitsIn(pressure_.transfer.payload()).get(32));
    if (pressure_Pa > 1e3f && pressure_Pa < 120e3f) {
      pressure_Pa_ = pressure_Pa;
    } else {
      ++air_odd_;
    }
  } else if (is_message(frame.id, kStaticTemperature)) {
    if (!temperature_.take(frame, kStaticTemperature, now_us)) return true;
    temperature_degC_ = from_half(BitsIn(temperature_.transfer.payload()).get(16)) - 273.15f;
  } else if (is_message(frame.id, kFix2)) {
    if (gnss_.take(frame, kFix2, now_us)) on_fix(gnss_.transfer.payload());
  } else if (is_message(frame.id, kBatteryInfo)) {
    if (!battery_.take(frame, kBatteryInfo, now_us)) return true;
    const float voltage_V = from_half(BitsIn(battery_.transfer.payload()).skip(16).get(16));
    if (voltage_V >= 0.0f && voltage_V < 100.0f) voltage_V_ = voltage_V;
  } else {
    return false;
  }
  return true;
}

inline void CanSensors::on_imu(const hal::CanFrame& frame, unsigned bits, std::uint32_t now_us) {
  const dronecan::Type& type = bits == 14 ? dronecan::kImu14 : dronecan::kImu16;
  if (!imu_.take(frame, type, now_us)) return;
  dronecan::BitsIn in(imu_.transfer.payload());
  CanImuSample sample;
  const auto value = [&in, bits] {
    return static_cast<std::int16_t>(in.get_signed(bits) * (bits == 14 ? 4 : 1));
  };
  for (std::int16_t& rate : sample.rate) rate = value();
  for (std::int16_t& acceleration : sample.acceleration) acceleration = value();
  const unsigned stamp_bits = bits == 14 ? 12 : 16;
  const std::uint32_t stamp = in.get(stamp_bits);
  if (in.ok()) on_stamp(stamp, 1u << stamp_bits, sample, now_us);
}

// Stamps go round: how often, is told by the time of reception.
inline void CanSensors::on_stamp(std::uint32_t stamp, std::uint32_t span,
                                 const CanImuSample& sample, std::uint32_t now_us) {
  constexpr std::uint32_t kPeriod_us = 1000;
  const std::uint32_t round_us = kStamp_us * span, waited_us = now_us - stamped_us_;
  const std::uint32_t within_us = kStamp_us * ((stamp - stamp_) & (span - 1u));
  if (stamped_ && within_us == 0 && waited_us < round_us / 2) {
    ++imu_repeated_;
    return;
  }
  if (stamped_) {
    const std::uint32_t rounds =
        waited_us > within_us ? (waited_us - within_us + round_us / 2) / round_us : 0;
    const std::uint32_t periods = (within_us + rounds * round_us + kPeriod_us / 2) / kPeriod_us;
    imu_lost_ += periods > 1 ? periods - 1 : 0;
  }
  stamp_ = stamp;
  stamped_us_ = now_us;
  stamped_ = true;
  sample_ = sample;
}

inline void CanSensors::on_field(std::span<const std::uint8_t> payload) {
  constexpr float kMicrotesla_per_gauss = 100.0f, kMost_uT = 1000.0f;
  dronecan::BitsIn in(payload);
  in.skip(8);
  std::array<float, 3> field_uT{};
  for (float& along : field_uT) {
    along = kMicrotesla_per_gauss * dronecan::from_half(in.get(16));
    if (!(std::abs(along) < kMost_uT)) {
      ++field_odd_;
      return;
    }
  }
  if (in.ok()) field_uT_ = field_uT;
}

inline void CanSensors::on_fix(std::span<const std::uint8_t> payload) {
  dronecan::BitsIn in(payload);
  const auto angle_e7_deg = [&in] {  // of 37 bits, 1e-8 degrees
    const std::uint32_t low = in.get(32);
    const std::int64_t high = in.get_signed(5);
    return static_cast<std::int32_t>((high * (std::int64_t{1} << 32) + low) / 10);
  };
  in.skip(56 + 56 + 3 + 13 + 8);
  CanFix fix;
  fix.longitude_e7_deg = angle_e7_deg();
  fix.latitude_e7_deg = angle_e7_deg();
  fix.height_mm = in.get_signed(27);
  in.skip(27);
  for (float& v : fix.v_W_mps) v = std::bit_cast<float>(in.get(32));
  fix.satellites = static_cast<std::uint8_t>(in.get(6));
  fix.status = static_cast<std::uint8_t>(in.get(2));
  in.skip(4 + 6);
  const bool six = in.get(6) == 6;
  bool finite = six;
  for (auto* of : {&fix.place_m2, &fix.speed_m2ps2}) {
    for (float& variance : *of) {
      variance = dronecan::from_half(in.get(16));
      finite = finite && variance >= 0.0f && variance < 1e6f;
    }
  }
  for (const float v : fix.v_W_mps) finite = finite && std::abs(v) < 1e3f;
  if (!in.ok() || !finite) {
    ++fix_odd_;
    return;
  }
  fix.begun_us = gnss_.begun_us;
  fix_ = fix;
}

}  // namespace fw
