#include "io_bridges/hid/emulated/uhid_device.hpp"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace whirl::io {
namespace {

std::int64_t monotonic_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

bool give(int fd, const uhid_event& event) {
  return ::write(fd, &event, sizeof event) == ssize_t{sizeof event};
}

template <std::size_t N>
void set_text(std::uint8_t (&field)[N], const std::string& text) {
  std::snprintf(reinterpret_cast<char*>(field), N, "%s", text.c_str());
}

uhid_event creation(const HidIdentity& identity) {
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& create = event.u.create2;
  set_text(create.name, identity.name);
  set_text(create.uniq, identity.serial);
  set_text(create.phys, "whirl/" + identity.serial);
  create.bus = BUS_USB;
  create.vendor = identity.vendor;
  create.product = identity.product;
  create.rd_size = static_cast<std::uint16_t>(identity.descriptor.size());
  std::copy(identity.descriptor.begin(), identity.descriptor.end(), create.rd_data);
  return event;
}

}  // namespace

Result<std::unique_ptr<UhidDevice>> UhidDevice::create(EventQueue& queue, EmulatedHid& device,
                                                       Nanoseconds frame_ns) {
  const int fd = ::open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (fd < 0) {
    return Error{ErrorKind::bad_input, "/dev/uhid", std::strerror(errno),
                 errno == ENOENT ? "as root: modprobe uhid" : "as root"};
  }
  std::unique_ptr<UhidDevice> made(new UhidDevice(queue, device, frame_ns, fd));
  if (!give(fd, creation(device.identity()))) {
    return Error{ErrorKind::bad_input, "/dev/uhid", std::strerror(errno),
                 "does the kernel know uhid's CREATE2?"};
  }
  return made;
}

UhidDevice::UhidDevice(EventQueue& queue, EmulatedHid& device, Nanoseconds frame_ns, int fd)
    : queue_(queue),
      device_(device),
      frame_ns_(frame_ns),
      fd_(fd),
      zero_ns_(monotonic_ns() - queue.now()) {}

UhidDevice::~UhidDevice() {
  close(fd_);
}

void UhidDevice::keep_time() {
  queue_.run_until(std::max(queue_.now(), monotonic_ns() - zero_ns_));
}

void UhidDevice::serve(std::int64_t timeout_ns) {
  keep_time();
  carry();
  const std::int64_t wait_ns = std::clamp<std::int64_t>(next_ns() - queue_.now(), 0, timeout_ns);
  const timespec wait{wait_ns / 1'000'000'000, wait_ns % 1'000'000'000};
  pollfd poll{fd_, POLLIN, 0};
  const bool came = ppoll(&poll, 1, &wait, nullptr) > 0;
  keep_time();
  if (came) take_event();
  carry();
}

// When something is due, of the device itself or on its cable.
Nanoseconds UhidDevice::next_ns() const {
  Nanoseconds next = queue_.next_deadline();
  if (!to_device_.empty()) next = std::min(next, to_device_.front().arrives_ns);
  if (!to_host_.empty()) next = std::min(next, to_host_.front().arrives_ns);
  return next;
}

void UhidDevice::take_event() {
  uhid_event event{}, reply{};
  if (::read(fd_, &event, sizeof event) < 0) return;
  if (event.type == UHID_OUTPUT) {
    HidReport report(event.u.output.data, event.u.output.data + event.u.output.size);
    // Kernel drivers leave out the 0 of a device without numbers; hidraw hands it on.
    const bool bare = !device_.identity().numbered && (report.size() != 65 || report[0] != 0);
    if (bare) report.insert(report.begin(), 0);
    to_device_.push_back({queue_.now() + frame_ns_, std::move(report)});
  } else if (event.type == UHID_GET_REPORT) {
    const auto report = device_.feature(event.u.get_report.rnum);
    reply.type = UHID_GET_REPORT_REPLY;
    reply.u.get_report_reply.id = event.u.get_report.id;
    reply.u.get_report_reply.err = report ? 0 : EIO;
    if (report) {
      reply.u.get_report_reply.size = static_cast<std::uint16_t>(report->size());
      std::copy(report->begin(), report->end(), reply.u.get_report_reply.data);
    }
    give(fd_, reply);
  } else if (event.type == UHID_SET_REPORT) {
    const auto& set = event.u.set_report;
    reply.type = UHID_SET_REPORT_REPLY;
    reply.u.set_report_reply.id = set.id;
    reply.u.set_report_reply.err = device_.set_feature({set.data, set.size}) ? 0 : EIO;
    give(fd_, reply);
  }
}

void UhidDevice::carry() {
  for (; !to_device_.empty() && to_device_.front().arrives_ns <= queue_.now();
       to_device_.pop_front()) {
    device_.output(to_device_.front().report);
  }
  while (device_.has_input()) to_host_.push_back({queue_.now() + frame_ns_, device_.take_input()});
  for (; !to_host_.empty() && to_host_.front().arrives_ns <= queue_.now(); to_host_.pop_front()) {
    const HidReport& report = to_host_.front().report;
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<std::uint16_t>(report.size());
    std::copy(report.begin(), report.end(), event.u.input2.data);
    give(fd_, event);
  }
}

}  // namespace whirl::io
