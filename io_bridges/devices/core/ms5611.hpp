// MEAS MS5611-01BA03 without its sensor: commands, conversions, PROM and both bus faces.
//
//   In       24 bit counts of a finished conversion (converted); when, is asked of Board
//   Timing   reload 2.8 ms; a conversion lasts what Board makes of kOversampling. A command acts as
//            its last bit passes
//   Limits   SPI up to 20 MHz, mode 0 or 3
//   Source   MS5611-01BA03 data sheet: "Commands", "I2C interface", "Performance specifications";
//            MS5837-30BA data sheet p. 11 (reading too early, converting twice); longest times as in
//            the drivers' tables
//   Memory   shortest conversion times, SDO low while converting: no page of the sheet was at hand
//   Unknown  SDO while a command byte passes, PROM before a first RESET, an unknown command's
//            acknowledge: see the table in io_bridges/devices/ms5611.hpp
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "io_bridges/devices/core/part.hpp"

namespace whirl::core {

class Ms5611 {
 public:
  enum class Quantity : std::uint8_t { pressure, temperature };
  using Prom = std::array<std::uint16_t, 8>;  // word 0 factory data, 1..6 C1..C6, 7 serial and CRC
  struct Oversampling {
    Nanoseconds shortest_ns, longest_ns;
  };
  static constexpr std::array<Oversampling, 5> kOversampling{{{480'000, 600'000},
                                                              {950'000, 1'170'000},
                                                              {1'880'000, 2'280'000},
                                                              {3'720'000, 4'540'000},
                                                              {7'400'000, 9'040'000}}};
  static constexpr std::uint32_t kMost_counts = 0xFFFFFF;

  class Board : public Witness {
   public:
    // One has begun: call converted() at its end. `osr` is the row of kOversampling.
    virtual void conversion_begins(Quantity /*quantity*/, std::size_t /*osr*/,
                                   Nanoseconds /*now*/) {}
    virtual void conversion_dropped() {}
    virtual std::uint16_t last_prom_word(std::uint16_t word, Nanoseconds /*now*/) { return word; }

   protected:
    ~Board() = default;
  };

  constexpr Ms5611(const Prom& prom, std::uint8_t i2c_address, Board& board)
      : prom_(prom), i2c_address_(i2c_address), board_(board) {}

  void supply(bool on);
  void set_prom(const Prom& prom) { prom_ = prom; }

  // SPI.
  void select();
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now);
  // I2C.
  bool answers(std::uint8_t address_7bit) const { return address_7bit == i2c_address_; }
  bool start(bool read);
  bool write(std::uint8_t byte, Nanoseconds now);
  std::uint8_t read();

  // The sensor's side, at the end of a conversion: what it measured, unless the part is frozen.
  // Where spoiled(), `garbage` is what will be read.
  Quantity quantity() const { return quantity_; }
  std::size_t osr() const { return osr_; }
  bool spoiled() const { return spoiled_; }
  void converted(std::uint32_t fresh, bool frozen, std::uint32_t garbage);

 private:
  void command(std::uint8_t byte, Nanoseconds now);
  void reset(Nanoseconds now);
  void drop_conversion();
  void convert(Quantity quantity, std::size_t osr, Nanoseconds now);
  void read_adc(Nanoseconds now);
  void read_prom(std::size_t word, Nanoseconds now);
  bool answer_waits() const { return answer_next_ < answer_size_; }
  void clear_answer() { answer_next_ = answer_size_ = 0; }
  bool busy(Nanoseconds now) const { return now < ready_ns_ || converting_; }

  Prom prom_;
  std::uint8_t i2c_address_;
  Board& board_;
  bool powered_ = true;
  Nanoseconds ready_ns_ = 0;  // the PROM is reloaded
  bool converting_ = false;
  Quantity quantity_{};
  std::size_t osr_ = 0;                    // 0: 256, 4: 4096
  bool spoiled_ = false;                   // the running conversion was disturbed
  std::uint32_t result_ = 0;               // of the last conversion, until it is read
  bool waiting_ = false;                   // result_ has not been read
  std::array<std::uint32_t, 2> newest_{};  // of each quantity
  std::array<std::uint8_t, 3> answer_{};
  std::uint8_t answer_next_ = 0, answer_size_ = 0;
  bool command_passed_ = false;  // of this frame
};

}  // namespace whirl::core
