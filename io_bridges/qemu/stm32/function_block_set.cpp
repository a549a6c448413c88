#include "io_bridges/qemu/stm32/function_block_set.hpp"

#include "io_bridges/qemu/stm32/watchdog.hpp"

namespace whirl::stm32 {

namespace {

Chip with_interrupts(const Chip& chip, InterruptLines& lines) {
  return {chip.events, lines, chip.bus, chip.clocks, chip.finding};
}

}  // namespace

FunctionBlockSet::FunctionBlockSet(const Chip& chip, const FunctionBlockHost& host)
    : ored_(chip.interrupts), chip_(with_interrupts(chip, ored_)), host_(host) {}

Timer& FunctionBlockSet::add_timer(const TimerConfig& config, std::uint32_t base) {
  auto& timer = *(timers_[config.number] = std::make_unique<Timer>(chip_, config));
  map(base, 0x400, timer);
  const std::string name = timer.name();
  for (int ch = 1; ch <= timer.channels(); ++ch) {
    add_signal(timer.pin(ch));
    if (timer.is_advanced() && ch < 4) add_signal(timer.pin_n(ch));
    add_request(name + "_CH" + std::to_string(ch), timer.compare_request(ch));
  }
  if (abilities(config.kind).external) add_signal(timer.etr());
  if (timer.is_advanced()) add_signal(timer.break_in());
  add_request(name + "_UP", timer.update_request());
  add_request(name + "_COM", timer.com_request());
  add_request(name + "_TRIG", timer.trigger_request());
  return timer;
}

void FunctionBlockSet::join_timers(int slave, std::initializer_list<int> masters) {
  int n = 0;
  for (const int master : masters) {
    if (master != 0) timer(slave)->connect_itr(n, timer(master)->trgo());
    ++n;
  }
}

void FunctionBlockSet::map(std::uint32_t base, std::uint32_t size, Peripheral& block) {
  regions_.push_back({base, size, &block});
  resettable_.push_back(&block);
}

void FunctionBlockSet::add_block(std::uint32_t base, std::uint32_t size,
                                 std::unique_ptr<Peripheral> block) {
  map(base, size, *block);
  blocks_.push_back(std::move(block));
}

void FunctionBlockSet::add_adc_requests(AdcBank& bank) {
  for (int n = 1; n <= bank.converters(); ++n) {
    add_request("ADC" + std::to_string(n), bank.converter(n).request());
  }
}

BxCan& FunctionBlockSet::add_can(const CanConfig& config, std::uint32_t base, CanFilters& filters) {
  BxCan& can = *(cans_[config.number] = std::make_unique<BxCan>(chip_, config, filters));
  map(base, 0x400, can);
  add_signal(can.rx());
  add_signal(can.tx());
  return can;
}

BxCan* FunctionBlockSet::can(int number) {
  const auto found = cans_.find(number);
  return found == cans_.end() ? nullptr : found->second.get();
}

void FunctionBlockSet::add_watchdogs(int window_irq) {
  add_block(
      0x40003000, 0x400,
      std::make_unique<IndependentWatchdog>(chip_, asks_reset(ResetCause::independent_watchdog)));
  add_block(
      0x40002C00, 0x400,
      std::make_unique<WindowWatchdog>(chip_, window_irq, asks_reset(ResetCause::window_watchdog)));
}

std::function<void()> FunctionBlockSet::asks_reset(ResetCause cause) const {
  return [request = host_.request_reset, cause] {
    if (request) request(cause);
  };
}

Signal* FunctionBlockSet::signal(std::string_view name) {
  const auto found = signals_.find(name);
  return found == signals_.end() ? nullptr : found->second;
}

DmaRequest* FunctionBlockSet::dma_request(std::string_view name) {
  const auto found = requests_.find(name);
  return found == requests_.end() ? nullptr : found->second;
}

Timer* FunctionBlockSet::timer(int number) {
  const auto found = timers_.find(number);
  return found == timers_.end() ? nullptr : found->second.get();
}

void FunctionBlockSet::exti_edge(int line, Nanoseconds now) {
  if (line == 9) exti9_.pulse(now);
  if (line == 11) exti11_.pulse(now);
  if (line == 15) exti15_.pulse(now);
}

void FunctionBlockSet::reset(ResetCause cause) {
  for (Peripheral* block : resettable_) block->reset();
  if (cause == ResetCause::power_on) reset_backup_domain();
}

}  // namespace whirl::stm32
