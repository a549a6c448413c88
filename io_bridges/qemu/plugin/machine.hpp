// SPDX-License-Identifier: GPL-2.0-or-later
//
// The board inside QEMU: its memories and registers over those of the machine, its events on QEMU's
// virtual clock, its interrupts in the NVIC.
//
//   Memory    system memory carries what every bus master sees; the core's container above it what
//             only the core sees (CCM, SCS, debug blocks)
//   Time      one QEMU timer for the earliest event of the board's queue
//   Sleep     WFI is exact and needs no thread switch: see sleep()
//   Threads   the CPU's thread does everything; QEMU's main loop is parked, as its waking at every
//             event would cost more than the event (not under gdb, which lives in the main loop)
//   Reset     is done by the CPU's own thread between two instructions, not by QEMU's main loop,
//             whose moment would depend on the host
//   Left out  WFE does not sleep: it returns at once, as the architecture allows, so a core that
//             waits by it counts as busy; option bytes and OTP cannot be written
#pragma once
#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "io_bridges/qemu/board/board.hpp"
#include "io_bridges/qemu/plugin/class_casts.hpp"
#include "io_bridges/qemu/plugin/core_clock.hpp"
#include "io_bridges/qemu/plugin/exit_request.hpp"
#include "io_bridges/qemu/plugin/qemu_api.hpp"
#include "io_bridges/qemu/plugin/system_control.hpp"

namespace whirl::qemu {

class Machine final : public board::Emulator {
 public:
  Machine(const Api& api, board::Setup setup, io::Channel channel);
  ~Machine() override;

  // The machine exists, nothing has run: map, load, power on.
  Result<Done> build(const std::string& versions);
  // From the execution callback of a WFI: see the file's end.
  void before_sleep(std::int64_t site);  // for CoreClock::at

  board::Board& board() { return board_; }
  const Api& api() const { return api_; }
  Cpu* cpu() const { return cpu_; }
  SystemControl& system_control() { return *system_control_; }
  // R0..R15 (0..15) and XPSR (25) as of the start of the current basic block.
  std::uint32_t core_register(int number) const;
  board::CoreState core_at(const Moment& moment) const;

  // The core cannot go on, by the firmware's doing. Ends the process.
  [[noreturn]] void core_stopped(board::StoppedCore why);
  // The core reaches for what is no memory. DMA may too, and is nothing that the core waits for.
  void accessed(std::uint32_t address);
  void waits_for_bus(std::uint32_t address, bool write) {
    if (!moves_by_dma_) clock_->accessed(address, write);
  }
  // Around what a register does: its events wait for the end.
  void begin_access() { ++accesses_; }
  void end_access();

  // For the instruments.
  CoreClock& clock() { return *clock_; }
  void throw_code_away() {
    throws_code_away_ = true;
    api_.tb_flush(cpu_);
  }
  // A block of so many instructions has been translated.
  void keep_room_for_code(std::size_t instructions);
  // So QEMU has, for us or because its buffer was full: then time may be another from there on, and that is
  // a finding (keep_room_for_code()).
  void code_thrown_away();
  // Only the blocks with that instruction. Also from within one: it runs to its end.
  void forget_code_at(std::uint32_t address) {
    api_.tb_invalidate_phys_addr(api_.address_space_memory, address, kPrivileged);
  }
  void code_translated(std::uint32_t from, std::uint32_t to);

  io::Nanoseconds now() const override {
    return asleep_since_ns_ < 0 ? api_.qemu_clock_get_ns(kVirtualClock) : sleep_now_ns_;
  }
  void arm(io::Nanoseconds deadline) override;
  void set_interrupt(int irq, bool level) override;
  void pend_systick() override;
  void reset_core(stm32::ResetCause cause) override;
  bool read_bus(std::uint32_t address, void* to, std::size_t size) override;
  bool write_bus(std::uint32_t address, const void* from, std::size_t size) override;
  bool peek(std::uint32_t address, void* to, std::size_t size) override;
  std::uint32_t system_control_word(std::uint32_t offset) override;
  void write_cells(std::uint32_t address, const void* from, std::size_t size) override;
  void lose_memories() override;
  std::uint32_t accessing_pc() const override;
  io::Nanoseconds slept_ns() const override;
  double ahead_ns() const override { return asleep_since_ns_ < 0 ? clock_->ahead_ns() : 0.0; }
  std::uint64_t core_cycles() const override { return clock_->core_cycles(); }
  void retime(const board::CoreTiming& timing) override;
  [[noreturn]] void end() override;

