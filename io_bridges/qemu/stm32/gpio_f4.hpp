// A GPIO port of the STM32F405 (A to I): modes, pulls, alternate functions, lock.
//
//   Source    RM0090 chapter 8
//   Pins      wires by name in the PinBank ("PB0"); IDR is their level, 0 in analog mode
//   Left out  output speed is stored and has no effect
#pragma once
#include <array>

#include "io_bridges/qemu/stm32/gpio_lock.hpp"
#include "io_bridges/qemu/stm32/pins.hpp"
#include "io_bridges/qemu/stm32/word_block.hpp"

namespace whirl::stm32 {

class GpioF4 final : public WordBlock {
 public:
  using EdgeSink = std::function<void(int pin, bool level, Nanoseconds now)>;

  GpioF4(Chip chip, PinBank& bank, char port);

  void add_alternate(int pin, int af, Signal& signal);
  void on_edge(EdgeSink sink) { edge_ = std::move(sink); }  // EXTI
  bool level(int pin) const { return ((levels_ >> pin) & 1) != 0; }

  void reset() override;

 private:
  std::uint32_t read_word(std::uint32_t offset) override;
  void write_word(std::uint32_t offset, std::uint32_t value) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void set_odr(std::uint32_t value);
  void set_configuration(std::uint32_t& reg, std::uint32_t value, int bits_per_pin, int first);
  void apply(int pin);
  PinSetting setting(int pin) const;

  Chip chip_;
  PinBank& bank_;
  char port_;
  std::array<Pin*, 16> pins_{};
  std::array<std::array<std::array<Signal*, 2>, 16>, 16> alternates_{};  // [pin][af]
  EdgeSink edge_;
  std::uint32_t moder_ = 0, otyper_ = 0, ospeedr_ = 0, pupdr_ = 0, odr_ = 0;
  std::uint32_t afr_[2] = {0, 0};
  std::uint32_t levels_ = 0xFFFF;  // what the wires carry
  std::uint32_t analog_ = 0;       // pins whose Schmitt trigger is off
  GpioLock lock_;
};

}  // namespace whirl::stm32
