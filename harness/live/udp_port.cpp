#include "harness/live/udp_port.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace whirl::live {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Error no_address(const std::string& peer, const std::string& why) {
  return {ErrorKind::bad_input, "--udp " + peer, why, "write HOST:PORT, as 127.0.0.1:14550"};
}

Error no_socket(const char* what) {
  return {ErrorKind::host, "", std::string(what) + ": " + std::strerror(errno), ""};
}

Result<Addresses> resolve(const std::string& peer) {
  const auto colon = peer.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == peer.size()) {
    return no_address(peer, "is no address");
  }
  std::string host = peer.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  const std::string digits = peer.substr(colon + 1);
  const bool number = digits.size() <= 5 && digits.find_first_not_of("0123456789") == digits.npos;
  if (!number || std::stoi(digits) < 1 || std::stoi(digits) > 65535) {
    return no_address(peer, "its port is no number from 1 to 65535");
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int status = getaddrinfo(host.c_str(), digits.c_str(), &hints, &found);
  if (status != 0) return no_address(peer, gai_strerror(status));
  return Addresses(found, freeaddrinfo);
}

// Where the socket listens: the peer's family, the loopback where the peer is there.
std::vector<std::uint8_t> own_address(const addrinfo& peer, std::uint16_t port) {
  std::vector<std::uint8_t> bytes(peer.ai_addrlen);
  if (peer.ai_family == AF_INET6) {
    sockaddr_in6 to{}, own{};
    std::memcpy(&to, peer.ai_addr, sizeof to);
    own.sin6_family = AF_INET6;
    own.sin6_port = htons(port);
    own.sin6_addr = IN6_IS_ADDR_LOOPBACK(&to.sin6_addr) ? in6addr_loopback : in6addr_any;
    std::memcpy(bytes.data(), &own, sizeof own);
    return bytes;
  }
  sockaddr_in to{}, own{};
  std::memcpy(&to, peer.ai_addr, sizeof to);
  const bool loopback = (ntohl(to.sin_addr.s_addr) >> 24) == 127;
  own.sin_family = AF_INET;
  own.sin_port = htons(port);
  own.sin_addr.s_addr = htonl(loopback ? INADDR_LOOPBACK : INADDR_ANY);
  std::memcpy(bytes.data(), &own, sizeof own);
  return bytes;
}

const sockaddr* as_address(const std::vector<std::uint8_t>& bytes) {
  return reinterpret_cast<const sockaddr*>(bytes.data());  // NOLINT: what the sockets API wants
}

// Of one family, that of the socket.
bool one_host(const sockaddr* a, const sockaddr* b) {
  if (a->sa_family != b->sa_family) return false;
  if (a->sa_family == AF_INET6) {
    sockaddr_in6 first{}, second{};
    std::memcpy(&first, a, sizeof first);
    std::memcpy(&second, b, sizeof second);
    return IN6_ARE_ADDR_EQUAL(&first.sin6_addr, &second.sin6_addr);
  }
  sockaddr_in first{}, second{};
  std::memcpy(&first, a, sizeof first);
  std::memcpy(&second, b, sizeof second);
  return first.sin_addr.s_addr == second.sin_addr.s_addr;
}

std::uint16_t port_of(int fd) {
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0) return 0;  // NOLINT
  std::uint16_t port = 0;  // at the same place in both families
  std::memcpy(&port, reinterpret_cast<const std::uint8_t*>(&own) + 2, sizeof port);  // NOLINT
  return ntohs(port);
}

}  // namespace

Result<UdpPort> UdpPort::open(const std::string& peer, std::uint16_t own_port) {
  const auto found = resolve(peer);
  if (!found) return found.error();
  const addrinfo& to = *found.value();
  const int fd = socket(to.ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) return no_socket("no socket for --udp");
  UdpPort port(fd);
  const auto own = own_address(to, own_port);
  if (bind(fd, as_address(own), static_cast<socklen_t>(own.size())) != 0) {
    return no_socket("the port of --listen is not to be had");
  }
  port.own_port_ = port_of(fd);
  port.peer_.resize(to.ai_addrlen);
  std::memcpy(port.peer_.data(), to.ai_addr, to.ai_addrlen);
  return port;
}

UdpPort::~UdpPort() {
  if (fd_ >= 0) close(fd_);
}

UdpPort::UdpPort(UdpPort&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)),
      peer_(std::move(other.peer_)),
      buffer_(std::move(other.buffer_)),
      own_port_(other.own_port_),
      sent_(other.sent_),
      not_sent_(other.not_sent_),
      from_peer_(other.from_peer_) {}

void UdpPort::send(std::span<const std::uint8_t> datagram) {
  const ssize_t n = sendto(fd_, datagram.data(), datagram.size(), 0, as_address(peer_),
                           static_cast<socklen_t>(peer_.size()));
  ++(n == static_cast<ssize_t>(datagram.size()) ? sent_ : not_sent_);
}

std::optional<std::span<const std::uint8_t>> UdpPort::receive() {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  const ssize_t n = recvfrom(fd_, buffer_.data(), buffer_.size(), 0,
                             reinterpret_cast<sockaddr*>(&from), &size);  // NOLINT
  if (n < 0) return std::nullopt;
  from_peer_ = one_host(as_address(peer_), reinterpret_cast<const sockaddr*>(&from));  // NOLINT
  return std::span<const std::uint8_t>(buffer_.data(), static_cast<std::size_t>(n));
}

}  // namespace whirl::live
