// A CAN interface of this host's kernel (SocketCAN, raw sockets).
//
//   Refusals  bad_input with the cure, at open(): see can_interface.hpp
//   Stamps    of the controller where it has any, else of the kernel's receive path
//   Own       what this socket sends comes back marked, when the controller says that it has passed
#pragma once
#include <cstdint>
#include <string>

#include "io_bridges/socketcan/can_interface.hpp"
#include "io_bridges/socketcan/can_port.hpp"
#include "io_bridges/socketcan/stamp_clock.hpp"

struct msghdr;

namespace whirl::io {

class SocketCan final : public CanPort {
 public:
  // bit_rate_bps 0: whatever it has.
  static Result<SocketCan> open(const std::string& interface, std::uint32_t bit_rate_bps);
  SocketCan(SocketCan&& other) noexcept;
  SocketCan& operator=(SocketCan&& other) noexcept;
  ~SocketCan() override;

  Result<bool> send(const CanFrame& frame) override;
  Result<std::optional<CanArrival>> receive() override;
  int file() const override { return file_; }
  std::string version() const override;
  const CanInterface& interface() const { return interface_; }

 private:
  SocketCan(int file, CanInterface interface);
  Result<Done> ask_for_all();
  Error gone(int error) const;
  void read_control(const msghdr& message, CanArrival& arrival);

  int file_ = -1;
  CanInterface interface_;
  StampClock stamps_;
  std::uint32_t dropped_ = 0;  // so far, as the kernel counts
};

}  // namespace whirl::io
