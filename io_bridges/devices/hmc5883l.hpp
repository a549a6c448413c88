// Honeywell HMC5883L: magnetometer behind I2C, register by register.
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
//   LOCK     from the first data byte read until all six are, or from reading MODE; new measurements
//            are lost meanwhile. A write of MODE or CONF_A lifts it
//   Self test  the straps' field is measured less the field without it, which takes it out; where
//            the two together overflow, the axis reads -4096
//   Faults   sensor_frozen (data stay, RDY and DRDY go on), sensor_offset (T), sensor_saturated (-4096
//            of that axis), sensor_wrong_identity (0x0A reads value), sensor_late (each measurement
//            comes value seconds later), sensor_brown_out
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "base/random.hpp"
#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/register_file.hpp"
#include "io_bridges/devices/supply_faults.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class Hmc5883l : public I2cTarget {
 public:
  static constexpr std::uint8_t kI2c_address = 0x1E;

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
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds) override {}

  std::uint64_t samples() const { return samples_; }  // placed in the registers

 private:
  std::uint8_t read_register(std::uint8_t address, Nanoseconds now);
  void write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  std::uint8_t accept(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  void advance_pointer();
  void data_read(std::uint8_t address);

  void supply(bool on, Nanoseconds now);
  void set_mode(Nanoseconds now);
  void measure_at(Nanoseconds due);
  void begin_write();
  void place();
  int counts_of(std::size_t axis, double field_T, Nanoseconds now);
  void store(std::size_t axis, int counts);

  bool locked() const;
  void set_status(std::uint8_t bit, bool on);
  void unlock();
  void drive_drdy(bool high, Nanoseconds now);
  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  Wire* drdy_;
  int driver_ = 0;
  FaultBook* faults_;
  RegisterFile registers_;
  RandomStream noise_;
  Event write_begins_, data_placed_, pulse_end_;
  SupplyFaults supply_;
  bool powered_ = true;

  Nanoseconds analog_ready_ns_;
  std::uint8_t gain_;           // of the next measurement; CONF_B may be one ahead
  std::uint8_t data_read_ = 0;  // a bit for each data register since the last whole set
  std::uint64_t samples_ = 0;

  std::uint8_t pointer_ = 0;
  int written_ = 0;  // bytes of this write
};

}  // namespace whirl::io
