// An MS5611 on a bench: on an I2C bus and an SPI bus of its own, its findings kept.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/devices/ms5611.hpp"
#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/tests/ms5611_sheet.hpp"
#include "io_bridges/devices/wire_faults.hpp"

namespace whirl::io {

struct Ms5611Bench {
  using Bytes = std::vector<std::uint8_t>;

  EventQueue queue;
  FaultBook faults;
  I2cBus i2c{"I2C2"};
  SpiBus spi{"SPI1"};
  Wire chip_select{"CS"};
  int driver = chip_select.add_driver();
  std::vector<std::string> findings;
  Ms5611::Truth truth{95000.0, 273.15 + 31.5};
  int sensed = 0;
  Ms5611::Params params;
  Ms5611 part;
  I2cWireFaults wire_faults{queue, faults, i2c, 2};
  SpiWireFaults spi_faults{faults, part, 1, 4};

  explicit Ms5611Bench(const Ms5611::Params& given = silent())
      : params(given),
        part(
            queue, given,
            [this](Nanoseconds) {
              ++sensed;
              return truth;
            },
            &faults, [this](const Finding& f) { findings.push_back(f.what); }) {
    i2c.add(part);
    spi.add(spi_faults, chip_select);
  }
  static Ms5611::Params silent() {
    Ms5611::Params params;
    params.noise_scale = 0.0;
    params.bus = 2;
    params.device = 0x77;
    return params;
  }

  Nanoseconds now() const { return queue.now(); }
  void run_us(double us) { queue.run_until(now() + static_cast<Nanoseconds>(us * 1e3)); }

  // False: the address or the command was not acknowledged.
  bool command(std::uint8_t byte, std::uint8_t address = 0x77) {
    i2c.start(now());
    const bool acked = i2c.address(address, false, now()) && i2c.write(byte, now());
    i2c.stop(now());
    return acked;
  }
  Bytes read(std::uint8_t command_byte, int length) {
    if (!command(command_byte)) return {};
    i2c.start(now());
    EXPECT_TRUE(i2c.address(0x77, true, now()));
    Bytes bytes;
    for (int i = 0; i < length; ++i) bytes.push_back(i2c.read(i + 1 < length, now()));
    i2c.stop(now());
    return bytes;
  }
  Bytes transfer(Bytes bytes, std::uint32_t sck_Hz = 10'000'000, int mode = 3) {
    chip_select.drive(driver, Drive::low, now());
    for (std::uint8_t& byte : bytes) byte = spi.transfer(byte, sck_Hz, mode, now());
    chip_select.drive(driver, Drive::high, now());
    return bytes;
  }

  static std::uint32_t word(const Bytes& bytes) {
    std::uint32_t value = 0;
    for (const std::uint8_t byte : bytes) value = value << 8 | byte;
    return value;
  }
  std::uint32_t adc() { return word(read(0x00, 3)); }
  std::uint32_t convert(std::uint8_t byte) {
    EXPECT_TRUE(command(byte));
    run_us(9040);
    return adc();
  }
  SheetResult measure(int osr = 4) {
    const std::uint32_t D2 = convert(static_cast<std::uint8_t>(0x50 + 2 * osr));
    const std::uint32_t D1 = convert(static_cast<std::uint8_t>(0x40 + 2 * osr));
    return sheet_of_reals(params.prom, D1, D2);
  }
};

}  // namespace whirl::io
