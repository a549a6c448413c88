// The four ESCs that the pod plays at 0x29 to 0x2C, two to a block.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "firmware/pod/i2c_slave.hpp"
#include "io_bridges/devices/core/esc_i2c.hpp"

namespace fw::pod {

class PodEsc final : public I2cPart {
 public:
  explicit constexpr PodEsc(std::uint8_t address) : part_(address) {}

  // From the main loop.
  void set_status(const whirl::core::EscStatusCounts& status);
  std::optional<whirl::core::EscI2c::Write> take_write();  // the newest that has not been told

  bool start(bool read) override {
    keep(part_.start(read));
    return true;
  }
  void write(std::uint8_t byte) override { part_.write(byte); }
  std::uint8_t read() override { return part_.read(); }
  void stop() override { keep(part_.stop()); }

 private:
  void keep(const std::optional<whirl::core::EscI2c::Write>& ended) {
    if (ended) newest_ = ended;
  }

  whirl::core::EscI2c part_;
  std::optional<whirl::core::EscI2c::Write> newest_;
};

inline constexpr std::size_t kEscs = 4;
extern std::array<PodEsc, kEscs> escs;
void start_escs();

}  // namespace fw::pod
