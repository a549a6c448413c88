// An MPU-6000 on a bench: SPI and I2C by hand, its INT line watched, its findings kept.
#pragma once
#include <string>
#include <vector>

#include "io_bridges/devices/mpu6000.hpp"

namespace whirl::io {

struct MpuBench {
  EventQueue queue;
  Wire interrupt{"INT", false};
  FaultBook faults;
  std::vector<std::string> findings;
  std::vector<Nanoseconds> rises;
  Mpu6000::Truth truth;
  Mpu6000 part;

  explicit MpuBench(Mpu6000::Params params = exact())
      : part(
            queue, params, [this](Nanoseconds) { return truth; }, &interrupt, &faults,
            [this](const Finding& f) { findings.push_back(f.what); }) {
    interrupt.watch([this](bool level, Nanoseconds now) {
      if (level) rises.push_back(now);
    });
    run(50);
  }
  // No clock error, so that times in tests are round.
  static Mpu6000::Params exact() {
    Mpu6000::Params params;
    params.internal_clock_error = 0.0;
    params.pll_clock_error = 0.0;
    return params;
  }

  void run(double ms) { queue.run_until(queue.now() + static_cast<Nanoseconds>(ms * 1e6)); }

  std::vector<std::uint8_t> spi(std::vector<std::uint8_t> bytes, std::uint32_t sck_Hz = 1'000'000,
                                int mode = 3) {
    part.select(true, queue.now());
    for (std::uint8_t& byte : bytes) byte = part.transfer(byte, sck_Hz, mode, queue.now());
    part.select(false, queue.now());
    return bytes;
  }
  std::uint8_t read(std::uint8_t address) {
    return spi({static_cast<std::uint8_t>(0x80 | address), 0})[1];
  }
  void write(std::uint8_t address, std::uint8_t value) { spi({address, value}); }
  int word(std::uint8_t address) {
    const auto bytes = spi({static_cast<std::uint8_t>(0x80 | address), 0, 0});
    return static_cast<std::int16_t>(bytes[1] << 8 | bytes[2]);
  }
  // Awake on the PLL, 1 kHz, DLPF 42 Hz, data-ready pulses; settled.
  void wake() {
    write(0x1A, 0x03);
    write(0x38, 0x01);
    write(0x6B, 0x01);
    run(80);
    rises.clear();
  }
};

}  // namespace whirl::io
