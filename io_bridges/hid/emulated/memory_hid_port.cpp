#include "io_bridges/hid/emulated/memory_hid_port.hpp"

#include <algorithm>

namespace whirl::io {
namespace {

Error unplugged() {
  return {ErrorKind::host, "memory", "the plug has been pulled", ""};
}

}  // namespace

bool MemoryHidPort::passes() {
  if (cable_.reports_left == 0) cable_.plugged = false;
  if (cable_.reports_left > 0) --cable_.reports_left;
  if (!cable_.plugged) return false;
  pause_ns(kFrame_ns);
  return true;
}

Result<Done> MemoryHidPort::write(std::span<const std::uint8_t> report) {
  if (!passes()) return unplugged();
  ++cable_.reports;
  device_.output(report);
  written_ns_ = now_ns();
  return Done{};
}

Result<HidReport> MemoryHidPort::read(std::int64_t timeout_ns) {
  const Nanoseconds until = now_ns() + timeout_ns;
  while (cable_.plugged) {
    const Nanoseconds comes = written_ns_ + cable_.late_ns;
    if (device_.has_input() && now_ns() >= comes) {
      pause_ns(kFrame_ns);
      return device_.take_input();
    }
    if (now_ns() >= until) return HidReport{};
    const Nanoseconds next = device_.has_input() ? comes : queue_.next_deadline();
    queue_.run_until(std::clamp(next, now_ns(), until));
  }
  return unplugged();
}

Result<HidReport> MemoryHidPort::get_feature(std::uint8_t number, std::size_t length) {
  if (!passes()) return unplugged();
  auto report = device_.feature(number);
  if (!report) return Error{ErrorKind::host, "memory", "no such feature report", ""};
  if (report->size() > length) report->resize(length);
  return *report;
}

Result<Done> MemoryHidPort::set_feature(std::span<const std::uint8_t> report) {
  if (!passes()) return unplugged();
  if (!device_.set_feature(report))
    return Error{ErrorKind::host, "memory", "no such feature report", ""};
  return Done{};
}

}  // namespace whirl::io
