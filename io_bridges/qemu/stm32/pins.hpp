// The pins of a part: each a wire to the board, with what the part drives onto it.
//
//   Pin      one driver on its wire; GPIO tells it mode, output type, pull and which signals its
//            alternate function selects. The wire may be replaced by the net of a bus (I2C): a pin
//            that the board solders to it, or that is muxed to a signal with a net, joins that net
//            for good
//   Input    signals hear the pin in whatever mode carries them (F103: RX and captures hear input
//            mode, too); they drive it in alternate mode only
//   Signals  by name ("SPI1_SCK"), shared by GPIO and the peripherals
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io_bridges/devices/wire.hpp"
#include "io_bridges/qemu/stm32/signal.hpp"

namespace whirl::stm32 {

enum class PinMode : std::uint8_t { input, output, alternate, analog };

struct PinSetting {
  PinMode mode = PinMode::input;
  bool open_drain = false;
  Drive pull = Drive::none;
  bool output = false;               // ODR
  std::array<Signal*, 4> signals{};  // that the pin carries now (F405: TIM2_CH1 and _ETR at most)
  bool operator==(const PinSetting&) const = default;
};

class Pin {
 public:
  using Watcher = std::function<void(bool level, Nanoseconds now)>;

  Pin(std::string name, Watcher watcher);
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;

  void set(const PinSetting& setting, Nanoseconds now);
  void set_output(bool level, Nanoseconds now);  // ODR alone: the fast way
  void join(io::Wire& net, Nanoseconds now);
  io::Wire& wire() { return *wire_; }
  bool level() const { return wire_->level(); }
  const PinSetting& setting() const { return setting_; }

 private:
  friend class PinBank;
  void attach(io::Wire& wire);
  void drive(Nanoseconds now);
  Drive wanted() const;

  io::Wire own_;
  io::Wire* wire_ = nullptr;
  int driver_ = 0;
  Watcher watcher_;
  PinSetting setting_;
};

class PinBank {
 public:
  PinBank() = default;
  PinBank(const PinBank&) = delete;
  PinBank& operator=(const PinBank&) = delete;

  // Creates the 16 pins of a port; the watcher is told every change of level.
  using PortWatcher = std::function<void(int pin, bool level, Nanoseconds now)>;
  std::array<Pin*, 16> make_port(char port, PortWatcher watcher);

  Pin* find(std::string_view name);  // "PB0"
  Signal& signal(const std::string& name);
  Signal* find_signal(const std::string& name);
  // A pin may carry the signal: it must hear its drives. Called by GPIO for each table entry.
  void connect(Pin& pin, Signal& signal);
  // The net on which a signal lives (an I2C bus's SDA).
  void set_net(const std::string& signal, io::Wire& net) { nets_[&this->signal(signal)] = &net; }
  io::Wire* net(const Signal* signal) const;

 private:
  std::map<std::string, std::unique_ptr<Pin>, std::less<>> pins_;
  std::map<std::string, std::unique_ptr<Signal>> signals_;
  std::map<const Signal*, io::Wire*> nets_;
};

}  // namespace whirl::stm32
