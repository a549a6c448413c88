// InvenSense MPU-6000 without its analogue side: registers, FIFO, interrupt pin and both bus faces.
//
//   In       counts of a sample (store, data_ready) at the times that its owner keeps: a sample every
//            ticks_per_sample() of an 8 kHz clock that Board::clock_restarts() begins
//   Out      answers on the bus, the interrupt pin, and at what its settings ask for (Board)
//   Timing   registers answer register_start_ns after power-up or reset; the clock runs gyro_start_ns
//            after SLEEP is cleared
//   FIFO     1024 bytes in the order of the registers; when full the oldest bytes go, and FIFO_OFLOW
//            says so in INT_STATUS and, if enabled, on INT. Out of reach while USER_CTRL.FIFO_EN is 0
//   Limits   SPI 1 MHz, but 20 MHz for reading sensor, interrupt and FIFO registers; mode 0 or 3
//   Source   PS-MPU-6000A-00 rev 3.4, RM-MPU-6000A-00 rev 4.2; PRODUCT_ID from Betaflight's driver
//   Unknown  how long the registers are dead in reset: no figure is published; a parameter
//   Left out auxiliary I2C master, DMP, self test, motion interrupts, cycle mode, standby per axis,
//            FSYNC, external clocks: as the table says. "Stored" reads back and does nothing; writing
//            anything but the reset value there is a finding
//
//   | register               | bits | here                                                          |
//   | 0x0C PRODUCT_ID        |      | modelled. Write: refused, a finding                           |
//   | 0x0D..0x10 SELF_TEST   |      | stored                                                        |
//   | 0x19 SMPLRT_DIV        |      | modelled                                                      |
//   | 0x1A CONFIG            | 5..3 | EXT_SYNC_SET stored                                           |
//   |                        | 2..0 | DLPF_CFG modelled; 7 counts as 0, a finding                   |
//   | 0x1B GYRO_CONFIG       | 7..5 | self test stored                                              |
//   |                        | 4..3 | FS_SEL modelled                                               |
//   | 0x1C ACCEL_CONFIG      | 7..5 | self test stored                                              |
//   |                        | 4..3 | AFS_SEL modelled                                              |
//   |                        | 2..0 | stored                                                        |
//   | 0x1F MOT_THR           |      | stored                                                        |
//   | 0x23 FIFO_EN           | 7..3 | TEMP, XG, YG, ZG, ACCEL modelled                              |
//   |                        | 2..0 | slaves: stored                                                |
//   | 0x24..0x34 I2C_MST, SLV|      | stored                                                        |
//   | 0x35, 0x36             |      | read as 0. Write: refused, a finding                          |
//   | 0x37 INT_PIN_CFG       | 7..4 | LEVEL, OPEN, LATCH_INT_EN, INT_RD_CLEAR modelled              |
//   |                        | 3..0 | FSYNC, bypass, clock output: stored                           |
//   | 0x38 INT_ENABLE        | 4, 0 | FIFO_OFLOW_EN, DATA_RDY_EN modelled                           |
//   |                        | other| stored                                                        |
//   | 0x3A INT_STATUS        | 4, 0 | FIFO_OFLOW_INT, DATA_RDY_INT modelled; others 0. Write:       |
//   |                        |      | refused, a finding                                            |
//   | 0x3B..0x48 OUT         |      | modelled: a burst is of one sample. Write: refused, a finding |
//   | 0x49..0x60 EXT_SENS    |      | read as 0: no auxiliary bus. Write: refused, a finding        |
//   | 0x63..0x67, 0x69       |      | stored                                                        |
//   | 0x68 SIGNAL_PATH_RESET |      | any write unsettles the filters; reads 0                      |
//   | 0x6A USER_CTRL         | 7, 5 | DMP_EN, I2C_MST_EN stored                                     |
//   |                        | 6    | FIFO_EN modelled                                              |
//   |                        | 4    | I2C_IF_DIS modelled                                           |
//   |                        | 3, 1 | DMP_RESET, I2C_MST_RESET clear themselves                     |
//   |                        | 2, 0 | FIFO_RESET, SIG_COND_RESET modelled, clear themselves         |
//   | 0x6B PWR_MGMT_1        | 7, 6 | DEVICE_RESET, SLEEP modelled                                  |
//   |                        | 5, 3 | CYCLE, TEMP_DIS stored                                        |
//   |                        | 2..0 | CLKSEL 0..3 modelled; others stop the clock, a finding        |
//   | 0x6C PWR_MGMT_2        |      | stored                                                        |
//   | 0x72, 0x73 FIFO_COUNT  |      | modelled: reading H latches both. Write: refused, a finding   |
//   | 0x74 FIFO_R_W          |      | modelled; out of reach while FIFO_EN is 0, a finding          |
//   | 0x75 WHO_AM_I          |      | modelled. Write: refused, a finding                           |
//   | any other              |      | refused: reads 0, writes are ignored, a finding               |
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/devices/core/mpu6000_registers.hpp"
#include "io_bridges/devices/core/part.hpp"
#include "io_bridges/devices/core/register_file.hpp"