 private:
  // One mapped block of registers.
  struct Window {
    Machine* machine;
    stm32::Peripheral* block;
    std::uint32_t base;
  };
  static std::uint64_t read_window(void* window, hwaddr offset, unsigned size);
  static void write_window(void* window, hwaddr offset, std::uint64_t value, unsigned size);
  void anchor() {
    clock_->settle();
    clock_->anchor(now());
  }
  [[noreturn]] void clock_not_as_known();
  void wake();
  void on_timer();
  void run_what_is_due();
  void take_exception();
  bool find_registers();
  MemoryRegion& new_region();
  void map_block(MemoryRegion* parent, const stm32::Region& block, int priority);
  std::uint8_t* map_ram(MemoryRegion* parent, const char* name, const board::MemoryBlock& block);
  bool move_by_dma(std::uint32_t address, void* bytes, std::size_t size, bool write);
  std::uint8_t* sram_at(std::uint32_t address, std::size_t size) const;
  void bar(std::uint32_t from, std::uint32_t to);
  void map_memories();
  void load_image();
  // What reaches the core from outside, and must not before QEMU's clock is right.
  struct Deferred {
    enum Kind : std::uint8_t { interrupt, systick, reset } kind;
    int irq;
    bool level;
    stm32::ResetCause cause;
  };
  void work_before_sleep();
  void sleep();
  bool catch_up();
  void hold();
  void act_on_deferred();
  void give_way();
  void act(const Deferred& what);
  void act_or_defer(const Deferred& what);
  void queue_reset(stm32::ResetCause cause);
  void init_timers();
  void park_main_loop();
  void run_at_once();

  const Api& api_;
  board::Board board_;
  Cpu* cpu_ = nullptr;
  Object* nvic_ = nullptr;
  MemoryRegion* core_memory_ = nullptr;
  std::vector<Irq*> interrupts_;
  std::vector<std::unique_ptr<MemoryRegion>> regions_;
  std::vector<std::unique_ptr<Window>> windows_;
  std::uint8_t *sram_ = nullptr, *ccm_ = nullptr;
  std::vector<bool> sram_holds_code_;  // of its pages: QEMU has translated some of it
  std::unique_ptr<SystemControl> system_control_;
  GByteArray* register_text_ = nullptr;
  void* parking_ = nullptr;  // bottom half of the main loop
  Timer timer_;
  io::Nanoseconds armed_ns_ = io::kNever;  // that it is set to
  static constexpr io::Nanoseconds kNothing_wanted = -1;
  io::Nanoseconds wanted_ns_ = kNothing_wanted;  // by what is accessed
  int accesses_ = 0;                             // under way: one, or within it by DMA another
  bool throws_code_away_ = false, full_buffer_told_ = false;
  bool moves_by_dma_ = false;  // what is accessed through QEMU's address spaces
  Timer jump_;                 // under gdb: moves the clock of a core that sleeps
  std::unique_ptr<CoreClock> clock_;
  ExitRequest exit_request_;
  ClassCasts class_casts_;
  const std::uint32_t* core_registers_ = nullptr;  // R0..R15 in QEMU's CPU; its env begins there
  io::Nanoseconds slept_ns_ = 0, asleep_since_ns_ = -1, sleep_now_ns_ = 0;
  std::chrono::steady_clock::time_point gave_way_{};  // host's clock: moves nothing in the guest
  std::vector<Deferred> deferred_;                    // in order
  std::deque<stm32::ResetCause> queued_resets_;       // that QEMU will act on
};

}  // namespace whirl::qemu
