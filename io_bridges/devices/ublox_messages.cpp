#include "io_bridges/devices/ublox_messages.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::io::ublox {
namespace {

template <typename T>
T rounded(double value) {
  constexpr double kLow = static_cast<double>(std::numeric_limits<T>::min()),
                   kHigh = static_cast<double>(std::numeric_limits<T>::max());
  return static_cast<T>(std::llround(std::clamp(value, kLow, kHigh)));
}
std::int32_t i4(double value) {
  return rounded<std::int32_t>(value);
}
std::uint32_t u4(double value) {
  return rounded<std::uint32_t>(value);
}
std::uint16_t u2(double value) {
  return rounded<std::uint16_t>(value);
}

std::uint32_t itow_ms(const GnssEpoch& e) {
  return static_cast<std::uint32_t>(e.time.tow_ns / 1'000'000);
}
std::uint8_t fix_type(const GnssEpoch& e) {
  return e.fix ? 3 : 0;
}
// fixOK, -, week known, time of week known.
std::uint8_t flags(const GnssEpoch& e) {
  return static_cast<std::uint8_t>((e.fix ? 1 : 0) | (e.time_known ? 0xC : 0));
}

// Without a fix an estimate of the error says that there is none.
double level_m(const GnssEpoch& e) {
  return e.fix ? e.at.level_accuracy_m : 4294967.0;
}
double down_m(const GnssEpoch& e) {
  return e.fix ? e.at.down_accuracy_m : 4294967.0;
}
double velocity_mps(const GnssEpoch& e) {
  return e.fix ? e.at.velocity_accuracy_mps : 20.0;
}
double time_ns(const GnssEpoch& e) {
  return e.fix ? 50.0 : e.time_known ? 1e6 : 4294967295.0;
}

struct Course {
  double level_mps, heading_deg, heading_accuracy_deg;
};
Course course_of(const GnssEpoch& e) {
  const double north = e.at.v_NED_mps[0], east = e.at.v_NED_mps[1];
  const double level_mps = std::hypot(north, east);
  double heading_deg = std::atan2(east, north) * kDeg_per_rad;
  if (heading_deg < 0.0) heading_deg += 360.0;
  const double spread_deg = velocity_mps(e) / std::max(level_mps, 1e-3) * kDeg_per_rad;
  return {level_mps, heading_deg, e.fix ? std::min(spread_deg, 180.0) : 180.0};
}

void put_place(const GnssEpoch& e, UbxPayload& out) {
  const Geodetic& p = e.at.place;
  out.put(i4(p.longitude_rad * kDeg_per_rad * 1e7)).put(i4(p.latitude_rad * kDeg_per_rad * 1e7));
  out.put(i4(p.height_m * 1e3)).put(i4((p.height_m - e.at.geoid_m) * 1e3));
  out.put(u4(level_m(e) * 1e3)).put(u4(down_m(e) * 1e3));
}

void posllh(const GnssEpoch& e, UbxPayload& out) {
  out.put(itow_ms(e));
  put_place(e, out);
}

void status(const GnssEpoch& e, UbxPayload& out) {
  out.put(itow_ms(e)).put(fix_type(e)).put(flags(e)).zeros(2);
  out.put(e.first_fix_ms).put(e.running_ms);
}

void dop(const GnssEpoch& e, UbxPayload& out) {
  const double g = std::min(std::hypot(e.pdop, e.tdop), 99.99), n = e.hdop / std::sqrt(2.0);
  out.put(itow_ms(e));
  for (const double d : {g, e.pdop, e.tdop, e.vdop, e.hdop, n, n}) out.put(u2(100.0 * d));
}

void sol(const GnssEpoch& e, UbxPayload& out) {
  const std::array<double, 3> p_m = ecef_m(e.at.place);
  const std::array<double, 3> v_mps = ned_in_ecef(e.at.place, e.at.v_NED_mps);
  const auto rest_ns = static_cast<std::int32_t>(e.time.tow_ns % 1'000'000);
  out.put(itow_ms(e)).put(rest_ns).put(static_cast<std::int16_t>(e.time.week));
  out.put(fix_type(e)).put(flags(e));
  for (const double x : p_m) out.put(i4(x * 100.0));
  out.put(u4(std::hypot(level_m(e), down_m(e)) * 100.0));
  for (const double v : v_mps) out.put(i4(v * 100.0));
  out.put(u4(velocity_mps(e) * 100.0)).put(u2(100.0 * e.pdop)).zeros(1);
  out.put(static_cast<std::uint8_t>(e.satellites)).zeros(4);
}

void velned(const GnssEpoch& e, UbxPayload& out) {
  const Course course = course_of(e);
  out.put(itow_ms(e));
  for (const double v : e.at.v_NED_mps) out.put(i4(v * 100.0));
  out.put(u4(std::hypot(course.level_mps, e.at.v_NED_mps[2]) * 100.0));
  out.put(u4(course.level_mps * 100.0)).put(i4(course.heading_deg * 1e5));
  out.put(u4(velocity_mps(e) * 100.0)).put(u4(course.heading_accuracy_deg * 1e5));
}

void put_calendar(const UtcTime& t, UbxPayload& out) {
  out.put(static_cast<std::uint16_t>(t.year));
  for (const int x : {t.month, t.day, t.hour, t.minute, t.second}) {
    out.put(static_cast<std::uint8_t>(x));
  }
}
std::uint8_t time_valid(const GnssEpoch& e) {
  return e.time_known ? 7 : 0;
}

void timeutc(const GnssEpoch& e, UbxPayload& out) {
  out.put(itow_ms(e)).put(u4(time_ns(e))).put(e.utc.nano_ns);
  put_calendar(e.utc, out);
  out.put(time_valid(e));
}

void pvt(const GnssEpoch& e, UbxPayload& out) {
  const Course course = course_of(e);
  out.put(itow_ms(e));
  put_calendar(e.utc, out);
  out.put(time_valid(e)).put(u4(time_ns(e))).put(e.utc.nano_ns);
  out.put(fix_type(e)).put(static_cast<std::uint8_t>(e.fix ? 1 : 0)).zeros(1);
  out.put(static_cast<std::uint8_t>(e.satellites));
  put_place(e, out);
  for (const double v : e.at.v_NED_mps) out.put(i4(v * 1e3));
  out.put(i4(course.level_mps * 1e3)).put(i4(course.heading_deg * 1e5));
  out.put(u4(velocity_mps(e) * 1e3)).put(u4(course.heading_accuracy_deg * 1e5));
  out.put(u2(100.0 * e.pdop)).zeros(6);
  out.put(i4(course.heading_deg * 1e5)).zeros(4);  // headVeh is headMot where nothing is fused
}

}  // namespace

