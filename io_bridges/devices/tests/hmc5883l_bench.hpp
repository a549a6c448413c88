// An HMC5883L on a bench: on an I2C bus of its own, its DRDY line watched, its findings kept.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "io_bridges/devices/hmc5883l.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/devices/wire_faults.hpp"

namespace whirl::io {

struct HmcBench {
  using Bytes = std::vector<std::uint8_t>;
  struct Edge {
    bool level;
    Nanoseconds t_ns;
    bool operator==(const Edge&) const = default;
  };

  EventQueue queue;
  FaultBook faults;
  I2cBus i2c{"I2C2"};
  Wire drdy{"DRDY", false};
  std::vector<std::string> findings;
  std::vector<Edge> edges;
  std::array<double, 3> field_T{1e-5, 2e-5, -3e-5};
  Hmc5883l part;
  I2cWireFaults wire_faults{queue, faults, i2c, 2};

  explicit HmcBench(double noise_T = 0.0, std::uint64_t seed = 1)
      : part(
            queue, {.noise_T = noise_T, .seed = seed, .bus = 2, .device = 0x1E},
            [this](Nanoseconds) { return field_T; }, &drdy, &faults,
            [this](const Finding& f) { findings.push_back(f.what); }) {
    drdy.watch([this](bool level, Nanoseconds now) { edges.push_back({level, now}); });
    i2c.add(part);
  }
  // Past power-up and its single measurement, which nobody has read.
  void power_up() {
    run_us(60000);
    edges.clear();
  }

  Nanoseconds now() const { return queue.now(); }
  void run_us(double us) { queue.run_until(now() + static_cast<Nanoseconds>(us * 1e3)); }

  bool write(const Bytes& bytes) {
    i2c.start(now());
    bool acked = i2c.address(0x1E, false, now());
    for (const std::uint8_t byte : bytes) acked = acked && i2c.write(byte, now());
    i2c.stop(now());
    return acked;
  }
  void set(std::uint8_t address, std::uint8_t value) { EXPECT_TRUE(write({address, value})); }
  // From where the pointer stands.
  Bytes read_on(int length) {
    i2c.start(now());
    EXPECT_TRUE(i2c.address(0x1E, true, now()));
    Bytes bytes;
    for (int i = 0; i < length; ++i) bytes.push_back(i2c.read(i + 1 < length, now()));
    i2c.stop(now());
    return bytes;
  }
  Bytes read(std::uint8_t address, int length) {
    write(Bytes(1, address));
    return read_on(length);
  }
  int get(std::uint8_t address) { return read(address, 1)[0]; }

  static int word(const Bytes& bytes, std::size_t at) {
    return static_cast<std::int16_t>(bytes[at] << 8 | bytes[at + 1]);
  }
  // As the registers stand: x, z, y.
  std::array<int, 3> data() {
    const Bytes bytes = read(0x03, 6);
    return {word(bytes, 0), word(bytes, 2), word(bytes, 4)};
  }
  std::array<int, 3> measure() {
    set(0x02, 0x01);
    run_us(6000);
    return data();
  }
  // With its first measurement, which has the old gain, thrown away.
  void set_gain(int gain) {
    set(0x01, static_cast<std::uint8_t>(gain << 5));
    measure();
  }
};

}  // namespace whirl::io
