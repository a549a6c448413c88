// InvenSense MPU-6000: accelerometer, gyro and thermometer behind SPI or I2C. Registers, FIFO and pins
// are core/mpu6000.hpp's; here is what it measures, when, and the faults of a run.
//
//   In       specific force and rate in the sensor's axes (x forward, y left, z up on our board),
//            asked for through Params::sense at each tick of the part's own 8 kHz clock, in order
//   Out      big-endian counts; scales and full ranges of the datasheet; clips at int16
//   Timing   the part's own clock (CLKSEL 0: internal, 1..3: PLL) with its error: a sample every
//            (1 + SMPLRT_DIV) ticks of 8 or 1 kHz. DLPF as in dlpf.hpp
//   Source   PS-MPU-6000A-00 rev 3.4, RM-MPU-6000A-00 rev 4.2; PRODUCT_ID from Betaflight's driver
//   Faults   sensor_frozen; by axis sensor_offset, sensor_drift, sensor_scale and sensor_saturated;
//            sensor_wrong_identity (WHO_AM_I reads value), sensor_brown_out
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/core/mpu6000.hpp"
#include "io_bridges/devices/dlpf.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/supply_faults.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class Mpu6000 : public SpiTarget, public I2cTarget, private core::Mpu6000::Board {
 public:
  struct Truth {
    std::array<double, 3> specific_force_mps2{0.0, 0.0, 9.80665};
    std::array<double, 3> rate_radps{};
    double temperature_K = 298.15;
  };
  struct Params {
    std::string name = "mpu6000";
    std::uint8_t product_id = 0x58;              // revision D8
    std::uint8_t i2c_address = 0x68;             // AD0 low
    double internal_clock_error = 0.02;          // of 8 kHz; the datasheet allows 5 %
    double pll_clock_error = 0.002;              // the datasheet allows 1 %
    Nanoseconds register_start_ns = 11'000'000;  // power-up or reset to register access
    Nanoseconds gyro_start_ns = 30'000'000;      // SLEEP cleared to the first sample
    int bus = kAnywhere, device = kAnywhere;     // where faults find it
  };
  using Sense = std::function<Truth(Nanoseconds)>;

  // `interrupt` may be null (INT not connected), so may `faults`.
  Mpu6000(EventQueue& queue, const Params& params, Sense sense, Wire* interrupt, FaultBook* faults,
          FindingSink findings);

  void select(bool selected, Nanoseconds /*now*/) override { part_.select(selected); }
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override {
    return part_.transfer(mosi, sck_Hz, mode, now);
  }

  bool answers(std::uint8_t address_7bit) const override { return part_.answers(address_7bit); }
  bool start(std::uint8_t /*address_7bit*/, bool read, Nanoseconds now) override {
    return part_.start(read, now);
  }
  bool write(std::uint8_t byte, Nanoseconds now) override { return part_.write(byte, now); }
  std::uint8_t read(Nanoseconds now) override { return part_.read(now); }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds /*now*/) override { part_.stop(); }

  Nanoseconds last_sample_ns() const { return sample_ns_; }
  std::uint64_t samples() const { return samples_; }

 private:
  struct Axis {
    std::optional<Dlpf> filter;
    double latched = 0.0;
  };

  // What the registers ask for.
  void odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) override;
  void interrupt_pin(core::Mpu6000::Pin pin, Nanoseconds now) override;
  void pulse_ends_at(Nanoseconds due) override { pulse_end_.at(due); }
  void was_reset() override;
  void clock_restarts(Nanoseconds at) override;
  void filters_changed() override;
  void filters_unsettled() override { settled_ = false; }
  void sample_rate_changed() override;
  std::uint8_t identity(std::uint8_t who_am_i, Nanoseconds now) override;

  void supply(bool on, Nanoseconds now);
  double tick_ns() const;
  Nanoseconds time_of_tick(std::int64_t tick) const;

  // Sampling.
  void run_ticks(std::int64_t until);
  void take_sample();
  void encode_sample(Nanoseconds now);
  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }
  double faulted(int axis, double value, Nanoseconds now);

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  Wire* interrupt_;
  int driver_ = 0;
  FaultBook* faults_;
  OnceFindings findings_;
  core::Mpu6000 part_;
  Event sample_due_, pulse_end_;
  SupplyFaults supply_;

  Nanoseconds clock_ns_ = kNever;  // of tick 0; kNever: asleep
  std::int64_t ticks_ = 0;         // done so far
  std::int64_t next_sample_ = 0;   // tick of the next sample
  Nanoseconds sample_ns_ = kNever;
  std::uint64_t samples_ = 0;

  std::array<Axis, 6> axes_;  // accelerometer x y z, gyro x y z
  double temperature_K_ = 298.15;
  bool settled_ = false;  // the filters have seen a first input
};

}  // namespace whirl::io
