// InvenSense MPU-6000: accelerometer, gyro and thermometer behind SPI or I2C, register by register.
//
//   In       specific force and rate in the sensor's axes (x forward, y left, z up on our board),
//            asked for through Params::sense at each tick of the part's own 8 kHz clock, in order
//   Out      big-endian counts; scales and full ranges of the datasheet; clips at int16
//   Timing   the part's own clock (CLKSEL 0: internal, 1..3: PLL) with its error; registers answer
//            register_start_ns after power-up or reset, first sample gyro_start_ns after SLEEP is
//            cleared, then every (1 + SMPLRT_DIV) ticks of 8 or 1 kHz. DLPF as in dlpf.hpp.
//   FIFO     1024 bytes in the order of the registers; when full the oldest bytes go, and FIFO_OFLOW
//            says so in INT_STATUS and, if enabled, on INT. Out of reach while USER_CTRL.FIFO_EN is 0
//   Limits   SPI 1 MHz, but 20 MHz for reading sensor, interrupt and FIFO registers: beyond is a
//            finding. SPI mode 0 or 3.
//   Source   PS-MPU-6000A-00 rev 3.4, RM-MPU-6000A-00 rev 4.2; PRODUCT_ID from Betaflight's driver
//   Unknown  how long the registers are dead in reset: no figure is published; a parameter
//   Faults   sensor_frozen, sensor_offset and sensor_saturated (by axis), sensor_wrong_identity
//            (WHO_AM_I reads value), sensor_brown_out
//   Left out auxiliary I2C master, DMP, self test, motion interrupts, cycle mode, standby per axis,
//            FSYNC, external clocks: stored, and a finding when asked for
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/dlpf.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/register_file.hpp"
#include "io_bridges/devices/supply_faults.hpp"
#include "io_bridges/devices/wire.hpp"

namespace whirl::io {

class Mpu6000 : public SpiTarget, public I2cTarget {
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

  void select(bool selected, Nanoseconds now) override;
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override;

  bool answers(std::uint8_t address_7bit) const override;
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds now) override;

  Nanoseconds last_sample_ns() const { return sample_ns_; }
  std::uint64_t samples() const { return samples_; }

 private:
  struct Axis {
    std::optional<Dlpf> filter;
    double latched = 0.0;
  };

  // Registers, as either bus reaches them.
  std::uint8_t read_register(std::uint8_t address, Nanoseconds now);
  void write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  void act_on_write(std::uint8_t address, std::uint8_t before, std::uint8_t value, Nanoseconds now);
  void check_unmodelled(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  std::uint8_t next_address(std::uint8_t address) const;
  void check_clock(std::uint32_t sck_Hz, Nanoseconds now);
  void begin_access() { busy_ = true; }
  void end_access();

  // Power and clock.
  void reset(Nanoseconds now);
  void supply(bool on, Nanoseconds now);
  void restart_clock(Nanoseconds now);
  double tick_ns() const;
  std::int64_t ticks_per_sample() const;
  Nanoseconds time_of_tick(std::int64_t tick) const;
  void set_filters();

  // Sampling.
  void run_ticks(std::int64_t until);
  void take_sample();
  void encode_sample(Nanoseconds now);
  const Fault* fault(FaultKind kind, Nanoseconds now, int axis = kAnywhere) {
    return apply(faults_, kind, params_.bus, params_.device, now, axis);
  }
  double faulted(int axis, double value, Nanoseconds now);
  void store(std::uint8_t address, long counts);

  // FIFO and interrupt.
  bool fifo_reachable(Nanoseconds now);
  std::uint8_t read_fifo(Nanoseconds now);
  void write_fifo(std::uint8_t value, Nanoseconds now);
  void fill_fifo();
  void push_fifo(std::uint8_t byte);
  std::uint8_t pop_fifo();
  void raise_interrupt(std::uint8_t status_bit);
  void clear_interrupt(Nanoseconds now);
  void drive_interrupt(bool active, Nanoseconds now);

  EventQueue& queue_;
  Params params_;
  Sense sense_;
  Wire* interrupt_;
  int driver_ = 0;
  FaultBook* faults_;
  RegisterFile registers_;
  Event sample_due_, pulse_end_;
  SupplyFaults supply_;
  bool powered_ = true;

  Nanoseconds ready_ns_ = 0;       // registers answer from here on
  Nanoseconds clock_ns_ = kNever;  // of tick 0; kNever: asleep
  std::int64_t ticks_ = 0;         // done so far
  std::int64_t next_sample_ = 0;   // tick of the next sample
  Nanoseconds sample_ns_ = kNever;
  std::uint64_t samples_ = 0;

  std::array<Axis, 6> axes_;  // accelerometer x y z, gyro x y z
  double temperature_K_ = 298.15;
  bool settled_ = false;                     // the filters have seen a first input
  std::array<std::uint8_t, 14> internal_{};  // the newest sample; registers follow when idle
  bool busy_ = false;                        // a transaction is under way
  bool pending_ = false;                     // internal_ waits for the bus to be idle

  std::deque<std::uint8_t> fifo_;
  std::uint8_t fifo_last_ = 0;

  // Bus faces.
  bool selected_ = false;
  std::optional<std::uint8_t> command_;  // SPI: first byte of the frame, once seen
  std::uint8_t address_ = 0;
  bool pointer_set_ = false;  // I2C: the register byte of this write has passed
};

}  // namespace whirl::io
