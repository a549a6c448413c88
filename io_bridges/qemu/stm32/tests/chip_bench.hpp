// A part on the bench: registers by address, RAM, flash, the NVIC's lines, findings, virtual time.
// Addresses and bits in the tests are typed from RM0090, never taken from the models.
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/stm32/chip_model.hpp"
#include "io_bridges/qemu/stm32/stm32f405.hpp"

namespace whirl::stm32 {

class ChipBench : InterruptLines, SystemBus, FlashArray {
 public:
  using Make = std::unique_ptr<ChipModel> (*)(const ChipHost&);

  explicit ChipBench(double hse_Hz = 8e6, Make make = make_stm32f405) {
    flash_.assign(1024 * 1024, 0xFF);
    chip_ = make({events_, *this, *this, *this,
                  [this](const io::Finding& f) { findings.push_back(f.where + ": " + f.what); },
                  hse_Hz, 32768.0});
    chip_->reset(ResetCause::power_on);
  }

  std::uint32_t get(std::uint32_t address, unsigned size = 4) {
    const Region& region = find(address);
    return region.block->read(address - region.base, size);
  }
  void put(std::uint32_t address, std::uint32_t value, unsigned size = 4) {
    const Region& region = find(address);
    region.block->write(address - region.base, value, size);
  }
  void set_bits(std::uint32_t address, std::uint32_t bits) { put(address, get(address) | bits); }
  void clear_bits(std::uint32_t address, std::uint32_t bits) { put(address, get(address) & ~bits); }

  Nanoseconds now() const { return events_.now(); }
  void run(Nanoseconds ns) { events_.run_until(events_.now() + ns); }
  // Spins on a register, as a driver does, one read per 100 ns (or step). Returns when it was satisfied.
  Nanoseconds wait(std::uint32_t address, std::uint32_t mask, std::uint32_t want,
                   Nanoseconds limit = 100'000'000, Nanoseconds step = 100) {
    const Nanoseconds end = now() + limit;
    while ((get(address) & mask) != want) {
      if (now() >= end) {
        ADD_FAILURE() << std::hex << "no " << want << " under " << mask << " at " << address;
        return now();
      }
      run(step);
    }
    return now();
  }

  bool irq(int n) const { return irqs_[static_cast<std::size_t>(n)]; }
  ChipModel& chip() { return *chip_; }
  io::EventQueue& events() { return events_; }
  std::uint8_t* ram(std::uint32_t address) { return &ram_[address - 0x20000000]; }
  std::vector<std::uint8_t>& flash() { return flash_; }

  std::vector<std::string> findings;
  std::function<void(int, bool)> on_irq;

  // 168 MHz from the crystal: PCLK1 42 MHz, PCLK2 84 MHz, as SystemInit of most projects does.
  void clock_168() {
    constexpr std::uint32_t kRcc = 0x40023800, kFlash = 0x40023C00;
    set_bits(kRcc, 1u << 16);
    wait(kRcc, 1u << 17, 1u << 17);
    put(kFlash, 0x705);
    put(kRcc + 8, (5u << 10) | (4u << 13));
    const std::uint32_t m = static_cast<std::uint32_t>(chip_->clocks().hse_Hz() / 1e6);
    put(kRcc + 4, m | (336u << 6) | (1u << 22) | (7u << 24));
    set_bits(kRcc, 1u << 24);
    wait(kRcc, 1u << 25, 1u << 25);
    set_bits(kRcc + 8, 2);
    wait(kRcc + 8, 0xC, 8);
  }
  // Mode alternate function `af` on a pin of port 'A'.., open drain for I2C.
  void mux(char port, int pin, std::uint32_t af, bool open_drain = false) {
    const std::uint32_t base = 0x40020000 + 0x400u * static_cast<std::uint32_t>(port - 'A');
    set_bits(0x40023830, 1u << (port - 'A'));
    const std::uint32_t afr = base + 0x20 + 4u * static_cast<std::uint32_t>(pin / 8);
    clear_bits(afr, 0xFu << (4 * (pin % 8)));
    set_bits(afr, af << (4 * (pin % 8)));
    if (open_drain) set_bits(base + 4, 1u << pin);
    clear_bits(base, 3u << (2 * pin));
    set_bits(base, 2u << (2 * pin));
  }

 private:
  const Region& find(std::uint32_t address) {
    for (const Region& region : chip_->regions()) {
      if (address - region.base < region.size) return region;
    }
    static Region none;
    ADD_FAILURE() << std::hex << "nothing at " << address;
    std::abort();
    return none;
  }
  void set(int irq, bool level) override {
    irqs_[static_cast<std::size_t>(irq)] = level;
    if (on_irq) on_irq(irq, level);
  }
  bool read(std::uint32_t address, unsigned size, std::uint32_t& value) override {
    if (address - 0x20000000 >= ram_.size()) return false;
    value = 0;
    std::memcpy(&value, ram(address), size);
    return true;
  }
  bool write(std::uint32_t address, unsigned size, std::uint32_t value) override {
    if (address - 0x20000000 >= ram_.size()) return false;
    std::memcpy(ram(address), &value, size);
    return true;
  }
  void program(std::uint32_t address, std::uint64_t value, unsigned size) override {
    for (unsigned i = 0; i < size; ++i) {
      flash_[address - 0x08000000 + i] &= static_cast<std::uint8_t>(value >> (8 * i));
    }
  }
  std::uint64_t read(std::uint32_t address, unsigned size) override {
    std::uint64_t value = 0;
    std::memcpy(&value, &flash_[address - 0x08000000], size);
    return value;
  }
  void erase(std::uint32_t address, std::uint32_t bytes) override {
    std::memset(&flash_[address - 0x08000000], 0xFF, bytes);
  }

  io::EventQueue events_;
  std::array<bool, 96> irqs_{};
  std::vector<std::uint8_t> ram_ = std::vector<std::uint8_t>(128 * 1024);
  std::vector<std::uint8_t> flash_;
  std::unique_ptr<ChipModel> chip_;
};

}  // namespace whirl::stm32
