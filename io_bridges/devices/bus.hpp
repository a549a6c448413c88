// What a simulated part looks like from its bus: one interface per kind of bus.
//
//   A device speaks bytes at exact virtual times here and knows physical quantities on its other
//   side; it knows neither QEMU nor a plant. Controllers (the MCU's peripheral models, or a USB
//   bridge) own the timing of bits; a device is told the time at which the last bit of a byte
//   passed.
#pragma once
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::io {

// A slave on I2C. start() .. write()/read() .. stop(); a repeated START comes as start() again.
class I2cTarget {
 public:
  virtual ~I2cTarget() = default;
  virtual bool answers(std::uint8_t address_7bit) const = 0;
  // The address byte has passed. Returns the acknowledge bit (true: ACK).
  virtual bool start(std::uint8_t address_7bit, bool read, Nanoseconds now) = 0;
  virtual bool write(std::uint8_t byte, Nanoseconds now) = 0;  // returns ACK
  virtual std::uint8_t read(Nanoseconds now) = 0;     // byte that the master clocks out next
  virtual void acked(bool ack, Nanoseconds now) = 0;  // the master's answer to that byte
  virtual void stop(Nanoseconds now) = 0;             // STOP condition
  virtual void abandoned(Nanoseconds /*now*/) {}  // the clock has gone in mid-transfer, for good
};

// A slave on SPI. Chip select is a wire (see wire.hpp); the board wires it to select().
class SpiTarget {
 public:
  virtual ~SpiTarget() = default;
  virtual void select(bool selected, Nanoseconds now) = 0;
  // The first clock of a frame. A part that answers by what it knows when the frame is over needs none of it.
  virtual void begin(std::uint8_t /*mosi*/, std::uint32_t /*sck_Hz*/, int /*mode*/,
                     Nanoseconds /*now*/) {}
  // One frame has passed, full duplex, at sck_Hz and in mode (CPOL << 1 | CPHA). Returns MISO.
  virtual std::uint8_t transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                                Nanoseconds now) = 0;
  // One frame has passed on the bus while this target was not selected.
  virtual void passed_by(std::uint8_t /*mosi*/, Nanoseconds /*now*/) {}
};

// A character on an asynchronous line, as the receiver found it.
struct UartByte {
  std::uint8_t value = 0;
  bool framing_error = false;
  bool noise = false;
  bool is_break = false;
};

// How the transmitter had set up its end: the other side garbles what does not match its own.
struct UartFormat {
  double baud = 0.0;
  int data_bits = 8;  // without parity
  char parity = 'N';
  double stop_bits = 1.0;
  bool inverted = false;  // idle low, a one is low

  double bits() const {  // of a character, from its start bit to its last stop bit
    return 1 + data_bits + (parity != 'N' ? 1 : 0) + stop_bits;
  }
};

// The far end of a UART. The near end (the MCU) gives every byte to receive() when its stop bit has
// passed; the peer sends by calling the sink that the board joined to it, once per byte, at the
// time at which that byte's stop bit has passed.
class UartPeer {
 public:
  using Sink = std::function<void(const UartByte&, const UartFormat&)>;

  virtual ~UartPeer() = default;
  virtual void receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) = 0;
  void join(Sink to_mcu) { to_mcu_ = std::move(to_mcu); }

 protected:
  void send(const UartByte& byte, const UartFormat& format) {
    if (to_mcu_) to_mcu_(byte, format);
  }

 private:
  Sink to_mcu_;
};

// Something the verdict should know: strange firmware, a refused setting, an overrun.
struct Finding {
  Nanoseconds t_ns = 0;
  std::string where;  // "MPU6000", "I2C3"
  std::string what;
};
using FindingSink = std::function<void(const Finding&)>;

// What happens again and again is told once for each place and text.
class OnceFindings {
 public:
  explicit OnceFindings(FindingSink sink) : sink_(std::move(sink)) {}  // may be null
  void report(const Finding& finding) {
    if (reported_.insert(finding.where + finding.what).second && sink_) sink_(finding);
  }

 private:
  FindingSink sink_;
  std::set<std::string> reported_;
};

}  // namespace whirl::io
