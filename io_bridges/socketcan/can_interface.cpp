#include "io_bridges/socketcan/can_interface.hpp"

#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <functional>

namespace whirl::io {
namespace {

Error refused(const std::string& name, const std::string& what, const std::string& cure) {
  return {ErrorKind::bad_input, name, what, cure};
}

template <typename T>
T read_as(std::span<const std::uint8_t> bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), std::min(sizeof value, bytes.size()));
  return value;
}

std::string text_of(std::span<const std::uint8_t> bytes) {
  const auto* begin = reinterpret_cast<const char*>(bytes.data());
  return {begin, strnlen(begin, bytes.size())};
}

using Visit = std::function<void(int type, std::span<const std::uint8_t> payload)>;

void for_each_attribute(std::span<const std::uint8_t> bytes, const Visit& visit) {
  while (bytes.size() >= sizeof(rtattr)) {
    const auto head = read_as<rtattr>(bytes);
    if (head.rta_len < sizeof head || head.rta_len > bytes.size()) return;
    visit(head.rta_type & NLA_TYPE_MASK, bytes.subspan(sizeof head, head.rta_len - sizeof head));
    bytes = bytes.subspan(std::min<std::size_t>(RTA_ALIGN(head.rta_len), bytes.size()));
  }
}

CanBusState state_of(std::uint32_t kernels) {
  switch (kernels) {
    case CAN_STATE_ERROR_ACTIVE:
      return CanBusState::active;
    case CAN_STATE_ERROR_WARNING:
      return CanBusState::warning;
    case CAN_STATE_ERROR_PASSIVE:
      return CanBusState::passive;
    case CAN_STATE_BUS_OFF:
      return CanBusState::bus_off;
    case CAN_STATE_STOPPED:
    case CAN_STATE_SLEEPING:
      return CanBusState::stopped;
    default:
      return CanBusState::unknown;
  }
}

void read_can_data(std::span<const std::uint8_t> data, CanInterface& found) {
  for_each_attribute(data, [&](int type, std::span<const std::uint8_t> payload) {
    if (type == IFLA_CAN_BITTIMING) found.bit_rate_bps = read_as<can_bittiming>(payload).bitrate;
    if (type == IFLA_CAN_RESTART_MS) found.restart_ms = read_as<std::uint32_t>(payload);
    if (type == IFLA_CAN_STATE) found.state = state_of(read_as<std::uint32_t>(payload));
    if (type == IFLA_CAN_BERR_COUNTER) {
      const auto errors = read_as<can_berr_counter>(payload);
      found.transmit_errors = errors.txerr;
      found.receive_errors = errors.rxerr;
    }
  });
}

std::string driver_of(const std::string& name) {
  std::array<char, 256> target{};
  const std::string link = "/sys/class/net/" + name + "/device/driver";
  const ssize_t size = readlink(link.c_str(), target.data(), target.size() - 1);
  if (size <= 0) return {};
  const std::string path(target.data());
  return path.substr(path.rfind('/') + 1);
}

struct Question {
  nlmsghdr head{};
  ifinfomsg link{};
  rtattr attribute{};
  std::array<char, IFNAMSIZ> name{};
};

Question question_about(const std::string& name) {
  Question q;
  q.head.nlmsg_len = sizeof q;
  q.head.nlmsg_type = RTM_GETLINK;
  q.head.nlmsg_flags = NLM_F_REQUEST;
  q.link.ifi_family = AF_UNSPEC;
  q.attribute.rta_type = IFLA_IFNAME;
  q.attribute.rta_len = sizeof q.attribute + sizeof q.name;
  std::memcpy(q.name.data(), name.data(), name.size());
  return q;
}

}  // namespace

const char* name(CanBusState state) {
  switch (state) {
    case CanBusState::active:
      return "error active";
    case CanBusState::warning:
      return "error warning";
    case CanBusState::passive:
      return "error passive";
    case CanBusState::bus_off:
      return "bus-off";
    case CanBusState::stopped:
      return "stopped";
    case CanBusState::unknown:
      return "unknown";
  }
  return "?";
}

