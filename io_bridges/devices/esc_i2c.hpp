// An ESC as its I2C master sees it: set-points in, status out. What turns the motor is elsewhere.
//
//   Writes   3 bytes with a good CRC are a set-point; any other is ignored, counted, and shows in
//            flag bit 7 of the next status read. A write ends at STOP or repeated START.
//   Reads    6 bytes of status, frozen at START; beyond them 0xFF
//   Other    on_setpoint() tells every write, good or not, with the times of its START and STOP;
//   side     set_status() is what the next read answers
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::io {

class EscI2c : public I2cTarget {
 public:
  struct Write {
    bool valid = false;
    std::uint16_t v = 0;  // 0 when not valid
    Nanoseconds start_ns = 0, stop_ns = 0;
  };

  explicit EscI2c(std::uint8_t address_7bit) : address_(address_7bit) {}

  void on_setpoint(std::function<void(const Write&)> sink) { sink_ = std::move(sink); }
  void set_status(const EscStatus& status) { status_ = status; }
  std::uint64_t writes() const { return writes_; }
  std::uint64_t rejected() const { return rejected_; }

  bool answers(std::uint8_t address_7bit) const override { return address_7bit == address_; }
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds now) override { finish(now); }

 private:
  void finish(Nanoseconds now);

  std::uint8_t address_;
  std::function<void(const Write&)> sink_;
  EscStatus status_;
  bool writing_ = false;
  Nanoseconds start_ns_ = 0;
  std::vector<std::uint8_t> received_;
  std::array<std::uint8_t, 6> answer_{};
  std::size_t answered_ = 0;
  bool rejected_since_read_ = false;
  std::uint64_t writes_ = 0, rejected_ = 0;
};

}  // namespace whirl::io
