// An ESC as its I2C master sees it (core/esc_i2c.hpp), in SI, with the times of what was written.
//
//   Other    on_setpoint() tells every write, good or not, with the times of its START and STOP;
//   side     set_status() is what the next read answers
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/esc_i2c.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::io {

class EscI2c : public I2cTarget {
 public:
  struct Write {
    bool valid = false;
    std::uint16_t v = 0;  // 0 when not valid
    Nanoseconds start_ns = 0, stop_ns = 0;
  };

  explicit EscI2c(std::uint8_t address_7bit) : part_(address_7bit) {}

  void on_setpoint(std::function<void(const Write&)> sink) { sink_ = std::move(sink); }
  void set_status(const EscStatus& status) { part_.set_status(counts_of(status)); }
  std::uint64_t writes() const { return part_.writes(); }
  std::uint64_t rejected() const { return part_.rejected(); }

  bool answers(std::uint8_t address_7bit) const override { return address_7bit == part_.address(); }
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds /*now*/) override {
    part_.write(byte);
    return true;
  }
  std::uint8_t read(Nanoseconds /*now*/) override { return part_.read(); }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds now) override { report(part_.stop(), now); }

 private:
  void report(const std::optional<core::EscI2c::Write>& ended, Nanoseconds now);

  core::EscI2c part_;
  std::function<void(const Write&)> sink_;
  Nanoseconds start_ns_ = 0;
};

}  // namespace whirl::io