std::optional<CanInterface> parse_link_message(std::span<const std::uint8_t> message) {
  if (message.size() < sizeof(nlmsghdr) + sizeof(ifinfomsg)) return std::nullopt;
  const auto head = read_as<nlmsghdr>(message);
  if (head.nlmsg_type != RTM_NEWLINK || head.nlmsg_len > message.size()) return std::nullopt;
  if (head.nlmsg_len < sizeof(nlmsghdr) + sizeof(ifinfomsg)) return std::nullopt;
  const auto link = read_as<ifinfomsg>(message.subspan(sizeof head));
  CanInterface found;
  found.index = link.ifi_index;
  found.is_can = link.ifi_type == ARPHRD_CAN;
  found.up = (link.ifi_flags & IFF_UP) != 0;
  const auto rest = message.first(head.nlmsg_len).subspan(sizeof head + sizeof link);
  for_each_attribute(rest, [&](int type, std::span<const std::uint8_t> payload) {
    if (type == IFLA_IFNAME) found.name = text_of(payload);
    if (type != IFLA_LINKINFO) return;
    for_each_attribute(payload, [&](int inner, std::span<const std::uint8_t> data) {
      if (inner == IFLA_INFO_KIND) found.kind = text_of(data);
      if (inner == IFLA_INFO_DATA && found.is_can) read_can_data(data, found);
    });
  });
  return found;
}

Result<std::optional<CanInterface>> read_can_interface(const std::string& name) {
  if (name.empty() || name.size() >= IFNAMSIZ) return std::optional<CanInterface>();
  const int file = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (file < 0) return refused(name, std::string("netlink: ") + std::strerror(errno), "");
  const Question question = question_about(name);
  std::array<std::uint8_t, 16384> answer{};
  const bool asked = ::send(file, &question, sizeof question, 0) == sizeof question;
  const ssize_t size = asked ? ::recv(file, answer.data(), answer.size(), 0) : -1;
  const int error = errno;
  ::close(file);
  if (size < 0) return refused(name, std::string("netlink: ") + std::strerror(error), "");
  auto found = parse_link_message(std::span(answer).first(static_cast<std::size_t>(size)));
  if (found) found->driver = driver_of(name);
  return found;
}

Result<Done> check_can_interface(const std::string& name, const std::optional<CanInterface>& found,
                                 std::uint32_t wanted_bps) {
  if (!found) {
    return refused(
        name, "no such CAN interface",
        "ip -brief link show type can tells what is there; an slcan adapter: slcand -o -s8 "
        "/dev/ttyACM0 " +
            name);
  }
  if (!found->is_can) {
    return refused(name, "is no CAN interface", "ip -brief link show type can tells which are");
  }
  const std::string rate = std::to_string(wanted_bps == 0 ? 1'000'000 : wanted_bps);
  const std::string set_up =
      found->is_virtual()
          ? "sudo ip link set " + name + " up"
          : "sudo ip link set " + name + " up type can bitrate " + rate + " restart-ms 100";
  if (!found->up) return refused(name, "is down", set_up);
  const bool has_rate = found->bit_rate_bps != 0;  // slcan's is set at its serial line
  if (wanted_bps != 0 && has_rate && found->bit_rate_bps != wanted_bps) {
    return refused(
        name,
        "runs at " + std::to_string(found->bit_rate_bps) + " bit/s, and " + rate + " are wanted",
        "sudo ip link set " + name + " down; " + set_up);
  }
  if (found->state == CanBusState::bus_off) {
    return refused(
        name, "is bus-off: its frames were not understood",
        "bit rates, terminators and wires; then sudo ip link set " + name + " type can restart");
  }
  return Done{};
}

Error why_no_can_socket(const std::string& name, int error) {
  switch (error) {
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return refused(name, "this kernel has no CAN (AF_CAN)", "sudo modprobe can_raw");
    case EACCES:
    case EPERM:
      return refused(
          name, "no permission for CAN sockets",
          "a container needs the host's network; else who runs this kernel must allow it");
    case ENODEV:
    case ENXIO:
      return refused(name, "no such CAN interface", "ip -brief link show type can");
    case ENETDOWN:
      return refused(name, "is down", "sudo ip link set " + name + " up");
    case EBUSY:
    case EADDRINUSE:
      return refused(name, "is held by another program", "lsof or fuser tell which");
    default:
      return refused(name, std::strerror(error), "");
  }
}

}  // namespace whirl::io
