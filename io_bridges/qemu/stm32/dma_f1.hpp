// DMA1 of the STM32F103: seven channels, their requests OR-ed.
//
//   Source    RM0008 chapter 13
//   Timing    a request is served at its instant, by PL, then by the lower channel; a run of requests
//             at 8 HCLK cycles per item, in bursts of 16
//   Sizes     PSIZE and MSIZE may differ: the value is zero-extended or cut (table 76)
#pragma once
#include <array>
#include <vector>

#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class DmaF1 final : public WordBlock {
 public:
  static constexpr int kChannels = 7;

  DmaF1(std::string name, Chip chip, int first_irq);

  void connect(int channel, DmaRequest& request);  // 1 to 7
  void reset() override;

 private:
  struct Channel {
    std::uint32_t ccr = 0, cndtr = 0, cpar = 0, cmar = 0;
    std::uint32_t flags = 0;  // GIF TCIF HTIF TEIF, as in ISR
    std::uint32_t reload = 0, peripheral = 0, memory = 0;
    std::vector<DmaRequest*> requests;
  };

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write_ccr(Channel& channel, std::uint32_t value);
  static bool wants_service(const Channel& channel);
  void wake(bool after_burst);
  void service();
  bool serve_burst();
  Channel* pick();
  bool move(Channel& channel);
  void item_done(Channel& channel);
  void update_irq(const Channel& channel);

  Chip chip_;
  int first_irq_;
  std::array<Channel, kChannels> channels_;
  io::Event service_;
  bool serving_ = false;
};

}  // namespace whirl::stm32
