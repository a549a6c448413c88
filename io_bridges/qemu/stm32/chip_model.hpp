// A whole microcontroller without its core: what the board process and the plug-in see of it,
// whichever part it is (Stm32f405, Stm32f103).
//
//   Plug-in   maps regions() into the guest, forwards writes into flash to flash_store(), raises
//             InterruptLines in the NVIC, and calls reset(cause) whenever the guest was reset
//   Board     hangs devices on pin(), i2c(), spi(), uart(), analog inputs
//   Reset     a watchdog asks for a reset through on_reset_request(); the plug-in then resets the
//             core and comes back with reset(that cause)
#pragma once
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "io_bridges/devices/bus.hpp"
#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/devices/spi_slave.hpp"
#include "io_bridges/devices/wire.hpp"
#include "io_bridges/qemu/cycles/flash_timing.hpp"
#include "io_bridges/qemu/stm32/flash_array.hpp"
#include "io_bridges/qemu/stm32/peripheral.hpp"
#include "io_bridges/qemu/stm32/reset_cause.hpp"

namespace whirl::stm32 {

class Adc;
class BxCan;
class Timer;

// One mapped block. `block` already has the clock gate in front.
struct Region {
  std::uint32_t base = 0;
  std::uint32_t size = 0;
  Peripheral* block = nullptr;
};

// What the chip model is built on. All references must outlive it.
struct ChipHost {
  io::EventQueue& events;
  InterruptLines& interrupts;
  SystemBus& memory;  // RAM and flash; register blocks are found by the chip model itself
  FlashArray& flash;
  io::FindingSink finding;
  double hse_Hz = 0.0;  // crystals of the board; 0: not fitted
  double lse_Hz = 0.0;
  Nanoseconds hse_start_ns = 2'000'000;  // until the crystal swings
  // How much faster than it says an oscillator runs, as a share.
  double hsi_error = 0.0, hse_error = 0.0;
};

class ChipModel {
 public:
  virtual ~ChipModel() = default;

  virtual const std::vector<Region>& regions() const = 0;
  virtual void reset(ResetCause cause) = 0;
  virtual void on_reset_request(std::function<void(ResetCause)> request) = 0;
  // The CPU wrote into the flash's address range. False: the part would answer with a bus fault.
  virtual bool flash_store(std::uint32_t address, unsigned size, std::uint32_t value) = 0;

  virtual io::Wire* pin(std::string_view name) = 0;  // "PB0"; null: the part has no such pin
  virtual io::I2cBus* i2c(int number) = 0;           // null: the part has no such bus
  // Solders two pins to the bus: they belong to its nets in every mode. Empty names: the one pair
  // that the part has for it; true without effect where it has several, and the first that firmware
  // muxes to the bus joins then. False: no such bus or pins.
  virtual bool solder_i2c(int /*number*/, std::string_view /*scl*/, std::string_view /*sda*/) {
    return false;
  }
  virtual io::SpiBus* spi(int number) = 0;
  // The same block as an external master's clock finds it; null: the part has no such SPI.
  virtual io::SpiSlave* spi_slave(int /*number*/) { return nullptr; }
  virtual bool join_uart(int number, io::UartPeer& peer) = 0;  // USARTn or UARTn
  // Volts at an analog input, asked for at each sampling instant.
  virtual bool set_analog(std::string_view pin, std::function<double(Nanoseconds)> volts) = 0;
  // Told at each change of what the DAC's channel puts out. False: the part has no such channel.
  virtual bool on_dac(int /*channel*/, std::function<void(double volts)> /*told*/) { return false; }
  virtual void set_vdd(double /*volts*/) {
  }  // the supply's level for PWR's detector; 3.3 V at first
  // For what follows a timer's pattern rather than its edges (a power stage), and for CAN nodes.
  virtual Timer* timer(int /*number*/) { return nullptr; }  // null: the part has no such timer
  virtual BxCan* can(int /*number*/) { return nullptr; }
  virtual Adc* converter(int /*number*/) { return nullptr; }
  virtual const Clocks& clocks() const = 0;
  // Told after each change of a clock, for what is clocked outside of the chip model (SysTick).
  virtual void on_clock_change(std::function<void()> changed) = 0;
  // The flash interface as it is set up now, and who is told when that changes.
  virtual cycles::FlashTiming flash_timing() const = 0;
  virtual void on_flash_timing_change(std::function<void()> changed) = 0;
  virtual double core_waits_for_dma_at_most_ns() const { return 0.0; }  // see dma_bus.hpp
  virtual double sysclk_Hz() const = 0;  // what the firmware has set up now
};

}  // namespace whirl::stm32
