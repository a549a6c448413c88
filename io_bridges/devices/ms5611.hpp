// MEAS MS5611-01BA03: barometer and thermometer behind I2C or SPI. Commands and both bus faces are
// core/ms5611.hpp's; here is what it measures, when, and the faults of a run.
//
//   In       static pressure and temperature of the part, asked for through Params::sense as each
//            conversion ends, in order of time
//   Out      24 bit counts that the data sheet's calculation turns back (ms5611_calibration.hpp)
//   Timing   reload 2.8 ms; conversions by one oscillator, which is the part's own: conversion_share
//            0 is the sheet's shortest of each OSR, 1 its longest. A command acts as its last bit
//            passes
//   Noise    white, RMS by OSR; self-heating, drift and lag: left out here (the physics before the
//            part has drift and lag; self-heating nobody has)
//   Limits   SPI up to 20 MHz, mode 0 or 3: beyond is a finding
//   Source   MS5611-01BA03 data sheet: first page (ranges, RMS resolution), "Commands", "I2C
//            interface", "Performance specifications"; MS5837-30BA data sheet p. 11 (reading too
//            early, converting twice); longest times as in the drivers' tables
//   Memory   shortest conversion times, RMS of temperature by OSR, SDO low while converting: no page
//            of the sheet was at hand for these
//   Unknown  what the spoiled result reads, SDO while a command byte passes, PROM before a first
//            RESET, an unknown command's acknowledge: see the table
//
//   | command              | here                                                                  |
//   | 0x1E RESET           | modelled; drops a conversion and its result. Any command during the   |
//   |                      | reload is lost: a finding; I2C reads 0, SPI holds SDO low             |
//   | 0x40..0x48 even      | modelled: D1 at OSR 256..4096. During a conversion: starts anew, its  |
//   | 0x50..0x58 even      | result is wrong (drawn bits), a finding; D2 the same                  |
//   | 0x00 ADC READ        | modelled: 24 bits once. With no result waiting, or read already: 0    |
//   |                      | and a finding. While converting: 0, the result to come is wrong, a    |
//   |                      | finding                                                               |
//   | 0xA0..0xAE even      | modelled: PROM word; there before the first RESET, too. While         |
//   |                      | converting: answered, a finding                                       |
//   | any other            | refused: a finding; acknowledged, reads 0                             |
//   | second byte written  | refused: a finding; I2C only, on SPI it clocks data                   |
//   | read past the data   | I2C 0, SPI 0xFF (0x00 while converting)                               |
//
//   Faults   sensor_frozen (each result repeats the last of its kind), sensor_offset (axis 0 Pa,
//            1 K), sensor_drift (the same a minute), sensor_saturated (that axis reads 0xFFFFFF), sensor_wrong_identity (PROM word 7,
//            serial and CRC, has value's bits turned over: of 1 to 15 no copy's check holds),
//            sensor_late (conversions take value seconds longer), sensor_brown_out
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/ms5611.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/ms5611_calibration.hpp"
#include "io_bridges/devices/supply_faults.hpp"

namespace whirl::io {

class Ms5611 : public SpiTarget, public I2cTarget, private core::Ms5611::Board {
 public:
  struct Truth {
    double pressure_Pa = 101325.0;
    double temperature_K = 293.15;
  };
  struct Params {
    std::string name = "ms5611";
    ms5611::Prom prom = ms5611::make_prom(ms5611::kTypical, 0, 0);
    std::uint8_t i2c_address = 0x77;  // CSB low; 0x76 with CSB high
    double conversion_share = 0.5;    // 0..1, see Timing
    double noise_scale = 1.0;         // of the sheet's RMS
    std::uint64_t seed = 1;
    int bus = kAnywhere, device = kAnywhere;  // where faults find it
  };
  using Sense = std::function<Truth(Nanoseconds)>;

  // `faults` may be null.
  Ms5611(EventQueue& queue, const Params& params, Sense sense, FaultBook* faults,
         FindingSink findings);

  void select(bool /*selected*/, Nanoseconds /*now*/) override { part_.select(); }
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override {
    return part_.transfer(mosi, sck_Hz, mode, now);
  }

  bool answers(std::uint8_t address_7bit) const override { return part_.answers(address_7bit); }
  bool start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds /*now*/) override {
    return part_.start(read);
  }
  bool write(std::uint8_t byte, Nanoseconds now) override { return part_.write(byte, now); }
  std::uint8_t read(Nanoseconds /*now*/) override { return part_.read(); }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds) override {}

 private:
  using Quantity = core::Ms5611::Quantity;

  void odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) override;
  void conversion_begins(Quantity quantity, std::size_t osr, Nanoseconds now) override;
  void conversion_dropped() override { conversion_.cancel(); }
  std::uint16_t last_prom_word(std::uint16_t word, Nanoseconds now) override;

  void converted();
  std::uint32_t counts(Nanoseconds now);
  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  FaultBook* faults_;
  OnceFindings findings_;
  RandomStream noise_, garbage_;
  core::Ms5611 part_;
  Event conversion_;  // its end
  SupplyFaults supply_;
};

}  // namespace whirl::io
