// A HID port to an emulated device in the same process, in virtual time.
//
//   Cable    a report takes one frame of USB (1 ms) each way. `reports_left`: after so many, the plug is pulled;
//            `late_ns`: so much later do answers come
#pragma once
#include <cstdint>
#include <span>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/hid/emulated/emulated_hid.hpp"
#include "io_bridges/hid/hid_port.hpp"

namespace whirl::io {

struct HidCable {
  bool plugged = true;
  std::int64_t reports_left = -1;  // negative: no end
  Nanoseconds late_ns = 0;
  std::int64_t reports = 0;  // out, so far
};

class MemoryHidPort : public HidPort {
 public:
  MemoryHidPort(EventQueue& queue, EmulatedHid& device, HidCable& cable)
      : queue_(queue), device_(device), cable_(cable) {}

  Result<Done> write(std::span<const std::uint8_t> report) override;
  Result<HidReport> read(std::int64_t timeout_ns) override;
  Result<HidReport> get_feature(std::uint8_t number, std::size_t length) override;
  Result<Done> set_feature(std::span<const std::uint8_t> report) override;
  Result<HidReport> report_descriptor() override { return device_.identity().descriptor; }
  std::int64_t now_ns() const override { return queue_.now(); }
  void pause_ns(std::int64_t duration_ns) override { queue_.run_until(queue_.now() + duration_ns); }

 private:
  static constexpr Nanoseconds kFrame_ns = 1'000'000;
  bool passes();

  EventQueue& queue_;
  EmulatedHid& device_;
  HidCable& cable_;
  Nanoseconds written_ns_ = 0;
};

}  // namespace whirl::io
