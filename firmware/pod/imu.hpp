// The MPU-6000 that the pod plays: the part (io_bridges/devices/core), its data-ready pin, and the
// samples of the host in place of an analogue side.
//
//   Sample   each is a data-ready when it is due (sample_clock.hpp), as soon as the part's clock runs; the host keeps
//            the rate that the part is set to (its settings are in every status)
//   Left out the FIFO and the I2C face: their registers read as the part's, no bytes pass
#pragma once
#include <array>
#include <cstdint>

#include "firmware/pod/spi_slave.hpp"
#include "io_bridges/devices/core/mpu6000.hpp"

namespace fw::pod {

class PodImu final : whirl::core::Mpu6000::Board {
 public:
  using Counts = std::array<std::int16_t, 7>;

  constexpr PodImu() = default;

  void start();  // power-up
  void set_faults(bool frozen, bool powered, std::uint8_t identity);
  // From the main loop.
  void sample(const Counts& counts, std::uint32_t due_us);  // in the order of their times
  void poll();  // the registers come up some time after a reset

  // At kPriorityParts.
  void transfer_over(const Transfer& transfer);
  void pulse_over();
  void alarm() { show_due(); }

  std::uint8_t setting(std::uint8_t address) const;
  std::uint32_t oddities() const { return oddities_; }
  std::uint8_t last_oddity() const { return last_oddity_; }
  std::uint32_t overlaps() const { return overlaps_; }  // samples stored as a transfer began
  std::uint32_t samples() const { return samples_; }

 private:
  void odd(whirl::core::Oddity what, std::uint32_t detail, std::int64_t now) override;
  void interrupt_pin(whirl::core::Mpu6000::Pin pin, std::int64_t now) override;
  void pulse_ends_at(std::int64_t due) override;
  void was_reset() override;
  void clock_restarts(std::int64_t at) override { clock_ns_ = at; }
  const std::uint8_t* answers(std::int64_t now) const;
  void rearm(std::int64_t now);
  void show_due();
  void show(const Counts& counts);

  struct Waiting {
    std::uint32_t due_us = 0;
    Counts counts{};
  };
  static constexpr std::size_t kRoom = 8;  // the longest wait of 6 ms, at 1 kHz

  whirl::core::Mpu6000 part_{{}, *this};
  std::int64_t clock_ns_ = whirl::core::kNever;
  bool frozen_ = false, powered_ = true;
  std::uint8_t identity_ = 0, last_oddity_ = 0;
  std::uint32_t oddities_ = 0, overlaps_ = 0, samples_ = 0;
  const std::uint8_t* armed_ = nullptr;
  std::array<Waiting, kRoom> waiting_{};
  std::size_t first_ = 0, waits_ = 0;
};

extern PodImu imu;

}  // namespace fw::pod
