// I2C (v1) of the STM32F4 and F1: master and slave on one register set. One event per byte.
//
//   Source    RM0090 chapter 27 (F103: RM0008 chapter 26, the same block)
//   Timing    bit = 2, 3 or 25 CCR / PCLK1; SB half a bit after START is possible, a byte after
//             nine bits, STOP one bit. TXE when DR moves to the shift register, BTF when that is
//             through as well
//   Clock     a byte neither begins (nor is asked for) nor ends while SCL is low: a slave that stretches, a stuck
//             line. As a slave it stretches through its SCL pin (NOSTRETCH = 0)
//             A transmitter whose clock goes away holds its bit, SDA low unless it sends FF, until PE
//             or SWRST frees it
//   Lines     START waits for SDA and SCL high; SDA low under a sent 1 loses arbitration (ARLO)
//   Findings  START with SCL or SDA not muxed, FREQ that is not PCLK1, a rate its mode forbids
//   Left out  10-bit addresses, SMBus (PEC, ARP, ALERT, TIMEOUT), misplaced conditions (BERR),
//             the nine clocks that free an abandoned transmitter, rise time (TRISE is stored), analog filter
#pragma once
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

struct I2cPins {
  Signal& scl;
  Signal& sda;
};

class I2c final : public WordBlock, private io::I2cTarget {
 public:
  I2c(std::string name, Chip chip, int event_irq, int error_irq, I2cPins pins);

  io::I2cBus& bus() { return bus_; }
  DmaRequest& tx_request() { return tx_request_; }
  DmaRequest& rx_request() { return rx_request_; }

  void reset() override;

 private:
  enum class Phase : std::uint8_t {
    idle,
    starting,  // towards a START or repeated START
    addressing,
    sending,
    receiving,
    holding,  // SCL held low: the software is to act
    stopping,
  };
  enum class Slave : std::uint8_t { none, receiver, transmitter };

  // Registers (i2c.cpp)
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_cr1(std::uint32_t value);
  void write_dr(std::uint8_t value);
  std::uint8_t read_dr();
  std::uint32_t read_sr1();
  std::uint32_t read_sr2();
  void address_cleared();
  void clear_state();
  void update();
  void clocks_changed();
  void line_changed();
  bool lines_high() { return bus_.sda().level() && bus_.scl().level(); }
  bool routed() const { return pins_.scl.routed() && pins_.sda.routed(); }
  void check_setup();
  void report_once(std::uint32_t bit, const char* what);

  // Master (i2c_master.cpp)
  void try_start();
  void act();  // the software asked for START or STOP while the clock is held
  void begin_bits(Phase phase, int bits);
  void after_bits(int bits);  // the next step, from when the clock may run on
  void step();                // the end of what `phase_` says
  void started();
  void address_sent();
  void byte_sent();
  void byte_received();
  void next_or_hold(bool more);
  void load_shift();
  void begin_receive();
  void begin_stop();
  void stopped();
  bool lost_arbitration(std::uint8_t sent);
  bool acknowledge_now();
  void store_received(std::uint8_t byte);

  // Slave: called by the bus (i2c_slave.cpp)
  bool answers(std::uint8_t address_7bit) const override;
  bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) override;
  bool write(std::uint8_t byte, Nanoseconds now) override;
  std::uint8_t read(Nanoseconds now) override;
  void acked(bool ack, Nanoseconds now) override;
  void stop(Nanoseconds now) override;
  void abandoned(Nanoseconds now) override;
  using WordBlock::read;
  using WordBlock::write;
  void load_slave_shift();
  void update_stretch();

  Chip chip_;
  int event_irq_, error_irq_;
  I2cPins pins_;
  io::I2cBus bus_;
  DmaRequest tx_request_, rx_request_;
  io::Event step_;
  std::uint32_t cr1_ = 0, cr2_ = 0, oar1_ = 0, oar2_ = 0, sr1_ = 0, ccr_ = 0, trise_ = 2;
  std::uint32_t sr1_seen_ = 0;  // flags that were set when SR1 was last read
  Phase phase_ = Phase::idle;
  Slave slave_ = Slave::none;
  bool master_ = false, transmitter_ = false;
  bool dr_full_ = false;     // DR waits for the shift register
  bool shift_full_ = false;  // receive: a byte waits for DR; slave transmit: a byte waits for SCL
  bool nacked_ = false;      // the transfer's last byte has been refused: only STOP or START left
  bool next_ack_ = true;     // POS: what the ACK bit said one byte ago
  bool dma_last_ = false;    // LAST: the byte that comes now is the last
  bool waits_for_scl_ = false;
  bool fetch_due_ = false;  // the byte to receive begins once SCL is high
  bool general_call_ = false, second_address_ = false;
  std::uint8_t dr_ = 0, shift_ = 0;
  double bit_ns_ = 1.0;
  std::uint32_t reported_ = 0;
};

}  // namespace whirl::stm32