namespace whirl::core {

class Mpu6000 {
 public:
  struct Params {
    std::uint8_t product_id = 0x58;              // revision D8
    std::uint8_t i2c_address = 0x68;             // AD0 low
    Nanoseconds register_start_ns = 11'000'000;  // power-up or reset to register access
    Nanoseconds gyro_start_ns = 30'000'000;      // SLEEP cleared to the first sample
  };
  enum class Pin : std::uint8_t { low, high, open };

  // What the part is soldered to, and its analogue side.
  class Board : public Witness {
   public:
    virtual void interrupt_pin(Pin /*pin*/, Nanoseconds /*now*/) {}
    virtual void pulse_ends_at(Nanoseconds /*due*/) {}  // call pulse_over() then
    virtual void was_reset() {}                         // no clock, no pulse
    virtual void clock_restarts(Nanoseconds /*at*/) {}  // kNever: stopped
    virtual void filters_changed() {}
    virtual void filters_unsettled() {}
    virtual void sample_rate_changed() {}
    virtual std::uint8_t identity(std::uint8_t who_am_i, Nanoseconds /*now*/) { return who_am_i; }

   protected:
    ~Board() = default;
  };

  // Not powered up yet: call reset().
  constexpr Mpu6000(const Params& params, Board& board) : params_(params), board_(board) {}

  void reset(Nanoseconds now);
  void set_powered(bool powered) { powered_ = powered; }
  // WHO_AM_I reads this until the next reset or set_identity(); 0: its own. (A fault; a Board may say it, too.)
  void set_identity(std::uint8_t who_am_i) {
    registers_.poke(mpu::WHO_AM_I, who_am_i != 0 ? who_am_i : mpu::kMap[mpu::WHO_AM_I].reset);
  }

  // SPI.
  void select(bool selected);
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now);
  // I2C.
  bool answers(std::uint8_t address_7bit) const;
  bool start(bool read, Nanoseconds now);
  bool write(std::uint8_t byte, Nanoseconds now);
  std::uint8_t read(Nanoseconds now);
  void stop() { end_access(); }

  // For a slave that must answer before it may think: image()[address] is what read_register() will
  // return; what a read sets off comes with read_register() itself, afterwards.
  const std::uint8_t* image(Nanoseconds now) const;
  std::uint8_t read_register(std::uint8_t address, Nanoseconds now);
  void write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  static std::uint8_t next_address(std::uint8_t address);
  void begin_access() { busy_ = true; }
  void end_access();

  // The analogue side. Counts of accelerometer x y z, temperature, gyro x y z; they reach the
  // registers while the bus is idle: one burst, one instant (RM 4.18).
  void store(const std::array<std::int16_t, 7>& counts);
  void data_ready(Nanoseconds now);  // FIFO and interrupt; with or without a store() before it
  void pulse_over(Nanoseconds now) { drive_interrupt(false, now); }
  bool gyro_fast() const;  // its filter runs at 8 kHz
  std::int64_t ticks_per_sample() const;
  unsigned dlpf() const { return registers_.peek(mpu::CONFIG) & 7; }
  unsigned accel_range() const { return registers_.peek(mpu::ACCEL_CONFIG) >> 3 & 3; }
  unsigned gyro_range() const { return registers_.peek(mpu::GYRO_CONFIG) >> 3 & 3; }
  bool internal_clock() const { return (registers_.peek(mpu::PWR_MGMT_1) & mpu::kCLKSEL) == 0; }
  Nanoseconds ready_ns() const { return ready_ns_; }

 private:
  static constexpr std::size_t kFifoBytes = 1024;

  void restart_clock(Nanoseconds now);
  void act_on_write(std::uint8_t address, std::uint8_t before, std::uint8_t value, Nanoseconds now);
  void act_on_power(std::uint8_t before, std::uint8_t value, Nanoseconds now);
  void act_on_user_control(std::uint8_t value);
  void check_unmodelled(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  void check_clock(std::uint32_t sck_Hz, Nanoseconds now);
  std::uint8_t step_address();
  bool fifo_reachable(Nanoseconds now);
  void clear_fifo();
  void fill_fifo(Nanoseconds now);
  void push_fifo(std::uint8_t byte, Nanoseconds now);
  std::uint8_t pop_fifo();
  void show_fifo();
  void raise_interrupt(std::uint8_t status_bit, Nanoseconds now);
  void clear_interrupt(Nanoseconds now);
  void drive_interrupt(bool active, Nanoseconds now);

  Params params_;
  Board& board_;
  RegisterFile registers_{mpu::kMap};
  Nanoseconds ready_ns_ = 0;  // registers answer from here on
  bool powered_ = true, clocked_ = false;
  std::array<std::uint8_t, 14> internal_{};  // the newest sample; registers follow when idle
  bool busy_ = false;                        // a transaction is under way
  bool pending_ = false;                     // internal_ waits for the bus to be idle

  std::array<std::uint8_t, kFifoBytes> fifo_{};
  std::size_t fifo_first_ = 0, fifo_count_ = 0;
  std::uint8_t fifo_last_ = 0;

  bool selected_ = false;
  bool command_passed_ = false;  // SPI: the first byte of the frame
  std::uint8_t command_ = 0, address_ = 0;
  bool pointer_set_ = false;  // I2C: the register byte of this write has passed
};

}  // namespace whirl::core
