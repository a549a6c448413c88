// The faults of wires: what a FaultBook asks for, done to the bytes and levels on their way.
//
//   I2cWireFaults   hangs on an I2cBus; drives SDA and SCL itself while they are stuck
//   SpiWireFaults   stands between a controller and one SpiTarget
//   UartWireFaults  stands between the MCU and a UartPeer; spoils what goes towards the MCU, and on a wire between
//                   two boards what leaves it as well: a character by what holds at its start bit
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "base/random.hpp"
#include "io_bridges/devices/early_uart_peer.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/devices/i2c_bus.hpp"

namespace whirl::io {

class I2cWireFaults : public I2cFaults {
 public:
  // Joins the bus as its faults. `number` is the bus's number in Fault::bus (I2C3: 3).
  I2cWireFaults(EventQueue& queue, FaultBook& book, I2cBus& bus, int number);

  bool deaf(std::uint8_t address, Nanoseconds now) override;
  bool ack(std::uint8_t address, int index, Nanoseconds now) override;
  std::uint8_t byte(std::uint8_t address, int index, std::uint8_t value, Nanoseconds now) override;
  Nanoseconds stretch(std::uint8_t address, Nanoseconds now) override;

 private:
  void schedule(const Fault& fault);
  void grip(const Fault& fault);  // the line goes low
  void let_go(Wire& wire);
  void count_pulse(Nanoseconds now);

  EventQueue& queue_;
  FaultBook& book_;
  I2cBus& bus_;
  int number_;
  std::vector<std::unique_ptr<Event>> events_;
  int pulses_left_ = 0;  // of SCL, until a stuck SDA lets go; 0: it does not
};

class SpiWireFaults : public SpiTarget {
 public:
  SpiWireFaults(FaultBook& book, SpiTarget& target, int bus, int device)
      : book_(book), target_(target), bus_(bus), device_(device) {}

  void select(bool selected, Nanoseconds now) override;
  void begin(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) override {
    target_.begin(mosi, sck_Hz, mode, now);
  }
  std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                        Nanoseconds now) override;
  void passed_by(std::uint8_t mosi, Nanoseconds now) override { target_.passed_by(mosi, now); }

 private:
  FaultBook& book_;
  SpiTarget& target_;
  int bus_, device_;
  std::vector<std::uint8_t> last_good_;  // MISO of the last transaction that passed whole
  std::vector<std::uint8_t> current_;
  bool spoiled_ = false;
};

class UartWireFaults : public EarlyUartPeer {
 public:
  enum class Spoils : std::uint8_t { towards_mcu, both_ways };

  // Joins the far peer; the board joins this object in its place.
  UartWireFaults(EventQueue& queue, FaultBook& book, UartPeer& far, int number, std::uint64_t seed,
                 Spoils spoils = Spoils::towards_mcu);

  void begin(const UartByte& byte, const UartFormat& format, Nanoseconds now,
             Nanoseconds end) override;
  void receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) override;

 private:
  std::optional<UartByte> passed(UartByte byte);  // nothing: it does not arrive

  EventQueue& queue_;
  FaultBook& book_;
  UartPeer& far_;
  EarlyUartPeer* early_;  // the same, or null
  int number_;
  RandomStream random_;
  Spoils spoils_;
  std::optional<UartByte> leaving_;  // what is left of the character that the MCU sends
};

}  // namespace whirl::io
