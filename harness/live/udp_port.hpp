// A UDP socket to one peer, as a vehicle has to its ground station: frames go there, whatever comes to the
// socket's own port is taken in, from whomever.
//
//   Blocks   never. A datagram that the host does not take at once, or that nobody listens for, is
//            counted and forgotten, as on any network
//   Bound    to the loopback where the peer is there, so that nobody outside reaches it
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::live {

class UdpPort {
 public:
  // peer: "127.0.0.1:14550", "localhost:14550", "[::1]:14550". own_port 0: one that is free.
  // Errors  bad_input: no such address; host: no socket, the port is taken
  static Result<UdpPort> open(const std::string& peer, std::uint16_t own_port);
  ~UdpPort();
  UdpPort(UdpPort&& other) noexcept;
  UdpPort(const UdpPort&) = delete;
  UdpPort& operator=(const UdpPort&) = delete;

  void send(std::span<const std::uint8_t> datagram);
  // The next one that has come, or none. Valid until the next call.
  std::optional<std::span<const std::uint8_t>> receive();
  // The last one is from the peer's host, whatever its port: a ground station may send from another one.
  bool from_peer() const { return from_peer_; }

  std::uint16_t own_port() const { return own_port_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t not_sent() const { return not_sent_; }

 private:
  explicit UdpPort(int fd) : fd_(fd), buffer_(65536) {}

  int fd_ = -1;
  std::vector<std::uint8_t> peer_;  // its socket address
  std::vector<std::uint8_t> buffer_;
  std::uint16_t own_port_ = 0;
  std::uint64_t sent_ = 0, not_sent_ = 0;
  bool from_peer_ = false;
};

}  // namespace whirl::live
