#include "io_bridges/devices/ublox_nmea.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "io_bridges/protocols/nmea.hpp"

namespace whirl::io::ublox {
namespace {

constexpr double kKnots_per_mps = 3600.0 / 1852.0, kKmph_per_mps = 3.6;

__attribute__((format(printf, 1, 2))) std::string print(const char* format, ...) {
  char text[120];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

// 4717.11399,N: degrees and minutes run together. In units of 1e-5 minutes, so that no minute is 60.
std::string angle(double rad, int degree_digits, const char* signs) {
  const long long steps = std::llround(std::abs(rad) * kDeg_per_rad * 60e5);
  const long long degrees = steps / 6'000'000, minutes = steps % 6'000'000;
  return print("%0*lld%02lld.%05lld,%c", degree_digits, degrees, minutes / 100'000,
               minutes % 100'000, signs[rad < 0.0 ? 1 : 0]);
}

std::string place(const GnssEpoch& e) {
  if (!e.fix) return ",,,";
  return angle(e.at.place.latitude_rad, 2, "NS") + "," + angle(e.at.place.longitude_rad, 3, "EW");
}

std::string clock(const GnssEpoch& e) {
  if (!e.time_known) return "";
  return print("%02d%02d%02d.%02d", e.utc.hour, e.utc.minute, e.utc.second,
               static_cast<int>(e.utc.nano_ns / 10'000'000));
}

const char* mode(const GnssEpoch& e) {
  return e.fix ? "A" : "N";
}
const char* status(const GnssEpoch& e) {
  return e.fix ? "A" : "V";
}

double speed_mps(const GnssEpoch& e) {
  return std::hypot(e.at.v_NED_mps[0], e.at.v_NED_mps[1]);
}
double course_deg(const GnssEpoch& e) {
  const double deg = std::atan2(e.at.v_NED_mps[1], e.at.v_NED_mps[0]) * kDeg_per_rad;
  return deg < 0.0 ? deg + 360.0 : deg;
}

std::string gga(const GnssEpoch& e) {
  std::string body = "GPGGA," + clock(e) + "," + place(e) + "," + (e.fix ? "1" : "0") + "," +
                     print("%02d,%.2f,", e.satellites, e.hdop);
  if (!e.fix) return body + ",,,,,";
  const double sea_m = e.at.place.height_m - e.at.geoid_m;
  return body + print("%.1f,M,%.1f,M,,", sea_m, e.at.geoid_m);
}

std::string gll(const GnssEpoch& e) {
  return "GPGLL," + place(e) + "," + clock(e) + "," + status(e) + "," + mode(e);
}

std::string gsa(const GnssEpoch& e) {
  std::string body = print("GPGSA,A,%d", e.fix ? 3 : 1);
  for (int k = 1; k <= 12; ++k) body += k <= e.satellites ? print(",%02d", 2 * k) : ",";
  return body + print(",%.2f,%.2f,%.2f", e.pdop, e.hdop, e.vdop);
}

std::string rmc(const GnssEpoch& e) {
  std::string body = "GPRMC," + clock(e) + "," + status(e) + "," + place(e) + ",";
  body += e.fix ? print("%.3f,%.2f,", speed_mps(e) * kKnots_per_mps, course_deg(e)) : ",,";
  if (e.time_known) body += print("%02d%02d%02d", e.utc.day, e.utc.month, e.utc.year % 100);
  return body + ",,," + mode(e);
}

std::string vtg(const GnssEpoch& e) {
  if (!e.fix) return "GPVTG,,,,,,,,,N";
  return print("GPVTG,%.2f,T,,M,%.3f,N,%.3f,K,A", course_deg(e), speed_mps(e) * kKnots_per_mps,
               speed_mps(e) * kKmph_per_mps);
}

}  // namespace

std::optional<std::string> nmea_message(std::uint8_t id, const GnssEpoch& epoch) {
  switch (id) {
    case 0x00:
      return nmea_sentence(gga(epoch));
    case 0x01:
      return nmea_sentence(gll(epoch));
    case 0x02:
      return nmea_sentence(gsa(epoch));
    case 0x04:
      return nmea_sentence(rmc(epoch));
    case 0x05:
      return nmea_sentence(vtg(epoch));
    default:
      return std::nullopt;
  }
}

}  // namespace whirl::io::ublox
