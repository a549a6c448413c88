// The board: a part with its memories and peripherals, the devices on it, and the link to the
// harness. Everything of the virtual board that knows no QEMU.
//
//   Time     one EventQueue, driven by the emulator's virtual clock
//   Sync     at each boundary the board posts what happened since the last one, waits for what is
//            sensed at this instant and for the next boundary, and goes on
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/link/channel.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/board/core_faults.hpp"
#include "io_bridges/qemu/board/cortex_m.hpp"
#include "io_bridges/qemu/board/device_rack.hpp"
#include "io_bridges/qemu/board/emulator.hpp"
#include "io_bridges/qemu/board/image.hpp"
#include "io_bridges/qemu/board/parts.hpp"
#include "io_bridges/qemu/board/unanswered.hpp"
#include "io_bridges/qemu/board/watch.hpp"
#include "io_bridges/qemu/board/wire_ends.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

// What one board process is made of, once its description and image have been found good.
struct Setup {
  BoardDescription description;
  BoardRun run;
  const Part* part = nullptr;
  Image image;
};

// `text`: board_description/board_text.hpp.
Result<Setup> read_setup(std::string_view text);

// Why a core cannot go on: the number that takes the place of an exception's in a cpu_fault message.
enum class StoppedCore : std::uint32_t {
  frame_among_registers = 254,  // stack or vectors where registers or flash are
  locked_up = 255,              // a fault within HardFault or NMI
};

class Board final : stm32::InterruptLines, stm32::SystemBus, stm32::FlashArray {
 public:
  Board(Setup setup, io::Channel channel, Emulator& emulator);
  ~Board() override;
  Result<Done> build_devices();

  const Part& part() const { return *setup_.part; }
  const Image& image() const { return setup_.image; }
  const BoardDescription& description() const { return setup_.description; }
  const BoardRun& run() const { return setup_.run; }
  io::EventQueue& events() { return events_; }

  // For the plug-in to map: the part's blocks, the rest of the peripheral space, the core's own.
  const std::vector<stm32::Region>& regions() const { return chip_->regions(); }
  stm32::Region unanswered_region();
  std::vector<stm32::Region> core_regions();  // in 0xE0000000.., outside the SCS
  SysTick& systick() { return systick_; }
  CycleCounter& cycle_counter() { return cycle_counter_; }
  std::vector<std::uint8_t> system_rom() const;
  bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) {
    return chip_->flash_store(address, size, value);
  }

  // Life, called by the plug-in.
  void power_on(const std::string& versions);  // memories are mapped and loaded
  void on_timer();                             // the armed deadline is here
  void core_was_reset(stm32::ResetCause cause);
  [[noreturn]] void refuse(const Error& error);  // tells the harness why, and ends
  // Core registers by number: 0..15, 25 XPSR.
  using Registers = std::function<std::uint32_t(int number)>;
  [[noreturn]] void core_stopped(StoppedCore why, Nanoseconds now, const Registers& registers);
  // The core took or left an exception.
  void exception(const CoreState& before, const CoreState& after, const Registers& registers);
  Watch& watch() { return watch_; }

  // Messages to the harness, in order of time.
  io::Batch& happened() { return happened_; }
  void report(const io::Finding& finding);

 private:
  void set(int irq, bool level) override;                                          // InterruptLines
  bool read(std::uint32_t address, unsigned size, std::uint32_t& value) override;  // SystemBus
  bool write(std::uint32_t address, unsigned size, std::uint32_t value) override;
  void program(std::uint32_t address, std::uint64_t value, unsigned size) override;  // FlashArray
  std::uint64_t read(std::uint32_t address, unsigned size) override;
  void erase(std::uint32_t address, std::uint32_t bytes) override;

  void synchronise();
  void await_orders();
  void on_message(const io::Reader& message);
  Result<Done> watch_converters();
  Result<Done> follow_wires();
  void retime();
  void report_clocks();
  void report_busy();
  void check_profile();
  Peek peek() const;  // as debuggers look: nothing happens by it
  std::string stack_name(std::uint32_t top) const;
  nlohmann::json task_stacks() const;
  std::string handler_name(std::uint32_t exception) const;
  nlohmann::json handlers() const;
  std::string exception_name(std::uint32_t exception) const;
  nlohmann::json long_call(const LongCall& call) const;
  nlohmann::json watched_calls() const;
  void report_unknown_watches();
  io::CpuFault fault_registers(const Registers& registers);
  void add_statistics();
  [[noreturn]] void finish(io::BoardState state);

  Setup setup_;
  io::Channel channel_;
  Emulator& emulator_;
  io::EventQueue events_;
  io::Batch happened_;
  Watch watch_;
  std::unique_ptr<stm32::ChipModel> chip_;
  WireEnds wires_;
  DeviceRack devices_;
  CoreFaults core_faults_;
  SysTick systick_;
  CycleCounter cycle_counter_;
  Unanswered unanswered_;
  StoredWords itm_, flash_patch_, tpiu_, etm_, debug_mcu_;
  io::Event boundary_, profile_;
  double profile_told_Hz_ = 0.0;
  io::ClockSetup clocks_told_;
  Nanoseconds busy_told_ns_ = 0, slept_told_ns_ = 0;
  bool reported_ = false;  // the batch of this boundary has been posted
};

}  // namespace whirl::board
