#include "firmware/images/gps_solution.hpp"

#include <cmath>

#include "firmware/config/vehicle.hpp"
#include "firmware/hal/clock.hpp"
#include "firmware/hal/time_base.hpp"

namespace fw {

GpsSolution solution_of(const GpsFix& fix) {
  const auto velocity_mps = [](std::int32_t mmps) { return 1e-3f * static_cast<float>(mmps); };
  const auto metres = [](std::uint32_t mm) { return 1e-3f * static_cast<float>(mm); };
  GpsSolution out;
  out.latitude_e7_deg = fix.latitude_e7_deg;
  out.longitude_e7_deg = fix.longitude_e7_deg;
  out.height_mm = fix.height_mm;
  out.v_W_mps = {velocity_mps(fix.v_north_mmps), velocity_mps(fix.v_east_mmps),
                 velocity_mps(fix.v_down_mmps)};
  out.level_accuracy_m = metres(fix.level_accuracy_mm);
  out.down_accuracy_m = metres(fix.down_accuracy_mm);
  out.speed_accuracy_mps = metres(fix.speed_accuracy_mmps);
  out.fix_type = fix.fix_type;
  out.satellites = fix.satellites;
  out.within_limits = fix.usable();
  out.age_s = config::kGpsLatency_s + 1e-6f * static_cast<float>(fix.age_us(hal::now_us()));
  return out;
}

GpsSolution solution_of(const CanFix& fix) {
  constexpr std::uint8_t k3D = 3;
  const auto& place_m2 = fix.place_m2;
  const auto& speed_m2ps2 = fix.speed_m2ps2;
  GpsSolution out;
  out.latitude_e7_deg = fix.latitude_e7_deg;
  out.longitude_e7_deg = fix.longitude_e7_deg;
  out.height_mm = fix.height_mm;
  out.v_W_mps = {fix.v_W_mps[0], fix.v_W_mps[1], fix.v_W_mps[2]};
  out.level_accuracy_m = std::sqrt(place_m2[0] + place_m2[1]);
  out.down_accuracy_m = std::sqrt(place_m2[2]);
  out.speed_accuracy_mps = std::sqrt(speed_m2ps2[0] + speed_m2ps2[1]);
  out.fix_type = fix.status == k3D ? 3 : 0;
  out.satellites = fix.satellites;
  out.within_limits = fix.status == k3D;
  out.age_s = config::kGpsLatency_s + 1e-6f * static_cast<float>(hal::now_us() - fix.begun_us);
  return out;
}

}  // namespace fw
