// What a u-blox receiver can be told (class CFG of UBX), kept in three copies: in force, saved, default.
//
//   Table   which messages and fields are modelled, stored only or refused stands in ublox.hpp
//   Source  PX4-GPSDrivers src/ubx.h, ArduPilot AP_GPS_UBLOX.h, ROS ublox_msgs; FV-25 manual p. 78
//           (bits of the UART's mode)
//   Memory  which baud rates a part takes; sections of CFG-CFG; layout of CFG-RST
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io_bridges/protocols/ubx.hpp"

namespace whirl::io {

enum class UbloxModel : std::uint8_t { six, m8 };

namespace ublox {

inline constexpr std::uint8_t kNav = 0x01, kAck = 0x05, kCfg = 0x06, kMon = 0x0A, kNmea = 0xF0;
inline constexpr std::uint16_t kUbxProtocol = 1, kNmeaProtocol = 2;  // bits of the masks

using MessageKey = std::uint16_t;  // class << 8 | id
constexpr MessageKey key_of(std::uint8_t message_class, std::uint8_t id) {
  return static_cast<MessageKey>(message_class << 8 | id);
}

enum class Output : std::uint8_t { unknown, stored_only, modelled };
Output output_of(UbloxModel model, MessageKey message);

struct Port {
  std::uint16_t tx_ready = 0;
  std::uint32_t mode = 0x8D0;  // 8N1
  std::uint32_t baud = 9600;
  std::uint16_t in_mask = 7, out_mask = 3, flags = 0;
};
struct Navigation {
  std::uint16_t measure_ms = 1000, cycles = 1, time_reference = 1;
  std::array<std::uint8_t, 36> nav5 = default_nav5();

  static std::array<std::uint8_t, 36> default_nav5();
};
struct Settings {
  Port port;
  std::map<MessageKey, std::uint8_t> rates;  // per navigation solution, on this port
  Navigation navigation;
};
Settings default_settings(std::uint32_t baud);

enum class Start : std::uint8_t { hot, warm, cold };
struct Restart {
  Start start = Start::hot;
  bool reload = false;  // of the saved settings
};

}  // namespace ublox

class UbloxConfig {
 public:
  using Report = std::function<void(const std::string& what)>;
  struct Answer {
    enum class Kind : std::uint8_t { ack, nak, silence };
    Kind kind = Kind::nak;
    std::vector<UbxFrame> replies = {};  // before the acknowledge
    std::optional<ublox::Restart> restart = {};
  };

  UbloxConfig(UbloxModel model, std::uint32_t baud, Report report);

  Answer handle(const UbxFrame& frame);  // of class CFG
  // $PUBX,41: protocols and baud rate of a port.
  void set_port(std::uint16_t in_mask, std::uint16_t out_mask, std::uint32_t baud);
  void reload() { settings_ = saved_; }
  void forget_navigation() { settings_.navigation = default_.navigation; }
  const ublox::Settings& settings() const { return settings_; }

 private:
  Answer refuse(const UbxFrame& frame, const std::string& why);
  Answer done() { return {Answer::Kind::ack}; }
  Answer on_port(const UbxFrame& frame);
  Answer set_ports(const UbxFrame& frame);
  Answer on_message(const UbxFrame& frame);
  Answer on_rate(const UbxFrame& frame);
  Answer on_nav5(const UbxFrame& frame);
  Answer on_save(const UbxFrame& frame);
  Answer on_restart(const UbxFrame& frame);
  Answer on_stored_only(const UbxFrame& frame);
  bool baud_exists(std::uint32_t baud) const;

  UbloxModel model_;
  Report report_;
  ublox::Settings default_, saved_, settings_;
  std::map<std::uint8_t, std::vector<std::uint8_t>> stored_only_;
};

}  // namespace whirl::io
