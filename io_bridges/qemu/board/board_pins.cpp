#include "io_bridges/qemu/board/board_pins.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "io_bridges/board_description/bus_name.hpp"

namespace whirl::board {
namespace {

Error wrong(const std::string& board, const BoardPin& pin, const std::string& what) {
  return {ErrorKind::bad_input, (pin.place.empty() ? board : pin.place) + ": pin " + pin.name, what,
          ""};
}

const BoardPin* line_of(const std::vector<BoardPin>& pins, const std::string& line) {
  for (const BoardPin& pin : pins) {
    if (pin.bus == line) return &pin;
  }
  return nullptr;
}

// "i2c2.scl" is 2; 0: no line of an I2C bus.
int bus_of_line(const std::string& line) {
  const auto dot = std::min(line.find('.'), line.size());
  const std::string name = line.substr(dot);
  if (!line.starts_with("i2c") || (name != ".scl" && name != ".sda")) return 0;
  return bus_number(line.substr(0, dot)).value_or(0);
}

}  // namespace

Result<std::set<int>> join_pins(const std::vector<BoardPin>& pins, stm32::ChipModel& chip,
                                const std::string& board) {
  std::set<int> soldered;
  for (const BoardPin& pin : pins) {
    if (chip.pin(pin.pin) == nullptr) {
      return wrong(board, pin, "the part has no pin '" + pin.pin + "'");
    }
    if (pin.bus.empty()) continue;
    const int number = bus_of_line(pin.bus);
    const std::string bus = "i2c" + std::to_string(number);
    const BoardPin *scl = line_of(pins, bus + ".scl"), *sda = line_of(pins, bus + ".sda");
    if (number == 0 || scl == nullptr || sda == nullptr) {
      return wrong(board, pin, "bus '" + pin.bus + "' is not one of a pair i2cN.scl and i2cN.sda");
    }
    if (!soldered.insert(number).second) continue;
    if (!chip.solder_i2c(number, scl->pin, sda->pin)) {
      return wrong(board, pin, "the part has no bus " + bus);
    }
  }
  for (const BoardPin& pin : pins) {
    if (pin.pull.empty()) continue;
    if (pin.pull != "up" && pin.pull != "down") {
      return wrong(board, pin, "pull '" + pin.pull + "' is not up or down");
    }
    io::Wire& wire = *chip.pin(pin.pin);
    wire.drive(wire.add_driver(), pin.pull == "up" ? io::Drive::pull_high : io::Drive::pull_low, 0);
  }
  return soldered;
}

void log_edges(const std::vector<BoardPin>& pins, stm32::ChipModel& chip, io::Batch& happened) {
  for (std::size_t number = 0; number < pins.size(); ++number) {
    if (!pins[number].bus.empty()) continue;
    const auto record = [&happened, number](bool level, io::Nanoseconds now) {
      io::PinEdge edge;
      edge.level = level ? 1 : 0;
      happened.add(io::Kind::pin_edge, static_cast<std::uint16_t>(number), now, edge);
    };
    io::Wire& wire = *chip.pin(pins[number].pin);
    record(wire.level(), 0);
    wire.watch(record);
  }
}

void watch_empty_buses(const std::function<bool(int bus)>& used, stm32::ChipModel& chip,
                       const io::FindingSink& finding) {
  constexpr int kBuses = 3;
  for (int number = 1; number <= kBuses; ++number) {
    io::I2cBus* bus = chip.i2c(number);
    if (bus == nullptr || used(number)) continue;
    bus->on_transaction([number, finding, told = false](const io::I2cTransaction& t) mutable {
      if (std::exchange(told, true)) return;
      char address[8];
      std::snprintf(address, sizeof address, "0x%02x", t.address);
      finding(
          {t.stop_ns, "i2c" + std::to_string(number),
           std::string("the board has no device on this bus: nobody answers address ") + address});
    });
  }
}

}  // namespace whirl::board
