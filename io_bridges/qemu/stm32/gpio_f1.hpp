// GPIO ports and AFIO of the STM32F103: CRL/CRH, remaps, EXTI ports.
//
//   Source    RM0008 chapter 9
//   Routing   a peripheral's pins are those that MAPR's remap field selects. Its outputs reach them
//             in alternate mode; inputs (RX, MISO, captures) hear them in any digital mode
//   Findings  an output on a JTAG pin (PA13-15, PB3, PB4) that SWJ_CFG has not freed
//   Left out  output speed; event output (EVCR is stored); ADC trigger remaps (read by the ADC)
#pragma once
#include <array>
#include <vector>

#include "io_bridges/qemu/stm32/exti.hpp"
#include "io_bridges/qemu/stm32/gpio_lock.hpp"
#include "io_bridges/qemu/stm32/pins.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

// The pin carries the signal while (MAPR >> shift & mask) is one of `values` (bit n: value n).
struct RemapRow {
  char port;
  std::uint8_t pin;
  const char* signal;
  bool input;  // heard in input mode as well
  std::uint8_t shift, mask, values;
};

class GpioF1 final : public WordBlock {
 public:
  using EdgeSink = std::function<void(int pin, bool level, Nanoseconds now)>;

  GpioF1(Chip chip, PinBank& bank, char port);

  void on_edge(EdgeSink sink) { edge_ = std::move(sink); }
  bool level(int pin) const { return ((levels_ >> pin) & 1) != 0; }
  // From AFIO.
  void add_signal(int pin, const RemapRow& row, Signal& signal);
  void remap(std::uint32_t mapr);

  void reset() override;

 private:
  struct Carried {
    const RemapRow* row;
    Signal* signal;
  };

  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void set_odr(std::uint32_t value);
  void set_configuration(int first, std::uint32_t value);
  void apply(int pin);
  void check_jtag(int pin, PinMode mode);
  PinSetting setting(int pin) const;

  Chip chip_;
  PinBank& bank_;
  char port_;
  std::array<Pin*, 16> pins_{};
  std::array<std::vector<Carried>, 16> signals_;
  EdgeSink edge_;
  std::uint32_t cr_[2] = {0x44444444, 0x44444444};
  std::uint32_t odr_ = 0, mapr_ = 0;
  std::uint32_t levels_ = 0xFFFF, analog_ = 0;
  GpioLock lock_;
  bool jtag_reported_ = false;
};

class Afio final : public WordBlock {
 public:
  Afio(Exti& exti, ExtiPorts::Level level) : WordBlock("AFIO"), ports_(exti, std::move(level)) {}
  void on_remap(std::function<void(std::uint32_t mapr)> remap) { remap_ = std::move(remap); }
  std::uint32_t mapr() const { return mapr_; }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;

  ExtiPorts ports_;
  std::function<void(std::uint32_t)> remap_;
  std::uint32_t evcr_ = 0, mapr_ = 0, mapr2_ = 0;
};

}  // namespace whirl::stm32
