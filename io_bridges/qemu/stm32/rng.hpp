// The random number generator: a word every 40 periods of the 48 MHz clock, from a counter-based
// stream of the run's seed, so that the same seed gives the same words.
//
//   Source   RM0090 ch. 24
//   Left out seed and clock errors (CECS, SECS): they never occur
#pragma once
#include <cstdint>

#include "base/random.hpp"
#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"

namespace whirl::stm32 {

class Rng : public Peripheral {
 public:
  Rng(const Chip& chip, int irq, std::uint64_t seed);
  const char* name() const override { return "RNG"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

 private:
  std::uint32_t next();
  void update();

  RandomStream stream_;
  io::Event ready_event_;
  IrqLine irq_;
  std::uint32_t cr_ = 0, word_ = 0;
  bool ready_ = false;
};

}  // namespace whirl::stm32
