// Either bridge's chip with two targets on its bus, in memory: a part with 256 registers, and what a test adds.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "io_bridges/devices/i2c_bus.hpp"
#include "io_bridges/hid/emulated/cp2112_chip.hpp"
#include "io_bridges/hid/emulated/mcp2221_chip.hpp"
#include "io_bridges/hid/emulated/memory_hid_port.hpp"
#include "io_bridges/hid/i2c_bridge.hpp"

namespace whirl::io {

// A register pointer, then data that moves it on. Refuses what is written from register `refuses` on.
class Registers : public I2cTarget {
 public:
  explicit Registers(std::uint8_t address) : address_(address) {}
  bool answers(std::uint8_t address) const override { return address == address_; }
  bool start(std::uint8_t, bool read, Nanoseconds) override {
    pointed_ = read;
    return true;
  }
  bool write(std::uint8_t byte, Nanoseconds) override {
    if (!std::exchange(pointed_, true)) {
      pointer = byte;
      return true;
    }
    if (pointer >= refuses) return false;
    content[pointer++] = byte;
    return true;
  }
  std::uint8_t read(Nanoseconds) override { return content[pointer++]; }
  void acked(bool, Nanoseconds) override {}
  void stop(Nanoseconds) override { ++stops; }

  std::array<std::uint8_t, 256> content{};
  std::uint8_t pointer = 0;
  int refuses = 256;
  int stops = 0;

 private:
  std::uint8_t address_;
  bool pointed_ = false;
};

struct BridgeBench {
  explicit BridgeBench(BridgeKind which) : kind(which) {
    bus.add(registers);
    if (kind == BridgeKind::mcp2221a) {
      chip = std::make_unique<Mcp2221Chip>(queue, bus, "A1");
    } else {
      chip = std::make_unique<Cp2112Chip>(queue, bus, "A1");
    }
  }
  Result<std::unique_ptr<I2cBridge>> open(int speed_Hz = 400'000) {
    I2cBridgeSettings settings;
    settings.speed_Hz = speed_Hz;
    return start_i2c_bridge(kind, std::make_unique<MemoryHidPort>(queue, *chip, cable), settings);
  }
  WireEngine& engine() {
    if (auto* mcp = dynamic_cast<Mcp2221Chip*>(chip.get())) return mcp->engine();
    return dynamic_cast<Cp2112Chip&>(*chip).engine();
  }

  BridgeKind kind;
  EventQueue queue;
  I2cBus bus{"I2C"};
  Registers registers{0x50};
  HidCable cable;
  std::unique_ptr<EmulatedHid> chip;
};

}  // namespace whirl::io
