#include "io_bridges/qemu/stm32/fuzz/register_fuzz.hpp"

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "base/check.hpp"
#include "base/digest.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"
#include "io_bridges/qemu/stm32/stm32f103.hpp"
#include "io_bridges/qemu/stm32/stm32f405.hpp"

namespace whirl::stm32 {
namespace {

constexpr std::uint32_t kRam = 0x20000000, kRam_bytes = 20 * 1024;
constexpr std::uint32_t kFlash = 0x08000000;
constexpr int kSteps = 300;
// A timer that turns at every other clock of 168 MHz makes 84 events per microsecond, and there are
// 14; what an access sets going at once is small.
constexpr std::uint64_t kEvents_per_us = 3000, kEvents_per_access = 2000;

class Xorshift {
 public:
  explicit Xorshift(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15u + 0x1234567) {
    for (int i = 0; i < 4; ++i) next();
  }
  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::uint32_t>(state_ >> 16);
  }
  std::uint32_t below(std::uint32_t n) { return next() % n; }
  bool one_in(std::uint32_t n) { return below(n) == 0; }

 private:
  std::uint64_t state_;
};

// A chip with memories and nothing on its pins.
class Bench : InterruptLines, SystemBus, FlashArray {
 public:
  Bench(bool f405, double hse_Hz) : flash_(f405 ? 1024 * 1024 : 128 * 1024, 0xFF) {
    const auto make = f405 ? make_stm32f405 : make_stm32f103;
    chip_ = make({events_, *this, *this, *this, [](const io::Finding&) {}, hse_Hz, 32768.0});
    chip_->on_reset_request([this](ResetCause cause) { asked_ = cause; });
    chip_->reset(ResetCause::power_on);
  }

  ChipModel& chip() { return *chip_; }
  io::EventQueue& events() { return events_; }
  std::uint64_t trace() const { return trace_.value(); }

  std::uint32_t get(const Region& region, std::uint32_t offset, unsigned size) {
    const std::uint32_t value = region.block->read(offset, size);
    add(value);
    return value;
  }
  void put(const Region& region, std::uint32_t offset, std::uint32_t value, unsigned size) {
    region.block->write(offset, value, size);
  }
  void pass(Nanoseconds time_ns) {
    events_.run_until(events_.now() + time_ns);
    if (!asked_) return;
    chip_->reset(*asked_);
    asked_.reset();
  }

 private:
  void add(std::uint32_t value) { trace_.add_bytes(&value, sizeof value); }
  void set(int irq, bool level) override { add(static_cast<std::uint32_t>(2 * irq + level)); }
  std::uint8_t* cell(std::uint32_t address, unsigned size) {
    if (address - kRam <= kRam_bytes - size) return &ram_[address - kRam];
    const bool flash = address - kFlash <= flash_.size() - size;
    return flash ? &flash_[address - kFlash] : nullptr;
  }
  bool read(std::uint32_t address, unsigned size, std::uint32_t& value) override {
    value = 0;
    const std::uint8_t* from = cell(address, size);
    if (from != nullptr) std::memcpy(&value, from, size);
    return from != nullptr;
  }
  bool write(std::uint32_t address, unsigned size, std::uint32_t value) override {
    if (address - kFlash < flash_.size()) return chip_->flash_store(address, size, value);
    std::uint8_t* to = cell(address, size);
    if (to != nullptr) std::memcpy(to, &value, size);
    return to != nullptr;
  }
  void program(std::uint32_t address, std::uint64_t value, unsigned size) override {
    std::memcpy(&flash_.at(address - kFlash), &value, size);
  }
  std::uint64_t read(std::uint32_t address, unsigned size) override {
    std::uint64_t value = 0;
    std::memcpy(&value, &flash_.at(address - kFlash), size);
    return value;
  }
  void erase(std::uint32_t address, std::uint32_t bytes) override {
    WHIRL_CHECK(address - kFlash + bytes <= flash_.size(), address, bytes);
    std::memset(&flash_[address - kFlash], 0xFF, bytes);
  }

  io::EventQueue events_;
  std::array<std::uint8_t, kRam_bytes> ram_{};
  std::vector<std::uint8_t> flash_;
  std::unique_ptr<ChipModel> chip_;
  std::optional<ResetCause> asked_;
  Digest trace_;
};

class Program {
 public:
  explicit Program(std::uint64_t seed)
      : random_(seed), f405_(seed % 2 == 0), bench_(f405_, random_.one_in(8) ? 0.0 : 8e6) {}

  FuzzOutcome run() {
    choose_blocks();
    set_up();
    for (int i = 0; i < kSteps && out_.complaint.empty(); ++i) step();
    out_.trace = bench_.trace();
    out_.events = bench_.events().fired();
    return out_;
  }

 private:
  const std::vector<Region>& all() { return bench_.chip().regions(); }

  // Few blocks at a time: they are to meet each other.
  void choose_blocks() {
    const std::uint32_t count = 1 + random_.below(5);
    while (blocks_.size() < count) {
      const Region& region = any_block();
      const bool port = std::string_view(region.block->name()).substr(0, 4) == "GPIO";
      if (!port || random_.one_in(4)) blocks_.push_back(region);
    }
  }
  const Region& any_block() {
    return all()[random_.below(static_cast<std::uint32_t>(all().size()))];
  }
  const Region& block_at(std::uint32_t base) {
    for (const Region& region : all()) {
      if (region.base == base) return region;
    }
    return all().front();
  }

