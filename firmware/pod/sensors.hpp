// The MS5611 and the HMC5883L that the pod plays on one I2C block, and the host's counts behind them.
//
//   Barometer     a conversion lasts the middle of the part's range and gives what the host told last
//                 of that quantity
//   Magnetometer  counts are placed as they come, but no earlier than the part would measure: the host
//                 keeps the rate that it is set to. What falls into a read, which would lose it, waits
//                 for the read's end: the link has moved it there
#pragma once
#include <array>
#include <cstdint>

#include "firmware/pod/i2c_slave.hpp"
#include "io_bridges/devices/core/hmc5883l.hpp"
#include "io_bridges/devices/core/ms5611.hpp"

namespace fw::pod {

class PodBarometer final : whirl::core::Ms5611::Board, public I2cPart {
 public:
  static constexpr std::uint8_t kAddress = 0x76;

  // From the main loop.
  void set_prom(const whirl::core::Ms5611::Prom& prom);
  void set_counts(std::uint8_t quantity, std::uint32_t counts);
  void poll();
  std::uint32_t oddities() const { return oddities_; }

  bool start(bool read) override { return part_.start(read); }
  void write(std::uint8_t byte) override;
  std::uint8_t read() override { return part_.read(); }

 private:
  void odd(whirl::core::Oddity, std::uint32_t, std::int64_t) override { ++oddities_; }
  void conversion_begins(whirl::core::Ms5611::Quantity, std::size_t osr, std::int64_t now) override;
  void conversion_dropped() override { due_ns_ = whirl::core::kNever; }

  whirl::core::Ms5611 part_{{}, kAddress, *this};
  std::array<std::uint32_t, 2> counts_{};
  std::int64_t due_ns_ = whirl::core::kNever;
  std::uint32_t oddities_ = 0;
};

class PodMagnetometer final : whirl::core::Hmc5883l::Board, public I2cPart {
 public:
  void power_up();
  void set_counts(const std::array<std::int16_t, 3>& counts);
  void poll();
  std::uint32_t oddities() const { return oddities_; }

  bool start(bool read) override { return part_.start(read); }
  void write(std::uint8_t byte) override;
  std::uint8_t read() override;

 private:
  void odd(whirl::core::Oddity, std::uint32_t, std::int64_t) override { ++oddities_; }
  void data_due(std::int64_t at) override { due_ns_ = at; }

  whirl::core::Hmc5883l part_{*this};
  std::array<std::int16_t, 3> counts_{};
  bool fresh_ = false;  // counts_ have not been placed
  std::int64_t came_ns_ = 0;
  std::int64_t due_ns_ = whirl::core::kNever;
  std::uint32_t oddities_ = 0;
};

extern PodBarometer barometer;
extern PodMagnetometer magnetometer;
void start_sensors();

}  // namespace fw::pod
