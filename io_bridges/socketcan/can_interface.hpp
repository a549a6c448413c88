// What this host's kernel says of a network interface that is to be a CAN bus, and whether a bench may use it.
//
//   Source    rtnetlink: RTM_GETLINK with IFLA_LINKINFO (Linux, include/uapi/linux/can/netlink.h)
//   Left out  setting it up: that needs privileges which a bench should not have; every refusal says the command
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/result.hpp"
#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::io {

struct CanInterface {
  std::string name;
  int index = 0;
  bool is_can = false, up = false;
  std::string kind;                // "vcan", "can" (a controller), "slcan"
  std::string driver;              // "gs_usb"; empty: not told
  std::uint32_t bit_rate_bps = 0;  // 0: has none (virtual, or not set)
  std::uint32_t restart_ms = 0;    // after bus-off; 0: not by itself
  std::uint16_t transmit_errors = 0, receive_errors = 0;
  CanBusState state = CanBusState::unknown;

  bool is_virtual() const { return kind == "vcan" || kind == "vxcan"; }
};

// Nothing: there is none of this name. Errors  bad_input: the kernel does not answer
Result<std::optional<CanInterface>> read_can_interface(const std::string& name);
// One answer to RTM_GETLINK. Nothing: it is not such a message.
std::optional<CanInterface> parse_link_message(std::span<const std::uint8_t> message);

// Whether it may be used at this bit rate (0: whatever it has). Errors  bad_input, each with its cure: no such
// interface, not CAN, down, wrong bit rate, bus-off. A virtual one has no bit rate and is taken.
Result<Done> check_can_interface(const std::string& name, const std::optional<CanInterface>& found,
                                 std::uint32_t wanted_bps);
// Why the kernel gave no socket, or did not bind it.
Error why_no_can_socket(const std::string& name, int error);

}  // namespace whirl::io
