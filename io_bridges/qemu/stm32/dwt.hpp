// The cycle counter and the switch that lets it run.
//
//   DWT        at 0xE0001000: CTRL.CYCCNTENA and CYCCNT, counting HCLK in virtual time
//   DebugCore  at 0xE000EDF0: DHCSR (no debugger), DEMCR.TRCENA
//   Left out   comparators, the other counters, ITM; CTRL.NUMCOMP reads 4 as on the part
#pragma once
#include <cstdint>

#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/tick_grid.hpp"

namespace whirl::stm32 {

class Dwt : public Peripheral {
 public:
  explicit Dwt(const Chip& chip);
  const char* name() const override { return "DWT"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;
  void set_trace_enabled(bool enabled);

 private:
  void sync();
  bool counting() const { return trace_enabled_ && (ctrl_ & 1) != 0; }

  Chip chip_;
  TickGrid grid_;
  std::uint32_t ctrl_ = 0x40000000, cycles_ = 0;
  std::int64_t synced_ = 0;
  bool trace_enabled_ = false;
};

class DebugCore : public Peripheral {
 public:
  explicit DebugCore(Dwt& dwt) : dwt_(dwt) {}
  const char* name() const override { return "DCB"; }
  std::uint32_t read(std::uint32_t offset, unsigned size) override;
  void write(std::uint32_t offset, std::uint32_t value, unsigned size) override;
  void reset() override;

 private:
  Dwt& dwt_;
  std::uint32_t demcr_ = 0;
};

}  // namespace whirl::stm32
