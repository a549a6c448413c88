// DMA1, DMA2 of the STM32F405: eight streams, each with eight request channels.
//
//   Source    RM0090 chapter 10
//   Timing    a request is served at its instant, by software priority (PL), then by the lower
//             stream number; a run of requests at 8 HCLK cycles per item, in bursts of 16
//   FIFO      threshold, packing and unpacking (PSIZE != MSIZE), flush at the end or on disable;
//             bursts are moved item by item
//   Findings  EN set with flags of the last transfer still up, PFCTRL, memory-to-memory on DMA1
//   Left out  PFCTRL (SDIO only), double buffer address errors, AHB contention
#pragma once
#include <array>

#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class Dma final : public WordBlock {
 public:
  static constexpr int kStreams = 8;

  Dma(std::string name, Chip chip, const std::array<int, kStreams>& irqs, bool memory_to_memory);

  void connect(int stream, int channel, DmaRequest& request);  // up to three share a channel
  void reset() override;

 private:
  struct Stream {
    std::uint32_t cr = 0, ndtr = 0, par = 0, m0ar = 0, m1ar = 0, fcr = 0x21;
    std::uint32_t flags = 0;  // FEIF 0, DMEIF 2, TEIF 3, HTIF 4, TCIF 5, as in LISR
    std::array<std::array<DmaRequest*, 3>, 8> requests{};  // of a channel: OR-ed
    // of the transfer that runs
    std::uint32_t reload = 0;  // NDTR as programmed
    std::uint32_t peripheral = 0, memory = 0;
    std::uint32_t memory_left = 0;  // bytes still to be moved on the memory side
    std::array<std::uint8_t, 16> fifo{};
    unsigned fifo_used = 0;
  };

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_cr(int n, std::uint32_t value);
  void enable(int n);
  void disable_by_software(int n);
  void stop(int n);
  void arm(int n);
  static bool requested(const Stream& s);
  void wake(bool after_burst);
  void service();
  bool serve_burst();
  int pick() const;
  void move(int n);
  void move_peripheral_to_memory(int n);
  void move_memory_to_peripheral(int n);
  void move_memory_to_memory(int n);
  bool fill_fifo(Stream& s, unsigned up_to);
  bool drain_fifo(Stream& s, bool all);
  bool transfer_in(Stream& s, std::uint32_t& address, unsigned size, bool increment);
  void item_done(int n);
  void block_done(int n);
  void start_block(Stream& s);
  void fail(int n);
  void raise(int n, std::uint32_t flags);
  void update_irq(int n);
  void report_once(std::uint32_t bit, const std::string& what);

  Chip chip_;
  std::array<int, kStreams> irqs_;
  bool memory_to_memory_;
  std::array<Stream, kStreams> streams_;
  std::uint32_t ready_ = 0;  // streams that are enabled and requested
  io::Event service_;
  bool serving_ = false;
  std::uint32_t reported_ = 0;
};

}  // namespace whirl::stm32