std::optional<UbxFrame> nav_message(std::uint8_t id, const GnssEpoch& epoch) {
  using Writer = void (*)(const GnssEpoch&, UbxPayload&);
  constexpr struct {
    std::uint8_t id;
    Writer write;
  } kWriters[] = {{0x02, posllh}, {0x03, status}, {0x04, dop},    {0x06, sol},
                  {0x07, pvt},    {0x12, velned}, {0x21, timeutc}};
  for (const auto& writer : kWriters) {
    if (writer.id != id) continue;
    UbxPayload payload;
    writer.write(epoch, payload);
    return UbxFrame{kNav, id, payload.take()};
  }
  return std::nullopt;
}

std::string hardware_version(UbloxModel model) {
  return model == UbloxModel::six ? "00040007" : "00080000";
}

UbxFrame version_message(UbloxModel model, const std::string& hardware) {
  UbxPayload out;
  if (model == UbloxModel::six) {
    out.text("7.03 (45969)", 30).text(hardware.c_str(), 10);
  } else {
    out.text("EXT CORE 3.01 (107888)", 30).text(hardware.c_str(), 10);
    out.text("FWVER=SPG 3.01", 30).text("PROTVER=18.00", 30);
  }
  return {kMon, 0x04, out.take()};
}

}  // namespace whirl::io::ublox
