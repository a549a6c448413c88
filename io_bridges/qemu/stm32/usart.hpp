// USART and UART of the STM32F4 and F1: one event per character in each direction.
//
//   Source    RM0090 chapter 30 (F103: RM0008 chapter 27, without OVER8 and ONEBIT)
//   Timing    TXE when DR moves to the shift register, TC at the end of the last stop bit; TE sends
//             an idle frame first; RXNE at the end of the stop bit
//   IDLE      the far end announces a character when it has passed, so IDLE is set up to one
//             character late, and never while a character is on the line
//   Findings  sending with TX not muxed to a pin; BRR 0 while enabled; modes left out
//   Left out  smartcard, IrDA, synchronous clock: stored only; the ninth data bit stays here
#pragma once
#include "io_bridges/devices/early_uart_peer.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

struct UsartPins {
  Signal& tx;
  Signal& rx;
  Signal& cts;
  Signal& rts;
};

class Usart final : public WordBlock {
 public:
  Usart(std::string name, Chip chip, int irq, bool on_apb2, UsartPins pins);

  void join(io::UartPeer& peer);
  DmaRequest& tx_request() { return tx_request_; }
  DmaRequest& rx_request() { return rx_request_; }
  double baud() const { return baud_; }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_sr(std::uint32_t value);
  void write_dr(std::uint32_t value);
  void write_cr1(std::uint32_t value);
  std::uint32_t read_dr();

  void next_character();
  void character_sent();
  io::UartFormat format() const;
  io::UartByte on_line(std::uint16_t bits, bool is_break) const;
  void announce(Nanoseconds end);
  void send_to_peer(std::uint16_t bits, bool is_break);
  void receive(const io::UartByte& byte, const io::UartFormat& format);
  void receive(std::uint16_t bits, std::uint32_t errors);
  bool muted(std::uint16_t bits);
  void line_idle();
  void idle_passed();
  void update();
  void drive_pins();
  void settings_changed();
  int word_bits() const;  // data and parity
  Nanoseconds frame_ns() const;
  void report_once(std::uint32_t bit, const char* what);

  Chip chip_;
  int irq_;
  bool on_apb2_;
  UsartPins pins_;
  io::UartPeer* peer_ = nullptr;
  io::EarlyUartPeer* early_ = nullptr;  // the same, where it wants to know of start bits
  DmaRequest tx_request_, rx_request_;
  io::Event tx_end_, idle_;
  std::uint32_t sr_ = 0xC0, brr_ = 0, cr1_ = 0, cr2_ = 0, cr3_ = 0, gtpr_ = 0;
  std::uint16_t tdr_ = 0, rdr_ = 0, tx_shift_ = 0;
  enum class Sending : std::uint8_t { nothing, idle_frame, character, break_character };
  Sending sending_ = Sending::nothing;
  bool idle_frame_wanted_ = false;
  std::uint32_t sr_seen_ = 0;  // flags that were set when SR was last read
  double baud_ = 0.0;
  double stop_bits_ = 1.0;
  Nanoseconds last_rx_end_ = 0;
  std::uint32_t reported_ = 0;
};

}  // namespace whirl::stm32
