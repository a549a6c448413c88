// Honeywell HMC5883L without its sensor: registers, modes, lock and status, the DRDY pin.
//
//   In       counts of the three axes as data are placed (place); when, is asked of Board
//   Timing   power-up: 50 ms, then the default single measurement. Single: 6 ms from the write of
//            MODE. Continuous: the first after 2 / rate, then one each 1 / rate. RDY goes low 250 us
//            before data are placed; DRDY pulses low for 5 us as they are
//   LOCK     from the first data byte read until all six are, or from reading MODE; new measurements
//            are lost meanwhile. A write of MODE or CONF_A lifts it
//   Source   HMC5883L data sheet pp. 10-13, 15, 16, 19; pp. 11-14 of the older HMC5883's; Honeywell's
//            operational examples for 6 ms and 56 ms. What the sheets leave open: see the table in
//            io_bridges/devices/hmc5883l.hpp
#pragma once
#include <array>
#include <cstdint>

#include "io_bridges/devices/core/part.hpp"
#include "io_bridges/devices/core/register_file.hpp"

namespace whirl::core {

class Hmc5883l {
 public:
  static constexpr std::uint8_t kI2c_address = 0x1E;
  static constexpr std::int16_t kOverflow_counts = -4096;
  static constexpr Nanoseconds kWriting_ns = 250'000;  // RDY is low so long before data are placed
  static const RegisterMap kMap;

  class Board : public Witness {
   public:
    // Call write_begins() kWriting_ns before that, and place() then. kNever: no more.
    virtual void data_due(Nanoseconds /*at*/) {}
    virtual void drdy_pin(bool /*high*/, Nanoseconds /*now*/) {}
    virtual void pulse_ends_at(Nanoseconds /*due*/) {
    }  // call pulse_over() then; kNever: not at all
    virtual std::uint8_t identity(std::uint8_t id_a, Nanoseconds /*now*/) { return id_a; }

   protected:
    ~Board() = default;
  };

  // Not powered up yet: call supply().
  explicit constexpr Hmc5883l(Board& board) : board_(board) {}

  void supply(bool on, Nanoseconds now);

  bool start(bool read);
  bool write(std::uint8_t byte, Nanoseconds now);
  std::uint8_t read(Nanoseconds now);

  // The sensor's side.
  void write_begins();
  // True: the counts (x, y, z) went into the registers, or would have in a part that is not frozen.
  bool place(const std::array<std::int16_t, 3>& counts, bool frozen, Nanoseconds now);
  void pulse_over(Nanoseconds now) { board_.drdy_pin(true, now); }
  unsigned gain() const { return gain_; }  // of the next measurement
  unsigned averages() const { return 1u << (registers_.peek(0) >> 5 & 3); }
  bool locked() const;  // data that are placed now are lost
  int bias() const;     // of the self test: 1, -1 or 0

 private:
  std::uint8_t read_register(std::uint8_t address, Nanoseconds now);
  void write_register(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  std::uint8_t accept(std::uint8_t address, std::uint8_t value, Nanoseconds now);
  std::uint8_t accept_conf_a(std::uint8_t value, std::uint8_t before, Nanoseconds now);
  void advance_pointer();
  void data_read(std::uint8_t address);
  void set_mode(Nanoseconds now);
  unsigned rate() const { return registers_.peek(0) >> 2 & 7; }
  void set_status(std::uint8_t bit, bool on);
  void unlock();

  Board& board_;
  RegisterFile registers_{kMap};
  bool powered_ = true;
  Nanoseconds analog_ready_ns_ = 0;
  unsigned gain_ = 0;           // CONF_B may be one ahead
  std::uint8_t data_read_ = 0;  // a bit for each data register since the last whole set
  std::uint8_t pointer_ = 0;
  int written_ = 0;  // bytes of this write
};

}  // namespace whirl::core
