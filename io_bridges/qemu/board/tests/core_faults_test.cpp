// A board that is pulled out and put back, beside an emulator that is a few bytes of flash.
#include "io_bridges/qemu/board/core_faults.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "io_bridges/devices/faults.hpp"

namespace whirl::board {
namespace {

constexpr std::uint32_t kFlash = 0x08000000;

class FakeCore final : public Emulator {
 public:
  FakeCore() {
    const std::uint32_t reset = kFlash + 0x20 + 1;  // Thumb
    std::memcpy(flash + 4, &reset, sizeof reset);
    const std::uint16_t first[2] = {0x4801, 0x4685};
    std::memcpy(flash + 0x20, first, sizeof first);
  }
  std::uint32_t code() {
    std::uint32_t word = 0;
    peek(kFlash + 0x20, &word, sizeof word);
    return word;
  }
  bool peek(std::uint32_t address, void* to, std::size_t size) override {
    std::memcpy(to, flash + (address - kFlash), size);
    return true;
  }
  void write_cells(std::uint32_t address, const void* from, std::size_t size) override {
    std::memcpy(flash + (address - kFlash), from, size);
  }
  void reset_core(stm32::ResetCause cause) override {
    log += cause == stm32::ResetCause::power_on ? "P" : "p";
  }
  void lose_memories() override { log += "m"; }

  Nanoseconds now() const override { return 0; }
  void arm(Nanoseconds) override {}
  void set_interrupt(int, bool) override {}
  void pend_systick() override {}
  bool read_bus(std::uint32_t, void*, std::size_t) override { return false; }
  bool write_bus(std::uint32_t, const void*, std::size_t) override { return false; }
  std::uint32_t system_control_word(std::uint32_t) override { return 0; }
  std::uint32_t accessing_pc() const override { return 0; }
  double ahead_ns() const override { return 0.0; }
  std::uint64_t core_cycles() const override { return 0; }
  void retime(const CoreTiming&) override {}
  Nanoseconds slept_ns() const override { return 0; }
  [[noreturn]] void end() override { std::abort(); }

  std::uint8_t flash[64] = {};
  std::string log;
};

struct CoreBench {
  io::EventQueue events;
  FakeCore core;
  io::Batch happened;
  Image image;
  std::vector<std::string> watch;
  CoreFaults faults{{events, core, happened, image, watch, kFlash,
                     [this](double volts) { core.log += volts == 0.0 ? "0" : "3"; }}};

  bool unplug(std::uint32_t number, Nanoseconds start, Nanoseconds end) {
    io::FaultCommand fault;
    fault.number = number;
    fault.kind = static_cast<std::uint32_t>(io::FaultKind::board_unplugged);
    fault.start_ns = start;
    fault.end_ns = end;
    return faults.on_fault(fault);
  }
  int applied() const {
    int count = 0;
    for (io::Reader r(happened.bytes()); r.next();)
      count += r.header().kind == io::Kind::fault_applied ? 1 : 0;
    return count;
  }
};

TEST(CoreFaults, AnUnpluggedBoardSleepsAndComesBackAsFromPowerUp) {
  CoreBench bench;
  const std::uint32_t own = bench.core.code();
  EXPECT_TRUE(bench.unplug(1, 100, 200));
  bench.events.run_until(99);
  EXPECT_EQ(bench.core.log, "");
  bench.events.run_until(199);
  EXPECT_EQ(bench.core.log, "0p");
  EXPECT_EQ(bench.core.code(), 0xE7FDBF30u);  // WFI, and back to it
  EXPECT_EQ(bench.applied(), 1);
  bench.events.run_until(200);
  EXPECT_EQ(bench.core.log, "0p3mP");
  EXPECT_EQ(bench.core.code(), own);
}

TEST(CoreFaults, OfTwoThatOverlapTheLastOneGivesTheSupplyBack) {
  CoreBench bench;
  const std::uint32_t own = bench.core.code();
  bench.unplug(1, 100, 300);
  bench.unplug(2, 200, 400);
  bench.events.run_until(399);
  EXPECT_EQ(bench.core.log, "0p");
  EXPECT_EQ(bench.applied(), 2);
  bench.events.run_until(400);
  EXPECT_EQ(bench.core.log, "0p3mP");
  EXPECT_EQ(bench.core.code(), own);
}

TEST(CoreFaults, WithoutAnEndItStaysOutAndOtherKindsAreNotItsOwn) {
  CoreBench bench;
  bench.unplug(1, 100, io::kNever);
  bench.events.run_until(1'000'000'000);
  EXPECT_EQ(bench.core.log, "0p");
  io::FaultCommand other;
  other.kind = static_cast<std::uint32_t>(io::FaultKind::i2c_nack);
  EXPECT_FALSE(bench.faults.on_fault(other));
}

}  // namespace
}  // namespace whirl::board
