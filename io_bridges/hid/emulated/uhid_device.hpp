// An emulated HID device under this machine's own kernel, by /dev/uhid: hidraw and the kernel's drivers see it.
//
//   Time     the queue follows the monotonic clock from creation on
//   Cable    a report takes `frame_ns` each way; feature reports take no time. At 0 a host that asks for a status again
//            and again takes a processor from whoever is asked, as at a bridge of USB's full speed (1 ms) it cannot
//   Threads  one: whoever calls serve(), which answers whatever has come and returns
//   Errors   no /dev/uhid or no permission: bad_input, with the cure
#pragma once
#include <cstdint>
#include <deque>
#include <memory>

#include "base/result.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/hid/emulated/emulated_hid.hpp"

namespace whirl::io {

class UhidDevice {
 public:
  static Result<std::unique_ptr<UhidDevice>> create(EventQueue& queue, EmulatedHid& device,
                                                    Nanoseconds frame_ns = 0);
  ~UhidDevice();  // unplugs it
  UhidDevice(const UhidDevice&) = delete;
  UhidDevice& operator=(const UhidDevice&) = delete;

  // Waits for the kernel, at most so long, and lets the device act.
  void serve(std::int64_t timeout_ns);

 private:
  struct OnCable {
    Nanoseconds arrives_ns;
    HidReport report;
  };
  UhidDevice(EventQueue& queue, EmulatedHid& device, Nanoseconds frame_ns, int fd);
  void keep_time();
  void take_event();
  void carry();
  Nanoseconds next_ns() const;

  EventQueue& queue_;
  EmulatedHid& device_;
  Nanoseconds frame_ns_;
  std::deque<OnCable> to_device_, to_host_;
  int fd_;
  std::int64_t zero_ns_;
};

}  // namespace whirl::io
