// The function blocks of STM32F405 at their places (RM0090 table 1, ITR and trigger tables).
#include "io_bridges/qemu/stm32/crc.hpp"
#include "io_bridges/qemu/stm32/dac.hpp"
#include "io_bridges/qemu/stm32/dwt.hpp"
#include "io_bridges/qemu/stm32/function_block_set.hpp"
#include "io_bridges/qemu/stm32/probe_stub.hpp"
#include "io_bridges/qemu/stm32/rng.hpp"
#include "io_bridges/qemu/stm32/rtc.hpp"

namespace whirl::stm32 {

namespace {

constexpr int kAdcIrq = 18, kRngIrq = 80, kWwdgIrq = 0, kTim6DacIrq = 54;

// clang-format off
struct TimerPlace {
  int number; TimerKind kind; bool on_apb2; std::uint32_t base; int update, compare, trigger, brk;
};
constexpr TimerPlace kTimers[] = {
    {1, TimerKind::advanced, true, 0x40010000, 25, 27, 26, 24},
    {2, TimerKind::general_32, false, 0x40000000, 28, -1, -1, -1},
    {3, TimerKind::general_16, false, 0x40000400, 29, -1, -1, -1},
    {4, TimerKind::general_16, false, 0x40000800, 30, -1, -1, -1},
    {5, TimerKind::general_32, false, 0x40000C00, 50, -1, -1, -1},
    {6, TimerKind::basic, false, 0x40001000, 54, -1, -1, -1},
    {7, TimerKind::basic, false, 0x40001400, 55, -1, -1, -1},
    {8, TimerKind::advanced, true, 0x40010400, 44, 46, 45, 43},
    {9, TimerKind::two_channel, true, 0x40014000, 24, -1, -1, -1},
    {10, TimerKind::one_channel, true, 0x40014400, 25, -1, -1, -1},
    {11, TimerKind::one_channel, true, 0x40014800, 26, -1, -1, -1},
    {12, TimerKind::two_channel, false, 0x40001800, 43, -1, -1, -1},
    {13, TimerKind::one_channel, false, 0x40001C00, 44, -1, -1, -1},
    {14, TimerKind::one_channel, false, 0x40002000, 45, -1, -1, -1},
};
// clang-format on

class F405FunctionBlocks : public FunctionBlockSet {
 public:
  F405FunctionBlocks(const Chip& chip, const FunctionBlockHost& host)
      : FunctionBlockSet(chip, host),
        adc_(chip_, adc_config(host)),
        adc_block_(adc_),
        dwt_(chip_),
        debug_core_(dwt_),
        dac_(chip_, kTim6DacIrq),
        rtc_(chip_, rtc_host(host)) {
    add_timers();
    map(0x40012000, 0x400, adc_block_);
    add_adc_requests(adc_);
    join_adc();
    map(0xE0001000, 0x1000, dwt_);
    map(0xE000EDF0, 0x10, debug_core_);
    add_block(0x40023000, 0x400, std::make_unique<Crc>());
    add_block(0x50060800, 0x400, std::make_unique<Rng>(chip_, kRngIrq, host.seed));
    map(0x40002800, 0x400, rtc_);
    map(0x40007400, 0x400, dac_);
    add_watchdogs(kWwdgIrq);
    add_can({1, 19, 20, 21, 22}, 0x40006400, can_filters_);
    add_can({2, 63, 64, 65, 66}, 0x40006800, can_filters_);
    join_dac();
    add_stubs();
  }

  Adc* converter(int number) override { return adc_.find(number); }
  void reset_backup_domain() override { rtc_.reset_backup_domain(); }
  void backup_clock_changed() override { rtc_.clock_changed(); }
  double dac_volts(int channel) override { return dac_.volts(channel); }
  bool on_dac(int channel, std::function<void(double)> told) override {
    if (channel != 1 && channel != 2) return false;
    dac_.on_change(channel, std::move(told));
    return true;
  }

