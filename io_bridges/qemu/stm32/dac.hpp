// The DAC of F405: two channels, triggers from timers and software, noise and triangle, DMA.
//
//   Volts    DOR / 4096 * VDDA, whole
//   Source   RM0090 ch. 14
//   Left out settling time, output buffer, the one to three APB1 clocks between DHR and DOR
#pragma once
#include <array>
#include <functional>

#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/trigger_line.hpp"

namespace whirl::stm32 {

class Dac : public Peripheral {
 public:
  Dac(const Chip& chip, int irq);
  const char* name() const override { return "DAC"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

  void connect_trigger(unsigned selection, TriggerLine& line);  // TSEL 0..6
  DmaRequest& request(int channel) {
    return channel_[static_cast<std::size_t>(channel - 1)].request;
  }
  double volts(int channel) const;
  // Told whenever they are other ones than before.
  void on_change(int channel, std::function<void(double volts)> told);

 private:
  struct Channel {
    std::uint32_t holding = 0, output = 0, triangle = 0, noise = 0xAAA;
    bool triangle_falls = false;
    DmaRequest request;
    std::function<void(double volts)> told;
    double told_V = 0.0;
  };
  std::uint32_t control(int ch) const { return (cr_ >> (16 * ch)) & 0x3FFF; }
  void hold(int ch, std::uint32_t value12);
  void trigger(int ch);
  void tell();
  void wave(int ch);
  void select_triggers();
  void update_interrupt();
  static std::uint32_t step_triangle(Channel& c, std::uint32_t top);

  IrqLine irq_;
  std::uint32_t cr_ = 0, sr_ = 0;
  std::array<Channel, 2> channel_;
  struct Tap {
    TriggerLine* line = nullptr;
    std::array<int, 2> handle{};
  };
  std::array<Tap, 7> taps_{};
};

}  // namespace whirl::stm32
