// SPI of the STM32F4 and F1: master and slave, 8 and 16 bits, CRC, DMA. One event per frame.
//
//   Source    RM0090 chapter 28 (F103: RM0008 chapter 25, same registers)
//   Timing    frame = bits x 2^(BR+1) / PCLK; TXE when DR moves to the shift register, RXNE and BSY
//             at the last bit. SPE cleared in a frame: the frame still ends (28.3.9)
//   Slave     (spi_slave.cpp) a byte moves from DR to the shift register as its first bit goes out, and
//             TXE rises: DR is filled one byte ahead. NSS only gates clocks: a byte that the master
//             breaks off leaves the bit counter where it is until SPE = 0, and what waits in DR when
//             NSS rises begins the next transfer. DR empty: its last content goes out again, which
//             the manual does not specify. BSY from a byte's first bit to its last
//   Findings  a frame with SCK, MOSI or MISO not muxed to a pin; I2S mode; as a slave a byte sent with
//             DR empty, one that began before SPE was set
//   Left out  I2S, TI frame format (FRF); as a slave 16 bits, LSB first, CRC, and the times of edges
//             inside a byte that the bit counter splits
#pragma once
#include <memory>

#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/spi_slave.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

struct SpiPins {
  Signal& sck;
  Signal& miso;
  Signal& mosi;
  Signal& nss;
};

class Spi final : public WordBlock, public io::SpiSlave {
 public:
  Spi(std::string name, Chip chip, int irq, bool on_apb2, SpiPins pins);

  io::SpiBus& bus() { return bus_; }
  DmaRequest& tx_request() { return tx_request_; }
  DmaRequest& rx_request() { return rx_request_; }
  // An external master's clock. 0xFF: this slave is not selected.
  Nanoseconds shift_out(Nanoseconds now) override;
  std::uint8_t sampled(std::uint8_t mosi, int bits, Nanoseconds now) override;
  int mode() const override;
  io::SpiSlack slack() const override { return slack_; }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;

  void write_cr1(std::uint32_t value);
  void write_dr(std::uint16_t value);
  std::uint32_t read_sr();
  void check_mode_fault();
  void drive_nss();
  bool receive_only() const;
  bool receives() const;
  void next_frame();
  void begin_frame(std::uint16_t value);
  void end_frame();
  std::uint16_t on_wire(std::uint16_t mosi) const;
  std::uint16_t shift(std::uint16_t mosi);
  void received(std::uint16_t value);
  void update();
  void clocks_changed();
  std::uint16_t crc(std::uint32_t crc, std::uint16_t data) const;
  void report_once(std::uint32_t bit, const char* what);

  // Slave (spi_slave.cpp)
  bool selected_as_slave() const;
  void load_slave_shift();
  void forget_slave_bits();

  Chip chip_;
  int irq_;
  bool on_apb2_;
  SpiPins pins_;
  io::SpiBus bus_;
  DmaRequest tx_request_, rx_request_;
  io::Event frame_end_;
  std::uint32_t cr1_ = 0, cr2_ = 0, sr_ = 2, crcpr_ = 7, rxcrc_ = 0, txcrc_ = 0;
  std::uint32_t i2scfgr_ = 0, i2spr_ = 2;
  std::uint16_t tx_buffer_ = 0, rx_buffer_ = 0, shift_ = 0;
  bool tx_full_ = false, shifting_ = false, crc_frame_ = false, frame_is_crc_ = false;
  bool ovr_dr_read_ = false, modf_sr_read_ = false;
  Nanoseconds written_ns_ = 0;  // DR, last
  int slave_bits_ = 0;          // clocks since the shift register was loaded
  bool slave_loaded_ = false, slave_shifting_ = false;
  bool slave_first_ = false;  // no byte has begun since NSS fell
  io::SpiSlack slack_;
  std::uint8_t slave_in_ = 0;  // bits sampled so far
  Nanoseconds frame_ns_ = 0;
  std::uint32_t sck_Hz_ = 0;
  std::uint32_t reported_ = 0;
};

}  // namespace whirl::stm32
