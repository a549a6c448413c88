#include "io_bridges/socketcan/socket_can.hpp"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

#include "io_bridges/socketcan/error_frame.hpp"

namespace whirl::io {
namespace {

std::int64_t ns_of(const timespec& t) {
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return ns_of(t);
}

can_frame to_kernel(const CanFrame& frame) {
  can_frame out{};
  out.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0) | (frame.remote ? CAN_RTR_FLAG : 0);
  out.can_dlc = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), out.data);
  return out;
}

CanFrame from_kernel(const can_frame& in) {
  CanFrame frame;
  frame.extended = (in.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (in.can_id & CAN_RTR_FLAG) != 0;
  frame.id = in.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(in.can_dlc, 8);
  if (!frame.remote) std::copy_n(in.data, frame.length, frame.data.begin());
  return frame;
}

}  // namespace

Result<SocketCan> SocketCan::open(const std::string& interface, std::uint32_t bit_rate_bps) {
  const int file = ::socket(AF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (file < 0) return why_no_can_socket(interface, errno);
  auto found = read_can_interface(interface);
  auto good = found ? check_can_interface(interface, found.value(), bit_rate_bps)
                    : Result<Done>(found.error());
  if (!good) {
    ::close(file);
    return good.error();
  }
  SocketCan port(file, *found.value());
  if (const auto asked = port.ask_for_all(); !asked) return asked.error();
  return port;
}

Result<Done> SocketCan::ask_for_all() {
  const can_err_mask_t all_errors = CAN_ERR_MASK;
  const int on = 1;
  const int stamps = SOF_TIMESTAMPING_RX_HARDWARE | SOF_TIMESTAMPING_RAW_HARDWARE |
                     SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  setsockopt(file_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &all_errors, sizeof all_errors);
  setsockopt(file_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof on);
  setsockopt(file_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  setsockopt(file_, SOL_SOCKET, SO_TIMESTAMPING, &stamps, sizeof stamps);
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = interface_.index;
  if (bind(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return why_no_can_socket(interface_.name, errno);
  }
  return Done{};
}

SocketCan::SocketCan(int file, CanInterface interface)
    : file_(file), interface_(std::move(interface)) {}

SocketCan::SocketCan(SocketCan&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      interface_(std::move(other.interface_)),
      stamps_(other.stamps_),
      dropped_(other.dropped_) {}

SocketCan& SocketCan::operator=(SocketCan&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(interface_, other.interface_);
  std::swap(stamps_, other.stamps_);
  std::swap(dropped_, other.dropped_);
  return *this;
}

SocketCan::~SocketCan() {
  if (file_ >= 0) ::close(file_);
}

Error SocketCan::gone(int error) const {
  const bool unplugged = error == ENODEV || error == ENXIO;
  return {ErrorKind::host, interface_.name,
          unplugged           ? "the CAN adapter was unplugged"
          : error == ENETDOWN ? "the CAN interface went down"
                              : std::strerror(error),
          "plug it in, set it up and run again"};
}

Result<bool> SocketCan::send(const CanFrame& frame) {
  const can_frame out = to_kernel(frame);
  if (::write(file_, &out, sizeof out) == static_cast<ssize_t>(sizeof out)) return true;
  if (errno == EAGAIN || errno == ENOBUFS || errno == EINTR) return false;
  return gone(errno);
}

Result<std::optional<CanArrival>> SocketCan::receive() {
  can_frame in{};
  iovec part{&in, sizeof in};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(file_, &message, 0);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::optional<CanArrival>();
  if (size < 0) return gone(errno);
  if (size < static_cast<ssize_t>(sizeof in)) return std::optional<CanArrival>();
  CanArrival arrival;
  arrival.own = (message.msg_flags & MSG_CONFIRM) != 0;
  read_control(message, arrival);
  if ((in.can_id & CAN_ERR_FLAG) != 0) {
    std::array<std::uint8_t, 8> data{};
    std::copy_n(in.data, data.size(), data.begin());
    arrival.trouble = parse_error_frame(in.can_id, data);
  } else {
    arrival.frame = from_kernel(in);
  }
  return std::optional(arrival);
}

void SocketCan::read_control(const msghdr& message, CanArrival& arrival) {
  const std::int64_t read_ns = now_ns(CLOCK_MONOTONIC);
  arrival.host_ns = read_ns;
  scm_timestamping stamps{};
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr;
       c = CMSG_NXTHDR(const_cast<msghdr*>(&message), c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t all = 0;
      std::memcpy(&all, CMSG_DATA(c), sizeof all);
      arrival.dropped = all - dropped_;
      dropped_ = all;
    } else if (c->cmsg_type == SO_TIMESTAMPING) {
      std::memcpy(&stamps, CMSG_DATA(c), sizeof stamps);
    }
  }
  // The kernel's stamp is of the realtime clock, which may be set meanwhile: only its age counts.
  const std::int64_t software_ns = ns_of(stamps.ts[0]), hardware_ns = ns_of(stamps.ts[2]);
  if (software_ns != 0) {
    const std::int64_t age_ns = now_ns(CLOCK_REALTIME) - software_ns;
    if (age_ns >= 0 && age_ns < 1'000'000'000) arrival.host_ns = read_ns - age_ns;
  }
  if (hardware_ns == 0) return;
  arrival.hardware_stamp = true;
  arrival.host_ns = stamps_.host_ns(hardware_ns, arrival.host_ns);
}

std::string SocketCan::version() const {
  const CanInterface& i = interface_;
  std::string text = i.name + ": " + (i.driver.empty() ? i.kind : i.driver);
  if (i.bit_rate_bps != 0) text += ", " + std::to_string(i.bit_rate_bps) + " bit/s";
  if (i.is_virtual()) return text + ", virtual: no bit rate, no errors";
  text += i.restart_ms == 0 ? ", stays off after bus-off"
                            : ", restarts " + std::to_string(i.restart_ms) + " ms after bus-off";
  return text;
}

}  // namespace whirl::io
