// An emulated HID device under this machine's own kernel, by /dev/uhid: hidraw and the kernel's drivers see it.
//
//   Time     the queue follows the monotonic clock from creation on
//   Threads  one: whoever calls serve(), which answers whatever has come and returns
//   Errors   no /dev/uhid or no permission: bad_input, with the cure
#pragma once
#include <cstdint>
#include <memory>

#include "base/result.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/hid/emulated/emulated_hid.hpp"

namespace whirl::io {

class UhidDevice {
 public:
  static Result<std::unique_ptr<UhidDevice>> create(EventQueue& queue, EmulatedHid& device);
  ~UhidDevice();  // unplugs it
  UhidDevice(const UhidDevice&) = delete;
  UhidDevice& operator=(const UhidDevice&) = delete;

  // Waits for the kernel, at most so long, and lets the device act.
  void serve(std::int64_t timeout_ns);

 private:
  UhidDevice(EventQueue& queue, EmulatedHid& device, int fd);
  void keep_time();
  void take_event();
  void give_input();

  EventQueue& queue_;
  EmulatedHid& device_;
  int fd_;
  std::int64_t zero_ns_;
};

}  // namespace whirl::io
