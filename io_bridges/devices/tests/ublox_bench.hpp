// A receiver with a UART before it: sends frames as an MCU would, keeps what comes back.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_bridges/devices/ublox.hpp"

namespace whirl::io {

using Bytes = std::vector<std::uint8_t>;

struct UbloxBench {
  explicit UbloxBench(UbloxModel model = UbloxModel::six, double first_fix_s = 2.0) {
    params.model = model;
    params.first_fix_ns = static_cast<Nanoseconds>(first_fix_s * 1e9);
    params.bus = 6;
    params.device = 3;
  }
  Ublox& gps() {
    if (!part) {
      part = std::make_unique<Ublox>(
          queue, params,
          [this](const Ublox::Query& query) {
            queries.push_back(query);
            GnssFix fix = truth;
            fix.place = geodetic_of_ned(truth.place, query.offset_NED_m);
            for (unsigned i = 0; i < 3; ++i) fix.v_NED_mps[i] += query.offset_NED_mps[i];
            fix.level_accuracy_m *= query.error_scale;
            return fix;
          },
          &book, [this](const Finding& f) { findings.push_back(f.what); });
      part->join([this](const UartByte& byte, const UartFormat& format) {
        bytes.push_back(byte.value);
        times.push_back(queue.now());
        bauds.push_back(format.baud);
        parser.add(byte.value);
        text += static_cast<char>(byte.value);
      });
    }
    return *part;
  }
  void run(double s) {
    gps();
    queue.run_until(queue.now() + static_cast<Nanoseconds>(s * 1e9));
  }
  void send(const Bytes& out, double baud = 9600.0, char parity = 'N') {
    for (const std::uint8_t byte : out) {
      run(10.0 / baud);
      gps().receive({.value = byte}, {baud, 8, parity, 1.0}, queue.now());
    }
  }
  void send(const UbxFrame& frame, double baud = 9600.0) { send(encode(frame), baud); }
  // UBX alone on its output, no NMEA, so that answers stand alone.
  void ubx_only() {
    run(0.5);
    send(UbxFrame{
        0x06, 0x00, {1, 0, 0, 0, 0xD0, 8, 0, 0, 0x80, 0x25, 0, 0, 3, 0, 1, 0, 0, 0, 0, 0}});
    run(0.5);
    forget();
  }
  void switch_on(std::uint8_t id) { send(UbxFrame{0x06, 0x01, {0x01, id, 1}}); }
  void forget() { frames.clear(), bytes.clear(), times.clear(), bauds.clear(), text.clear(); }
  std::vector<UbxFrame> of(std::uint8_t message_class, std::uint8_t id) const {
    std::vector<UbxFrame> found;
    for (const UbxFrame& f : frames) {
      if (f.message_class == message_class && f.id == id) found.push_back(f);
    }
    return found;
  }
  // Of the newest message of class NAV.
  template <typename T>
  T nav(std::uint8_t id, std::size_t offset) const {
    const auto found = of(0x01, id);
    if (found.empty()) {
      ADD_FAILURE() << "no NAV message " << int{id};
      return {};
    }
    return found.back().get<T>(offset);
  }

  EventQueue queue;
  Ublox::Params params;
  GnssFix truth{.place = {0.5, -1.0, 250.0},
                .geoid_m = 40.0,
                .v_NED_mps = {3.0, -4.0, 0.5},
                .level_accuracy_m = 3.0,
                .down_accuracy_m = 4.5,
                .velocity_accuracy_mps = 0.12};
  FaultBook book;
  std::vector<Ublox::Query> queries;
  std::vector<std::string> findings;
  Bytes bytes;
  std::vector<Nanoseconds> times;
  std::vector<double> bauds;
  std::vector<UbxFrame> frames;
  std::string text;
  UbxParser parser{[this](const UbxFrame& frame) { frames.push_back(frame); }};
  std::unique_ptr<Ublox> part;
};

}  // namespace whirl::io
