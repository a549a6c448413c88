// u-blox LEA-6 and NEO-M8: a GNSS receiver on a UART, UBX and NMEA, message by message.
//
//   In       the fix with its errors, asked for through Params::sense at each measurement, in order of
//            time; without a fix nothing is asked
//   Out      default: 9600 8N1, NMEA at 1 Hz. Messages of a solution in the order of class and id,
//            behind one another; what does not fit into the buffer is lost, a finding
//   Timing   deaf for 300 ms after power-up. Solutions at whole multiples of the period of GPS time; the
//            first bit leaves latency_ns later. First fix after first_fix_ns; after jamming or a hot
//            start 1 s
//   Settling errors and estimates of a fix begin five times (after jamming: twice) as large and fall with
//            15 s; satellites grow from four
//   Baud     what is sent at another rate or format is read as a UART reads it: garbage, or nothing
//            where the stop bit is missing; one finding. CFG-PRT: the ACK still goes at the old rate
//   Source   UBX: PX4-GPSDrivers src/ubx.{h,cpp}, ArduPilot AP_GPS_UBLOX, Betaflight io/gps.c, ROS
//            ublox_msgs (CFG-RATE: a 6 has navRate 1, alignment); GS408A data sheet (first fix 29 s,
//            hot start below 1 s, 0.1 m/s)
//   Memory   5 Hz of a LEA-6, 10 Hz of an M8, baud rates, default port; 300 ms; buffer of 1 KiB; settling;
//            firmware's version text; CFG-RST's and CFG-CFG's bits
//   Unknown  what a 6 answers to a period below 200 ms (here ACK-NAK), what it sends while it settles to a
//            new rate (here the ACK whole, then the new rate at once)
//
//   | message          | here                                                                        |
//   | CFG-PRT          | modelled: portID 1, mode (8N1 only, else NAK), baudRate, inProtoMask and    |
//   |                  | outProtoMask (bits 0, 1). txReady stored, a finding; flags, RTCM stored.    |
//   |                  | Blocks of other ports are acknowledged and lead nowhere. Poll               |
//   | CFG-MSG          | modelled: 3 bytes, 8 bytes (UART1's rate counts), poll. NAK: messages that  |
//   |                  | the part lacks (NAV-PVT on a 6). Stored, a finding: those it does not write |
//   | CFG-RATE         | modelled: measRate >= 200 ms (M8: 100), navRate (a 6: 1), poll. timeRef     |
//   |                  | stored: alignment is to GPS time                                            |
//   | CFG-NAV5         | stored by its mask, poll; dynModel 1 and > 8, fixMode 0 and > 3: NAK        |
//   | CFG-CFG          | modelled: clear, save, load of port (0), messages (1), navigation (3); other|
//   |                  | sections and deviceMask ignored                                             |
//   | CFG-RST          | modelled: navBbrMask 0 hot, 1 warm (as cold), else cold; resetMode 0, 1, 4  |
//   |                  | reload the saved settings, 2 not; 8, 9: NAK. No ACK                         |
//   | CFG-INF TP RXM   | stored, a finding, poll of what was stored; SBAS, NAVX5, TP5, on the M8     |
//   |                  | GNSS, PMS likewise                                                          |
//   | other CFG        | refused: NAK (CFG-VALSET, too)                                              |
//   | ACK-ACK, ACK-NAK | modelled; sent if outProtoMask has UBX                                      |
//   | NAV-POSLLH       | modelled: all fields                                                        |
//   | NAV-VELNED       | modelled: all fields                                                        |
//   | NAV-SOL          | modelled: all fields; flag DGPS 0                                           |
//   | NAV-STATUS       | modelled: gpsFix, fixOK, WKN, TOW, ttff, msss; fixStat, flags2 0            |
//   | NAV-DOP          | modelled; northing and easting equal                                        |
//   | NAV-TIMEUTC      | modelled: all fields; valid all at once                                     |
//   | NAV-PVT          | M8: modelled; flags beyond gnssFixOK, flags2, flags3, magnetic variation 0  |
//   | NAV polls        | modelled: the newest solution, without an ACK                               |
//   | MON-VER poll     | modelled                                                                    |
//   | NMEA             | GGA GLL GSA RMC VTG modelled (GSA: made-up satellite numbers); GSV left out:|
//   |                  | no satellite has a place in the sky; no TXT at power-up                     |
//   | $PUBX,41         | modelled: protocols and baud rate of port 1, without autobauding            |
//   | other input      | refused: no answer, a finding                                               |
//
//   Faults   sensor_frozen (place and velocity stay, time goes on), sensor_offset (axis 0..2 m, 3..5
//            m/s, north east down), sensor_late (solutions come value seconds later),
//            sensor_wrong_identity (hwVersion reads value, 70000: 00070000), gnss_jammed,
//            gnss_spoofed (fix and flags stay good), gnss_dropout, gnss_brown_out,
//            gnss_forgets
//   Left out antenna's place off the centre of mass, static hold, elevation and masks, power save, SBAS
#pragma once
#include <deque>
#include <functional>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/gnss_epoch.hpp"
#include "io_bridges/devices/rated_uart_peer.hpp"
#include "io_bridges/devices/uart_transmitter.hpp"
#include "io_bridges/devices/ublox_config.hpp"
#include "io_bridges/protocols/nmea.hpp"

