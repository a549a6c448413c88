#include "io_bridges/socketcan/tests/played_kernel.hpp"

#include <fcntl.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace whirl::io {

PlayedKernel* PlayedKernel::at_work = nullptr;

namespace {

int can_file = -1,
    netlink_file =
        -1;  // of the socket that was opened last; a pipe's number could be the same later

timespec time_of(std::int64_t t_ns) {
  return {t_ns / 1'000'000'000, t_ns % 1'000'000'000};
}

template <typename T>
void add_control(msghdr& message, std::size_t& used, int type, const T& value) {
  auto* head = reinterpret_cast<cmsghdr*>(static_cast<char*>(message.msg_control) + used);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = type;
  head->cmsg_len = CMSG_LEN(sizeof value);
  std::memcpy(CMSG_DATA(head), &value, sizeof value);
  used += CMSG_SPACE(sizeof value);
}

void add_controls(msghdr& message, const PlayedKernel::Incoming& in) {
  std::size_t used = 0;
  if (in.lost) add_control(message, used, SO_RXQ_OVFL, *in.lost);
  scm_timestamping stamps{};
  if (in.software_ns) stamps.ts[0] = time_of(*in.software_ns);
  if (in.hardware_ns) stamps.ts[2] = time_of(*in.hardware_ns);
  if (in.software_ns || in.hardware_ns) add_control(message, used, SO_TIMESTAMPING, stamps);
  message.msg_controllen = used;
}

}  // namespace
}  // namespace whirl::io

using whirl::io::PlayedKernel;

// Named as the linker's --wrap has them.
extern "C" {

int __real_socket(int, int, int);
int __real_close(int);
ssize_t __real_send(int, const void*, std::size_t, int);
ssize_t __real_recv(int, void*, std::size_t, int);
ssize_t __real_write(int, const void*, std::size_t);
int __real_clock_gettime(clockid_t, timespec*);

int __wrap_socket(int family, int type, int protocol) {
  PlayedKernel* kernel = PlayedKernel::at_work;
  if (kernel == nullptr) return __real_socket(family, type, protocol);
  if (family == AF_CAN && kernel->socket_error != 0) {
    errno = kernel->socket_error;
    return -1;
  }
  const int file = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  (family == AF_CAN ? whirl::io::can_file : whirl::io::netlink_file) = file;
  ++kernel->opened;
  return file;
}

int __wrap_close(int file) {
  if (PlayedKernel::at_work != nullptr) ++PlayedKernel::at_work->closed;
  return __real_close(file);
}

ssize_t __wrap_send(int file, const void* bytes, std::size_t size, int flags) {
  if (PlayedKernel::at_work == nullptr) return __real_send(file, bytes, size, flags);
  return static_cast<ssize_t>(size);
}

ssize_t __wrap_recv(int file, void* bytes, std::size_t size, int flags) {
  PlayedKernel* kernel = PlayedKernel::at_work;
  if (kernel == nullptr) return __real_recv(file, bytes, size, flags);
  const std::size_t count = std::min(size, kernel->link.size());
  std::memcpy(bytes, kernel->link.data(), count);
  return static_cast<ssize_t>(count);
}

int __wrap_bind(int /*file*/, const sockaddr* address, socklen_t /*size*/) {
  PlayedKernel& kernel = *PlayedKernel::at_work;
  sockaddr_can can{};
  std::memcpy(&can, address, sizeof can);
  kernel.bound_to = can.can_ifindex;
  errno = kernel.bind_error;
  return kernel.bind_error == 0 ? 0 : -1;
}

int __wrap_setsockopt(int /*file*/, int level, int name, const void* value, socklen_t size) {
  std::uint32_t word = 0;
  std::memcpy(&word, value, std::min<std::size_t>(sizeof word, size));
  PlayedKernel::at_work->options.push_back({level, name, word});
  return 0;
}

ssize_t __wrap_write(int file, const void* bytes, std::size_t size) {
  PlayedKernel* kernel = PlayedKernel::at_work;
  if (kernel == nullptr || file != whirl::io::can_file) return __real_write(file, bytes, size);
  int error = 0;
  if (!kernel->send_errors.empty()) {
    error = kernel->send_errors.front();
    kernel->send_errors.pop_front();
  }
  if (error != 0) {
    errno = error;
    return -1;
  }
  can_frame frame{};
  std::memcpy(&frame, bytes, std::min(size, sizeof frame));
  kernel->sent.push_back(frame);
  return static_cast<ssize_t>(size);
}

ssize_t __wrap_recvmsg(int /*file*/, msghdr* message, int /*flags*/) {
  PlayedKernel& kernel = *PlayedKernel::at_work;
  PlayedKernel::Incoming in{.error = EAGAIN};
  if (!kernel.incoming.empty()) {
    in = kernel.incoming.front();
    kernel.incoming.pop_front();
  }
  message->msg_controllen = in.error != 0 ? 0 : message->msg_controllen;
  if (in.error != 0) {
    errno = in.error;
    return -1;
  }
  std::memcpy(message->msg_iov->iov_base, &in.frame, static_cast<std::size_t>(in.size));
  message->msg_flags = in.flags;
  whirl::io::add_controls(*message, in);
  return in.size;
}

int __wrap_clock_gettime(clockid_t clock, timespec* out) {
  const PlayedKernel* kernel = PlayedKernel::at_work;
  if (kernel == nullptr) return __real_clock_gettime(clock, out);
  *out = whirl::io::time_of(clock == CLOCK_REALTIME ? kernel->realtime_ns : kernel->monotonic_ns);
  return 0;
}

}  // extern "C"
