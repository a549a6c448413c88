// What every node tells of itself: NodeStatus each second at the latest, and GetNodeInfo when it is asked.
#pragma once
#include <string_view>

#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct NodeStatus {
  static constexpr DataType kType{Kind::message, 341, 0x0F0868D0C1A7C6F1, 7, "NodeStatus"};
  static constexpr std::int64_t kLongest_period_ns = 1'000'000'000;
  static constexpr std::int64_t kOffline_ns = 3'000'000'000;
  enum : std::uint8_t { ok, warning, error, critical };
  enum : std::uint8_t { operational, initialization, maintenance, software_update, offline = 7 };

  std::uint32_t uptime_s = 0;
  std::uint8_t health = ok, mode = operational, sub_mode = 0;
  std::uint16_t vendor_code = 0;

  template <typename F>
  void layout(F& f) {
    f.u(uptime_s, 32);
    f.u(health, 2);
    f.u(mode, 3);
    f.u(sub_mode, 3);
    f.u(vendor_code, 16);
  }
};

struct GetNodeInfoRequest {
  static constexpr DataType kType{Kind::request, 1, 0xEE468A8121C46A9E, 0, "GetNodeInfo"};
  template <typename F>
  void layout(F&) {}
};

using UniqueId = std::array<std::uint8_t, 16>;

struct GetNodeInfoResponse {
  static constexpr DataType kType{Kind::response, 1, 0xEE468A8121C46A9E, 376, "GetNodeInfo"};
  NodeStatus status{};
  std::uint8_t software_major = 0, software_minor = 0;
  std::uint8_t software_flags = 0;  // 1: vcs_commit is valid, 2: image_crc is
  std::uint32_t vcs_commit = 0;
  std::uint64_t image_crc = 0;
  std::uint8_t hardware_major = 0, hardware_minor = 0;
  UniqueId unique_id{};
  Bounded<std::uint8_t, 255> certificate{};
  Bounded<char, 80> name{};  // "org.example.esc"

  void set_name(std::string_view text) {
    for (const char c : text) name.add(c);
  }
  std::string_view name_text() const { return {name.items.data(), name.size}; }

  template <typename F>
  void layout(F& f) {
    status.layout(f);
    f.u(software_major, 8);
    f.u(software_minor, 8);
    f.u(software_flags, 8);
    f.u(vcs_commit, 32);
    f.u(image_crc, 64);
    f.u(hardware_major, 8);
    f.u(hardware_minor, 8);
    for (std::uint8_t& byte : unique_id) f.u(byte, 8);
    f.array(certificate, 8, [&](std::uint8_t& byte) { f.u(byte, 8); });
    f.tail(name, 8, [&](char& letter) { f.u_cut(letter, 8); });
  }
};

}  // namespace whirl::io::dronecan
