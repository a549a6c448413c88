#include "io_bridges/rack/devices/pod_faults.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace whirl::rack {
namespace {

using Kind = io::FaultKind;

struct Seat {
  const char* type;
  int address;
  std::vector<Kind> kinds;
};

const std::array<Seat, 6>& seats() {
  static const std::array<Seat, 6> all{
      {{"mpu6000",
        kPodImu,
        {Kind::sensor_frozen, Kind::sensor_offset, Kind::sensor_scale, Kind::sensor_drift,
         Kind::sensor_saturated, Kind::sensor_wrong_identity, Kind::sensor_brown_out}},
       // Its identity is a word of the PROM, which the host sends.
       {"ms5611",
        kPodBarometer,
        {Kind::sensor_frozen, Kind::sensor_offset, Kind::sensor_drift, Kind::sensor_saturated,
         Kind::sensor_wrong_identity}},
       {"hmc5883l",
        kPodMagnetometer,
        {Kind::sensor_frozen, Kind::sensor_offset, Kind::sensor_drift, Kind::sensor_saturated,
         Kind::sensor_late}},
       // All that it says comes from the host.
       {"ublox_6",
        kPodGps,
        {Kind::sensor_frozen, Kind::sensor_offset, Kind::sensor_late, Kind::sensor_wrong_identity,
         Kind::gnss_jammed, Kind::gnss_spoofed, Kind::gnss_dropout, Kind::gnss_brown_out,
         Kind::gnss_forgets}},
       {"sbus", kPodReceiver, {Kind::rc_link_lost, Kind::rc_glitch}},
       {"battery_sense", kPodBattery, {Kind::sensor_offset}}}};
  return all;
}

const Seat* seat_of(const std::string& type) {
  const auto found = std::find_if(seats().begin(), seats().end(),
                                  [&](const Seat& seat) { return type == seat.type; });
  return found == seats().end() ? nullptr : &*found;
}

}  // namespace

std::optional<int> pod_address(const std::string& type) {
  const Seat* seat = seat_of(type);
  return seat == nullptr ? std::nullopt : std::optional(seat->address);
}

bool acts_in_data(const std::string& type, io::FaultKind kind) {
  const Seat* seat = seat_of(type == "ublox_m8" ? "ublox_6" : type);  // it has the same ones
  return seat != nullptr &&
         std::find(seat->kinds.begin(), seat->kinds.end(), kind) != seat->kinds.end();
}

}  // namespace whirl::rack
