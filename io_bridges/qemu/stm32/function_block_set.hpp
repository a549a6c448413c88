// What the function blocks of both parts have in common: the register of timers, signals, requests
// and regions. f405_function_blocks.cpp and f103_function_blocks.cpp fill it.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/stm32/adc.hpp"
#include "io_bridges/qemu/stm32/bxcan.hpp"
#include "io_bridges/qemu/stm32/function_blocks.hpp"
#include "io_bridges/qemu/stm32/irq_line.hpp"
#include "io_bridges/qemu/stm32/timer.hpp"
#include "io_bridges/qemu/stm32/trigger_line.hpp"

namespace whirl::stm32 {

class FunctionBlockSet : public FunctionBlocks {
 public:
  FunctionBlockSet(const Chip& chip, const FunctionBlockHost& host);

  const std::vector<Region>& regions() const override { return regions_; }
  Signal* signal(std::string_view name) override;
  DmaRequest* dma_request(std::string_view name) override;
  Timer* timer(int number) override;
  BxCan* can(int number) override;
  void exti_edge(int line, Nanoseconds now) override;
  void reset(ResetCause cause) override;
  double dac_volts(int /*channel*/) override { return 0.0; }
  bool on_dac(int /*channel*/, std::function<void(double)> /*told*/) override { return false; }

 protected:
  Timer& add_timer(const TimerConfig& config, std::uint32_t base);
  // Masters of ITR0..3; 0: not connected.
  void join_timers(int slave, std::initializer_list<int> masters);
  void add_block(std::uint32_t base, std::uint32_t size, std::unique_ptr<Peripheral> block);
  void map(std::uint32_t base, std::uint32_t size, Peripheral& block);
  void add_signal(Signal& signal) { signals_[signal.name()] = &signal; }
  void add_request(const std::string& name, DmaRequest& request) { requests_[name] = &request; }
  void add_adc_requests(AdcBank& bank);
  BxCan& add_can(const CanConfig& config, std::uint32_t base, CanFilters& filters);
  void add_watchdogs(int window_irq);
  std::function<void()> asks_reset(ResetCause cause) const;

  OredInterrupts ored_;
  Chip chip_;  // with ored_ in place of the NVIC
  FunctionBlockHost host_;
  TriggerLine exti9_, exti11_, exti15_;

 private:
  std::map<int, std::unique_ptr<Timer>> timers_;
  std::map<int, std::unique_ptr<BxCan>> cans_;
  std::vector<std::unique_ptr<Peripheral>> blocks_;
  std::vector<Peripheral*> resettable_;
  std::vector<Region> regions_;
  std::map<std::string, Signal*, std::less<>> signals_;
  std::map<std::string, DmaRequest*, std::less<>> requests_;
};

}  // namespace whirl::stm32
