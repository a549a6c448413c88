// The seams of the MCU model: what a register block sees of the chip around it.
//
//   Peripheral models follow the reference manual (RM0090 for F405, RM0008 for F103), not a driver.
//   They know no QEMU: the plug-in maps them into the guest, tests drive them with an EventQueue.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/event_queue.hpp"

namespace whirl::stm32 {

using io::Nanoseconds;

// A block of registers. Offsets are from the block's base; size is 1, 2 or 4 bytes, aligned to
// size. Narrow access follows the manual of the block (APB: a narrow write is replicated, a narrow
// read is a part of the word; blocks that take bytes, such as SPI_DR or CRC, see the size).
class Peripheral {
 public:
  virtual ~Peripheral() = default;
  virtual const char* name() const = 0;
  virtual std::uint32_t read(std::uint32_t offset, unsigned size) = 0;
  virtual void write(std::uint32_t offset, std::uint32_t value, unsigned size) = 0;
  virtual void reset() = 0;  // system reset, or the block's bit in RCC_xxxRSTR
};

// Interrupt lines into the NVIC, by IRQ number. Levels: the model holds a line as long as a flag
// and its enable are both set.
class InterruptLines {
 public:
  virtual ~InterruptLines() = default;
  virtual void set(int irq, bool level) = 0;
};

// What a bus master other than the CPU (DMA) reaches: memories and peripheral registers by address.
// False: nothing answers there (transfer error).
class SystemBus {
 public:
  virtual ~SystemBus() = default;
  virtual bool read(std::uint32_t address, unsigned size, std::uint32_t& value) = 0;
  virtual bool write(std::uint32_t address, unsigned size, std::uint32_t value) = 0;
};

// A peripheral's DMA request. The peripheral raises it; the DMA serves it through SystemBus (which
// reads or writes the data register and so usually lowers it again).
class DmaRequest {
 public:
  void set(bool level) {
    if (level == level_) return;
    level_ = level;
    if (changed_) changed_(level);
  }
  bool level() const { return level_; }
  void on_change(std::function<void(bool)> changed) { changed_ = std::move(changed); }
  // The DMA tells the peripheral that the programmed count ran out (ADC DDS).
  void transfer_complete() {
    if (complete_) complete_();
  }
  void on_transfer_complete(std::function<void()> complete) { complete_ = std::move(complete); }
  // The DMA tells the peripheral that it has moved one item for this request: its acknowledge line.
  // Requests that no register access lowers (timers, DAC) end here; after it the DMA asks level().
  void served() {
    if (served_) served_();
  }
  void on_served(std::function<void()> served) { served_ = std::move(served); }
  // The last but one item has been moved (I2C LAST: the next byte is answered with NACK).
  void last_but_one() {
    if (last_but_one_) last_but_one_();
  }
  void on_last_but_one(std::function<void()> last_but_one) {
    last_but_one_ = std::move(last_but_one);
  }

 private:
  bool level_ = false;
  std::function<void(bool)> changed_;
  std::function<void()> complete_;
  std::function<void()> served_;
  std::function<void()> last_but_one_;
};

// Clock frequencies as RCC has them now, and whether a block's clock is on. A register block whose
// clock is off reads 0 and ignores writes; RCC does that in front of the block and reports it once.
class Clocks {
 public:
  virtual ~Clocks() = default;
  virtual double hclk_Hz() const = 0;
  virtual double pclk1_Hz() const = 0;
  virtual double pclk2_Hz() const = 0;
  virtual double timclk1_Hz() const = 0;  // timers on APB1: twice PCLK1 unless its prescaler is 1
  virtual double timclk2_Hz() const = 0;
  virtual double lsi_Hz() const = 0;
  virtual double lse_Hz() const = 0;  // 0: no crystal fitted
  virtual double hse_Hz() const = 0;
  // Of the oscillator that SYSCLK comes from, as a share: limits and settings are meant without it.
  virtual double oscillator_error() const { return 0.0; }
  double nominal_Hz(double real_Hz) const { return real_Hz / (1.0 + oscillator_error()); }
  virtual void on_change(std::function<void()> changed) = 0;
};

// What every model is given.
struct Chip {
  io::EventQueue& events;
  InterruptLines& interrupts;
  SystemBus& bus;
  Clocks& clocks;
  io::FindingSink finding;
};

}  // namespace whirl::stm32