 private:
  static AdcConfig adc_config(const FunctionBlockHost& host) {
    AdcConfig config;
    config.irq = kAdcIrq;
    config.volts = host.adc_volts;
    return config;
  }
  static RtcHost rtc_host(const FunctionBlockHost& host) {
    return {host.rtcclk_Hz, host.backup_writable, host.exti};
  }
  void add_timers();
  void join_dac();
  void join_adc();
  void add_stubs();
  void add_stub(const char* name, std::uint32_t base, std::uint32_t size,
                std::initializer_list<StubRegister> registers) {
    add_block(base, size, std::make_unique<ProbeStub>(chip_, name, base, registers));
  }

  AdcBank adc_;
  AdcF4Block adc_block_;
  Dwt dwt_;
  DebugCore debug_core_;
  Dac dac_;
  Rtc rtc_;
  CanFilters can_filters_{28};
};

void F405FunctionBlocks::add_timers() {
  for (const TimerPlace& place : kTimers) {
    TimerConfig config;
    config.number = place.number;
    config.kind = place.kind;
    config.on_apb2 = place.on_apb2;
    config.update_irq = place.update;
    config.compare_irq = place.compare;
    config.trigger_irq = place.trigger;
    config.break_irq = place.brk;
    add_timer(config, place.base);
  }
  join_timers(1, {5, 2, 3, 4});
  join_timers(8, {1, 2, 4, 5});
  join_timers(2, {1, 8, 3, 4});
  join_timers(3, {1, 2, 5, 4});
  join_timers(4, {1, 2, 3, 8});
  join_timers(5, {2, 3, 4, 8});
  join_timers(9, {2, 3});
  timer(9)->connect_itr(2, timer(10)->compare(1));
  timer(9)->connect_itr(3, timer(11)->compare(1));
  join_timers(12, {4, 5});
  timer(12)->connect_itr(2, timer(13)->compare(1));
  timer(12)->connect_itr(3, timer(14)->compare(1));
}

// EXTSEL and JEXTSEL in their order: timer, channel (0: TRGO).
void F405FunctionBlocks::join_adc() {
  struct Source {
    int timer, channel;
  };
  constexpr Source kRegular[15] = {{1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {2, 4}, {2, 0}, {3, 1},
                                   {3, 0}, {4, 4}, {5, 1}, {5, 2}, {5, 3}, {8, 1}, {8, 0}};
  constexpr Source kInjected[15] = {{1, 4}, {1, 0}, {2, 1}, {2, 0}, {3, 2}, {3, 4}, {4, 1}, {4, 2},
                                    {4, 3}, {4, 0}, {5, 4}, {5, 0}, {8, 2}, {8, 3}, {8, 4}};
  const auto line = [this](const Source& source) -> TriggerLine& {
    Timer& from = *timer(source.timer);
    return source.channel == 0 ? from.trgo() : from.compare(source.channel);
  };
  for (unsigned i = 0; i < 15; ++i) {
    adc_.connect_regular(i, line(kRegular[i]));
    adc_.connect_injected(i, line(kInjected[i]));
  }
  adc_.connect_regular(15, exti11_);
  adc_.connect_injected(15, exti15_);
}

void F405FunctionBlocks::join_dac() {
  unsigned selection = 0;
  for (const int master : {6, 8, 7, 5, 2, 4})
    dac_.connect_trigger(selection++, timer(master)->trgo());
  dac_.connect_trigger(selection, exti9_);
  add_request("DAC1", dac_.request(1));
  add_request("DAC2", dac_.request(2));
}

// Reset values and self-clearing request bits of what a driver may probe.
void F405FunctionBlocks::add_stubs() {
  // USB OTG cores: AHB idle, core reset and FIFO flushes done at once, device mode, core id.
  const std::initializer_list<StubRegister> otg = {{0x000, 0x00000800},
                                                   {0x008, 0x00000000},
                                                   {0x00C, 0x00000A00},
                                                   {0x010, 0x80000000, 0x000007C0, 0x00000037},
                                                   {0x014, 0x04000020, 0},
                                                   {0x018, 0},
                                                   {0x024, 0x00000200},
                                                   {0x028, 0x02000200},
                                                   {0x038, 0},
                                                   {0x03C, 0x00001100},
                                                   {0x100, 0x02000600},
                                                   {0x400, 0},
                                                   {0x440, 0},
                                                   {0x800, 0x02200000},
                                                   {0x804, 0},
                                                   {0x808, 0x00000010, 0},
                                                   {0x810, 0},
                                                   {0x814, 0},
                                                   {0x818, 0, 0},
                                                   {0x81C, 0},
                                                   {0xE00, 0}};
  add_stub("OTG_FS", 0x50000000, 0x1000, otg);
  add_stub("OTG_HS", 0x40040000, 0x1000, otg);
  // SDIO: every command runs into its time-out flag, which is there already.
  add_stub("SDIO", 0x40012C00, 0x400,
           {{0x00, 0},
            {0x04, 0},
            {0x08, 0},
            {0x0C, 0},
            {0x10, 0, 0},
            {0x14, 0, 0},
            {0x24, 0},
            {0x28, 0},
            {0x2C, 0},
            {0x30, 0, 0},
            {0x34, 0x00000004, 0},
            {0x38, 0},
            {0x3C, 0}});
  // Ethernet: the DMA's software reset and the MII's busy bit fall back; no PHY answers.
  add_stub("ETH", 0x40028000, 0x1400,
           {{0x0000, 0x00008000},
            {0x0004, 0},
            {0x0010, 0, 0xFFFFFFFF, 1},
            {0x0014, 0x0000FFFF, 0},
            {0x0018, 0},
            {0x0040, 0x0010FFFF},
            {0x0044, 0xFFFFFFFF},
            {0x1000, 0x00020100, 0xFFFFFFFF, 1},
            {0x100C, 0},
            {0x1010, 0},
            {0x1014, 0, 0},
            {0x1018, 0},
            {0x101C, 0}});
  add_stub("FSMC", 0xA0000000, 0x1000,
           {{0x00, 0x000030DB},  {0x04, 0x0FFFFFFF},  {0x08, 0x000030D2},  {0x0C, 0x0FFFFFFF},
            {0x10, 0x000030D2},  {0x14, 0x0FFFFFFF},  {0x18, 0x000030D2},  {0x1C, 0x0FFFFFFF},
            {0x60, 0x00000018},  {0x64, 0x00000040},  {0x68, 0xFCFCFCFC},  {0x6C, 0xFCFCFCFC},
            {0x80, 0x00000018},  {0x84, 0x00000040},  {0x88, 0xFCFCFCFC},  {0x8C, 0xFCFCFCFC},
            {0xA0, 0x00000018},  {0xA4, 0x00000040},  {0xA8, 0xFCFCFCFC},  {0xAC, 0xFCFCFCFC},
            {0x104, 0x0FFFFFFF}, {0x10C, 0x0FFFFFFF}, {0x114, 0x0FFFFFFF}, {0x11C, 0x0FFFFFFF}});
  add_stub("DCMI", 0x50050000, 0x400,
           {{0x00, 0}, {0x04, 0, 0}, {0x08, 0, 0}, {0x0C, 0}, {0x10, 0, 0}, {0x18, 0}, {0x1C, 0}});
  const std::initializer_list<StubRegister> i2s_ext = {
      {0x00, 0}, {0x04, 0}, {0x08, 2, 0}, {0x0C, 0}, {0x10, 7}, {0x1C, 0}, {0x20, 2}};
  add_stub("I2S2ext", 0x40003400, 0x400, i2s_ext);
  add_stub("I2S3ext", 0x40004000, 0x400, i2s_ext);
}

}  // namespace

std::unique_ptr<FunctionBlocks> make_f405_function_blocks(const Chip& chip,
                                                          const FunctionBlockHost& host) {
  return std::make_unique<F405FunctionBlocks>(chip, host);
}

}  // namespace whirl::stm32
