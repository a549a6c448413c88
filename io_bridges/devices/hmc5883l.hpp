// Honeywell HMC5883L: magnetometer behind I2C. Registers, modes and the lock are core/hmc5883l.hpp's;
// here is what it measures and the faults of a run.
//
//   In       magnetic field in the part's own axes, asked for through Params::sense as a measurement
//            is placed in the registers, in order of time
//   Out      big-endian counts in the order X, Z, Y; -2048..2047 by the gain, beyond: -4096
//   Timing   power-up: 50 ms, then the default single measurement. Single: 6 ms from the write of
//            MODE. Continuous: the first after 2 / rate, then one each 1 / rate. RDY goes low 250 us
//            before data are placed; DRDY pulses low for 5 us as they are
//   Noise    white, of one measurement; MA averages divide it by the root of their number
//   Source   HMC5883L data sheet pp. 10-13, 15, 16, 19; pp. 11-14 of the older HMC5883's for the DRDY
//            pulse, the mode after a single measurement and the pointer beyond 12; Honeywell's
//            operational examples for 6 ms and 56 ms
//   Memory   2 mGa RMS, 50 ms of the 56: no page of the sheet was at hand for these
//   Unknown  what averaging adds to the 6 ms (here nothing), an address past the pointer byte's (here
//            the pointer goes on, a finding), what reserved codes do (refused), CONF_A changed while
//            it measures continuously (here it begins anew)
//   Left out temperature and supply dependence, sensitivity and cross-axis errors, tolerance of the
//            self-test straps, their share of noise
//
//   | register       | bits  | here                                                               |
//   | 0x00 CONF_A    | 7     | refused: a finding (temperature compensation of the HMC5983)       |
//   |                | 6..5  | MA modelled: 1, 2, 4, 8                                            |
//   |                | 4..2  | DO modelled: 0.75..75 Hz; 7 refused: a finding, the old one stays  |
//   |                | 1..0  | MS modelled: normal, +, -; 3 refused: a finding, the old one stays |
//   | 0x01 CONF_B    | 7..5  | GN modelled; the next measurement still has the old gain           |
//   |                | 4..0  | refused: a finding                                                 |
//   | 0x02 MODE      | 7..2  | refused: a finding (7: HS)                                         |
//   |                | 1..0  | MD modelled: continuous, single, idle, idle; reads 3 after a single|
//   | 0x03..0x08     |       | modelled: data. Write: refused, a finding                          |
//   | 0x09 STATUS    | 1, 0  | LOCK, RDY modelled. Write: refused, a finding                      |
//   | 0x0A..0x0C ID  |       | modelled: 'H', '4', '3'. Write: refused, a finding                 |
//   | any other      |       | refused: reads 0, writes are ignored, a finding                    |
//
//   Self test  the straps' field is measured less the field without it, which takes it out; where
//            the two together overflow, the axis reads -4096
//   Faults   sensor_frozen (data stay, RDY and DRDY go on), sensor_offset (T), sensor_drift (T a minute),
//            sensor_saturated (-4096 of that axis), sensor_wrong_identity (0x0A reads value), sensor_late (each measurement
//            comes value seconds later), sensor_brown_out
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/hmc5883l.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/supply_faults.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class Hmc5883l : public I2cTarget, private core::Hmc5883l::Board {
 public:
  static constexpr std::uint8_t kI2c_address = core::Hmc5883l::kI2c_address;

  struct Params {
    std::string name = "hmc5883l";
    double noise_T = 2e-7;  // RMS of one measurement
    std::uint64_t seed = 1;
    int bus = kAnywhere, device = kAnywhere;  // where faults find it
  };
  using Sense = std::function<std::array<double, 3>(Nanoseconds)>;  // T, x y z

  // `drdy` may be null (not connected), so may `faults`.
  Hmc5883l(EventQueue& queue, const Params& params, Sense sense, Wire* drdy, FaultBook* faults,
           FindingSink findings);

  bool answers(std::uint8_t address_7bit) const override { return address_7bit == kI2c_address; }
  bool start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds /*now*/) override {
    return part_.start(read);
  }
  bool write(std::uint8_t byte, Nanoseconds now) override { return part_.write(byte, now); }
  std::uint8_t read(Nanoseconds now) override { return part_.read(now); }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds) override {}

  std::uint64_t samples() const { return samples_; }  // placed in the registers

 private:
  void odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) override;
  void data_due(Nanoseconds at) override;
  void drdy_pin(bool high, Nanoseconds now) override;
  void pulse_ends_at(Nanoseconds due) override;
  std::uint8_t identity(std::uint8_t id_a, Nanoseconds now) override;

  void place();
  std::int16_t counts_of(std::size_t axis, double field_T, Nanoseconds now);
  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  Wire* drdy_;
  int driver_ = 0;
  FaultBook* faults_;
  OnceFindings findings_;
  RandomStream noise_;
  core::Hmc5883l part_{*this};
  Event write_begins_, data_placed_, pulse_end_;
  SupplyFaults supply_;
  std::uint64_t samples_ = 0;
};

}  // namespace whirl::io