namespace whirl::io {

class Ublox : public RatedUartPeer {
 public:
  struct Params {
    std::string name = "gps";
    UbloxModel model = UbloxModel::six;
    std::uint32_t baud = 9600;  // as saved; the part's default is 9600
    Nanoseconds first_fix_ns = 29'000'000'000;
    Nanoseconds latency_ns = 70'000'000;
    int satellites = 9;                        // once settled; 4..12
    double dropout_chance = 0.0;               // of each solution
    GpsTime start{1800, 345'600'000'000'000};  // Thursday, 10 July 2014, 0 h: at power-up
    int leap_s = 16;
    std::uint64_t seed = 1;
    int bus = kAnywhere, device = kAnywhere;  // where faults find it
  };
  struct Query {
    Nanoseconds now = 0;
    double error_scale = 1.0;
    std::array<double, 3> offset_NED_m{}, offset_NED_mps{};  // by faults
  };
  using Sense = std::function<GnssFix(const Query&)>;

  // `faults` may be null.
  Ublox(EventQueue& queue, const Params& params, Sense sense, FaultBook* faults,
        FindingSink findings);

  void receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) override;

  double baud() const override { return transmitter_.format().baud; }
  const UbxParser::Counts& parser_counts() const { return ubx_.counts(); }

 private:
  struct Solution {
    Nanoseconds due_ns = 0;
    GnssEpoch epoch;
  };
  void on_ubx(const UbxFrame& frame);
  void on_config(const UbxFrame& frame);
  void on_nmea(std::string_view body);
  void settings_changed();
  void restart(const ublox::Restart& restart);
  void brown_out();
  void forget();

  void schedule();
  void measure();
  bool locate(Nanoseconds now);  // into epoch_; false: nothing comes out
  bool has_fix(Nanoseconds now);
  GnssFix fix_at(Nanoseconds now);
  void put_out();
  void send_ubx(const UbxFrame& frame);
  void send_bytes(std::span<const std::uint8_t> bytes);
  void send_solution(const GnssEpoch& epoch);

  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }
  void report(const std::string& what) { findings_.report({queue_.now(), params_.name, what}); }

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  FaultBook* faults_;
  OnceFindings findings_;
  UbloxConfig config_;
  UartTransmitter transmitter_;
  UbxParser ubx_;
  NmeaParser nmea_;
  RandomStream dropout_;
  bool mismatch_told_ = false;

  Nanoseconds started_ns_, fix_due_ns_, fix_since_ns_ = kNever;
  double settling_ = 4.0;  // of the errors at the beginning of the fix, beside their settled size
  GnssEpoch epoch_;
  bool measured_ = false;
  std::deque<Solution> solutions_;  // on their way out
  std::uint32_t number_ = 0;        // of solutions
  Event measure_, out_, brown_out_, forget_;
};

}  // namespace whirl::io