  void write(const Region& region, std::uint32_t offset, std::uint32_t value, unsigned size = 4) {
    bench_.put(region, offset, value, size);
    ++out_.accesses;
  }

  // All blocks clocked; often the PLL at the part's speed too.
  void set_up() {
    const Region& rcc = block_at(f405_ ? 0x40023800 : 0x40021000);
    const std::uint32_t first = f405_ ? 0x30 : 0x14, last = f405_ ? 0x44 : 0x1C;
    for (std::uint32_t at = first; at <= last; at += 4) write(rcc, at, 0xFFFFFFFF);
    if (random_.one_in(3)) return;
    write(rcc, 0, 0x00010083);
    pass(3'000'000);
    if (f405_) write(rcc, 4, 0x07400000 | (336u << 6) | 8);
    write(rcc, f405_ ? 8 : 4, f405_ ? 0x9400 : 0x001D0400);
    write(rcc, 0, 0x01010083);
    pass(300'000);
    write(rcc, f405_ ? 8 : 4, f405_ ? 0x9402 : 0x001D0402);
  }

  void step() {
    switch (random_.below(16)) {
      case 0:
        return pass(random_.below(20'000));
      case 1:
        return pass(random_.one_in(8) ? random_.below(1'000'000) : random_.below(300));
      case 2:
        return touch_pin();
      case 3:
      case 4:
        return stir();
      default:
        return access();
    }
  }

  void access() {
    const Region& region =
        random_.one_in(12) ? any_block() : blocks_[random_.below(std::uint32_t(blocks_.size()))];
    const unsigned size = random_.one_in(4) ? 1u << random_.below(2) : 4u;
    const std::uint32_t reach = random_.one_in(8) ? region.size : std::min(region.size, 0x100u);
    const std::uint32_t offset = random_.below(reach) & ~(size - 1);
    if (spared(region, offset)) return;
    ++out_.accesses;
    const std::uint64_t before = bench_.events().fired();
    switch (random_.below(4)) {
      case 0:
        bench_.get(region, offset, size);
        break;
      case 1:
        bench_.put(region, offset,
                   bench_.get(region, offset, size) | (1u << random_.below(8 * size)), size);
        break;
      default:
        bench_.put(region, offset, value(), size);
    }
    if (random_.one_in(4)) pass(random_.below(200));
    judge(before, 200);
  }

  // What most blocks take for "on" or "go", in their first registers: left to chance few would run.
  void stir() {
    static constexpr std::uint32_t kGo[] = {0x1, 0x41, 0x200C, 0x101, 0x40000001, 0x344, 0xFF};
    const Region& region = blocks_[random_.below(static_cast<std::uint32_t>(blocks_.size()))];
    const std::uint32_t offset = random_.one_in(2) ? 0 : 4 * random_.below(8);
    if (spared(region, offset)) return;
    ++out_.accesses;
    const std::uint64_t before = bench_.events().fired();
    bench_.put(region, offset, bench_.get(region, offset, 4) | kGo[random_.below(7)], 4);
    judge(before, 0);
  }

  // Without clocks and with the core in reset nothing else would be seen: less often.
  bool spared(const Region& region, std::uint32_t offset) {
    const bool rcc = region.base == (f405_ ? 0x40023800u : 0x40021000u);
    const bool watchdog = region.base == 0x40003000u || region.base == 0x40002C00u;
    if (rcc && offset < 0x48) return !random_.one_in(6);
    return watchdog && !random_.one_in(6);
  }

  std::uint32_t value() {
    switch (random_.below(12)) {
      case 7:
        return random_.below(256);
      case 8:
        return random_.next() & random_.next() & random_.next();
      case 0:
        return 0;
      case 1:
        return 0xFFFFFFFF;
      case 2:
        return 1u << random_.below(32);
      case 3:
        return random_.below(0x10000);
      case 4:
        return 1 + random_.below(8);
      case 5:
        return kRam + (random_.below(kRam_bytes) & ~3u);
      case 6:
        return any_block().base + (random_.below(0x100) & ~3u);
      default:
        return random_.next();
    }
  }

  void touch_pin() {
    const std::string name =
        std::string("P") + char('A' + random_.below(3)) + std::to_string(random_.below(16));
    io::Wire* wire = bench_.chip().pin(name);
    if (wire == nullptr) return;
    const bool level = random_.one_in(2);
    wire->force(random_.one_in(4) ? io::Drive::none
                : level           ? io::Drive::high
                                  : io::Drive::low,
                bench_.events().now());
  }

  void pass(Nanoseconds time_ns) {
    const std::uint64_t before = bench_.events().fired();
    bench_.pass(time_ns);
    judge(before, time_ns);
  }

  void judge(std::uint64_t before, Nanoseconds time_ns) {
    const std::uint64_t fired = bench_.events().fired() - before;
    const auto limit =
        kEvents_per_access + kEvents_per_us * static_cast<std::uint64_t>(time_ns) / 1000;
    if (fired <= limit || !out_.complaint.empty()) return;
    out_.complaint =
        std::to_string(fired) + " events in " + std::to_string(time_ns) + " ns of virtual time";
  }

  Xorshift random_;
  bool f405_;
  Bench bench_;
  std::vector<Region> blocks_;
  FuzzOutcome out_;
};

}  // namespace

FuzzOutcome fuzz_registers(std::uint64_t seed) {
  return Program(seed).run();
}

}  // namespace whirl::stm32
