// The function blocks of STM32F103 of medium density at their places (RM0008 table 3).
#include "io_bridges/qemu/stm32/crc.hpp"
#include "io_bridges/qemu/stm32/dwt.hpp"
#include "io_bridges/qemu/stm32/function_block_set.hpp"
#include "io_bridges/qemu/stm32/probe_stub.hpp"
#include "io_bridges/qemu/stm32/rtc_f1.hpp"

namespace whirl::stm32 {

namespace {

constexpr int kWwdgIrq = 0, kRtcIrq = 3, kAdcIrq = 18;

class F103FunctionBlocks : public FunctionBlockSet {
 public:
  F103FunctionBlocks(const Chip& chip, const FunctionBlockHost& host)
      : FunctionBlockSet(chip, host),
        adc_(chip_, adc_config(host)),
        dwt_(chip_),
        debug_core_(dwt_),
        rtc_(chip_, kRtcIrq, host.rtcclk_Hz, host.backup_writable, host.exti),
        backup_(host.backup_writable) {
    add_timers();
    map(0x40012400, 0x400, adc_.converter(1));
    map(0x40012800, 0x400, adc_.converter(2));
    add_request("ADC1", adc_.converter(1).request());  // ADC2 has none
    join_adc();
    map(0xE0001000, 0x1000, dwt_);
    map(0xE000EDF0, 0x10, debug_core_);
    add_block(0x40023000, 0x400, std::make_unique<Crc>());
    map(0x40002800, 0x400, rtc_);
    map(0x40006C00, 0x400, backup_);
    add_watchdogs(kWwdgIrq);
    add_can({1, 19, 20, 21, 22}, 0x40006400, can_filters_);
    add_usb();
  }

  Adc* converter(int number) override { return adc_.find(number); }
  void reset_backup_domain() override {
    rtc_.reset_backup_domain();
    backup_.reset_backup_domain();
  }
  void backup_clock_changed() override { rtc_.clock_changed(); }
  void reset(ResetCause cause) override {
    FunctionBlockSet::reset(cause);
    adc_.update_clock();
  }

 private:
  static AdcConfig adc_config(const FunctionBlockHost& host) {
    AdcConfig config;
    config.family = AdcFamily::f1;
    config.converters = 2;
    config.irq = kAdcIrq;
    config.adcclk_Hz = host.adcclk_Hz;
    config.volts = host.adc_volts;
    return config;
  }
  void add_timers();
  void join_adc();
  void add_usb();

  AdcBank adc_;
  Dwt dwt_;
  DebugCore debug_core_;
  RtcF1 rtc_;
  BackupRegisters backup_;
  CanFilters can_filters_{14};
};

void F103FunctionBlocks::add_timers() {
  TimerConfig one;
  one.number = 1;
  one.kind = TimerKind::advanced;
  one.on_apb2 = true;
  one.update_irq = 25;
  one.compare_irq = 27;
  one.trigger_irq = 26;
  one.break_irq = 24;
  one.both_edges = false;
  add_timer(one, 0x40012C00);
  for (int number = 2; number <= 4; ++number) {
    TimerConfig config;
    config.number = number;
    config.update_irq = 26 + number;
    config.both_edges = false;
    add_timer(config, 0x40000000u + 0x400u * static_cast<unsigned>(number - 2));
  }
  join_timers(1, {0, 2, 3, 4});
  join_timers(2, {1, 0, 3, 4});
  join_timers(3, {1, 2, 0, 4});
  join_timers(4, {1, 2, 3, 0});
}

// EXTSEL and JEXTSEL in their order (RM0008 tables 66, 67).
void F103FunctionBlocks::join_adc() {
  adc_.connect_regular(0, timer(1)->compare(1));
  adc_.connect_regular(1, timer(1)->compare(2));
  adc_.connect_regular(2, timer(1)->compare(3));
  adc_.connect_regular(3, timer(2)->compare(2));
  adc_.connect_regular(4, timer(3)->trgo());
  adc_.connect_regular(5, timer(4)->compare(4));
  adc_.connect_regular(6, exti11_);
  adc_.connect_injected(0, timer(1)->trgo());
  adc_.connect_injected(1, timer(1)->compare(4));
  adc_.connect_injected(2, timer(2)->trgo());
  adc_.connect_injected(3, timer(2)->compare(1));
  adc_.connect_injected(4, timer(3)->compare(4));
  adc_.connect_injected(5, timer(4)->trgo());
  adc_.connect_injected(6, exti15_);
}

// USB full speed: powered down and in reset, nobody on the bus.
void F103FunctionBlocks::add_usb() {
  const std::initializer_list<StubRegister> usb = {
      {0x40, 0x3, 0xFF1F}, {0x44, 0, 0}, {0x48, 0, 0}, {0x4C, 0, 0xFF}, {0x50, 0, 0xFFF8}};
  add_block(0x40005C00, 0x400, std::make_unique<ProbeStub>(chip_, "USB", 0x40005C00, usb));
}

}  // namespace

std::unique_ptr<FunctionBlocks> make_f103_function_blocks(const Chip& chip,
                                                          const FunctionBlockHost& host) {
  return std::make_unique<F103FunctionBlocks>(chip, host);
}

}  // namespace whirl::stm32
