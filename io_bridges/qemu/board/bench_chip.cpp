#include "io_bridges/qemu/board/bench_chip.hpp"

#include <cstdlib>
#include <new>
#include <stdexcept>

#include "base/check.hpp"
#include "base/digest.hpp"
#include "base/text.hpp"

namespace whirl::board {
namespace {

constexpr int kIrq = 31;
constexpr double kClock_Hz = 168e6;

class FixedClocks final : public stm32::Clocks {
 public:
  double hclk_Hz() const override { return kClock_Hz; }
  double pclk1_Hz() const override { return kClock_Hz; }
  double pclk2_Hz() const override { return kClock_Hz; }
  double timclk1_Hz() const override { return kClock_Hz; }
  double timclk2_Hz() const override { return kClock_Hz; }
  double lsi_Hz() const override { return 32e3; }
  double lse_Hz() const override { return 0.0; }
  double hse_Hz() const override { return 0.0; }
  void on_change(std::function<void()>) override {}
};

class BenchBlock final : public stm32::Peripheral {
 public:
  explicit BenchBlock(const stm32::ChipHost& host)
      : host_(host), timer_(host.events, [this] { fire(); }) {}

  const char* name() const override { return "BENCH"; }
  void reset() override {
    timer_.cancel();
    every_ns_ = 0;
    flash_open_ = false;
    host_.interrupts.set(kIrq, false);
  }
  void was_reset(stm32::ResetCause cause) {
    cause_ = cause;
    reset();
  }
  void on_reset_request(std::function<void(stm32::ResetCause)> request) {
    request_ = std::move(request);
  }
  bool store(std::uint32_t address, unsigned size, std::uint32_t value) {
    if (flash_open_) host_.flash.program(address, value, size);
    return flash_open_;
  }

  std::uint32_t read(std::uint32_t offset, unsigned /*size*/) override {
    const auto now = static_cast<std::uint64_t>(host_.events.now());
    switch (offset) {
      case 0x00:
        return static_cast<std::uint32_t>(now);
      case 0x04:
        return static_cast<std::uint32_t>(now >> 32);
      case 0x14:
        return static_cast<std::uint32_t>(digest_.value());
      case 0x20:
        return flash_open_ ? 1 : 0;
      case 0x28:
        return static_cast<std::uint32_t>(cause_);
      case 0x2C:
        return ticks_;
      default:
        return 0;
    }
  }

  void write(std::uint32_t offset, std::uint32_t value, unsigned /*size*/) override {
    switch (offset) {
      case 0x08:
        return value != 0 ? timer_.in(value) : timer_.cancel();
      case 0x0C:
        every_ns_ = value;
        return timer_.in(value);
      case 0x10:
        return host_.interrupts.set(kIrq, false);
      case 0x14:
        digest_.add(value);
        return digest_.add(host_.events.now());
      case 0x18:
        return say(value);
      case 0x1C:
        return request_ ? request_(static_cast<stm32::ResetCause>(value)) : void();
      case 0x20:
        flash_open_ = (value & 1u) != 0;
        return;
      case 0x24:
        return host_.flash.erase(value, 16 * 1024);
      case 0x30:
        return go_wrong(value);
      default:
        return;
    }
  }

 private:
  void say(std::uint32_t value) {
    host_.finding({host_.events.now(), "BENCH", "says " + hex(value)});
  }
  void go_wrong(std::uint32_t how) {
    WHIRL_CHECK(how != 1, how);
    if (how == 2) throw std::bad_alloc();
    if (how == 3) std::abort();
    if (how == 4) throw std::runtime_error("thrown on purpose");
    for_ever_ = how == 5;
    timer_.in(0);
  }
  void fire() {
    if (for_ever_) return timer_.in(0);
    ++ticks_;
    host_.interrupts.set(kIrq, true);
    if (every_ns_ != 0) timer_.in(every_ns_);
  }

  stm32::ChipHost host_;
  io::Event timer_;
  std::function<void(stm32::ResetCause)> request_;
  io::Nanoseconds every_ns_ = 0;
  std::uint32_t ticks_ = 0;
  bool flash_open_ = false, for_ever_ = false;
  stm32::ResetCause cause_ = stm32::ResetCause::power_on;
  Digest digest_;
};

class BenchChip final : public stm32::ChipModel {
 public:
  explicit BenchChip(const stm32::ChipHost& host)
      : block_(host), regions_{{0x40000000, 0x400, &block_}} {}
  cycles::FlashTiming flash_timing() const override { return {}; }  // no wait states, ever
  void on_flash_timing_change(std::function<void()>) override {}

  const std::vector<stm32::Region>& regions() const override { return regions_; }
  void reset(stm32::ResetCause cause) override { block_.was_reset(cause); }
  void on_reset_request(std::function<void(stm32::ResetCause)> request) override {
    block_.on_reset_request(std::move(request));
  }
  bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) override {
    return block_.store(address, size, value);
  }
  io::Wire* pin(std::string_view) override { return nullptr; }
  io::I2cBus* i2c(int) override { return nullptr; }
  io::SpiBus* spi(int) override { return nullptr; }
  bool join_uart(int, io::UartPeer&) override { return false; }
  bool set_analog(std::string_view, std::function<double(stm32::Nanoseconds)>) override {
    return false;
  }
  const stm32::Clocks& clocks() const override { return clocks_; }
  void on_clock_change(std::function<void()>) override {}  // they never do
  double sysclk_Hz() const override { return kClock_Hz; }

 private:
  FixedClocks clocks_;
  BenchBlock block_;
  std::vector<stm32::Region> regions_;
};

}  // namespace

std::unique_ptr<stm32::ChipModel> make_bench_chip(const stm32::ChipHost& host) {
  return std::make_unique<BenchChip>(host);
}

}  // namespace whirl::board
