// What the board asks of the emulator that carries it. The plug-in implements it inside QEMU.
//
//   Calls   come and go under the emulator's one big lock
#pragma once
#include <cstddef>
#include <cstdint>

#include "io_bridges/devices/event_queue.hpp"
#include "io_bridges/qemu/board/core_timing.hpp"
#include "io_bridges/qemu/stm32/reset_cause.hpp"

namespace whirl::board {

using io::Nanoseconds;

class Emulator {
 public:
  virtual ~Emulator() = default;

  // Exact, but allowed in events and in register accesses only.
  virtual Nanoseconds now() const = 0;
  // Calls Board::on_timer() at that time; kNever: not at all. The last call counts.
  virtual void arm(Nanoseconds deadline) = 0;

  virtual void set_interrupt(int irq, bool level) = 0;
  virtual void pend_systick() = 0;
  // Resets core and NVIC before the next instruction, then calls Board::core_was_reset(cause).
  virtual void reset_core(stm32::ResetCause cause) = 0;

  // A bus master's view: no memory that only the core reaches.
  virtual bool read_bus(std::uint32_t address, void* to, std::size_t size) = 0;
  virtual bool write_bus(std::uint32_t address, const void* from, std::size_t size) = 0;
  // The core's view, for fault reports and statistics; memories only.
  virtual bool peek(std::uint32_t address, void* to, std::size_t size) = 0;
  // A word of the System Control Space, offset from 0xE000E000, without side effects.
  virtual std::uint32_t system_control_word(std::uint32_t offset) = 0;
  // Changes cells of flash or system ROM; translated code is thrown away.
  virtual void write_cells(std::uint32_t address, const void* from, std::size_t size) = 0;

  // The core's RAM holds what it does after power-up.
  virtual void lose_memories() = 0;

  // The instruction whose register access is being served; exact to its basic block's last access.
  virtual std::uint32_t accessing_pc() const = 0;
  // The core's own time is ahead of now() by that much, less than an instruction.
  virtual double ahead_ns() const = 0;
  // Of HCLK since power-on, as of the register access or event that is being served.
  virtual std::uint64_t core_cycles() const = 0;
  // The firmware has changed what the core's time depends on: from its next instruction on.
  virtual void retime(const CoreTiming& timing) = 0;
  // How long the core has slept so far.
  virtual Nanoseconds slept_ns() const = 0;
  // Ends the process, in order, at once.
  [[noreturn]] virtual void end() = 0;
};

}  // namespace whirl::board
