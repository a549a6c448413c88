// The faults of a run: what to spoil, where, from when to when; and who has really done it.
//
//   Life     the board (or the harness, for its own kinds) adds Fault records to a FaultBook; the
//            wires and devices ask the book at each use and report the first time that they acted
//   Rule     a fault that nobody applied is an error of the run: see pending()
//   Address  I2C address (7 bit), or the device's number on its board for SPI, sensors and UARTs;
//            kAnywhere matches all
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::io {

// The numbers cross the link (FaultCommand::kind): append, never renumber.
enum class FaultKind : std::uint32_t {
  i2c_nack = 1,   // address and data not acknowledged; value n > 0: only the n-th data byte (1..)
  i2c_stuck_sda,  // SDA held low; value: lets go after so many SCL pulses (0: holds until the end)
  i2c_stuck_scl,  // SCL held low
  i2c_flip_bit,   // value = 8 * byte + bit: that bit of each transaction (bit 0 is the LSB)
  i2c_late,       // the target holds SCL for value seconds after its address
  i2c_silence,    // the target neither sees nor answers anything
  spi_frozen,     // MISO repeats the last transaction that passed before the fault
  spi_flip,       // MISO bit: value = 8 * byte + bit of each transaction
  spi_silent,     // MISO stays high, the target sees nothing
  sensor_frozen,  // the part goes on signalling, its data does not change
  sensor_offset,  // value added (SI); axis in Fault::axis
  sensor_wrong_identity,  // identity register reads value
  sensor_saturated,       // axis at its positive rail
  uart_loss,              // value: probability of each byte to vanish, towards the MCU
  uart_silence,           // nothing reaches the MCU
  uart_flip,              // value: probability of a flipped bit in each byte towards the MCU
  supply_dip,             // harness: bus voltage drops by value volts
  capture_lost,           // harness: no pose from the capture system
  esc_stopped,            // harness: the ESC of motor `address` stops its motor
  code_hangs,             // board: the watched function number `address` comes no further
  sensor_late,            // each measurement takes value seconds longer
  reset_pin,              // board: NRST goes low for an instant, at the start
  gnss_jammed,            // no fix while it lasts
  gnss_spoofed,        // the fix drifts away at value m/s along Fault::axis (0..2 north east down)
  gnss_dropout,        // value: probability of each solution not to come out
  rc_link_lost,        // the receiver no longer hears its transmitter
  rc_glitch,           // value: probability of each frame to carry nonsense
  memory_removed,      // a card pulled out, a part without supply; what it was writing is torn
  memory_cut,          // the same from the middle of its next write on (value: share of that write)
  memory_write_error,  // writes fail and leave the old bytes
  memory_crc_error,    // a card's blocks have a wrong bit on the wire, both ways
  memory_busy,         // a write does not end before the fault does
  sensor_brown_out,    // without supply while it lasts, then as after power-up
  gnss_brown_out,      // at its start the receiver begins anew: its saved settings, a hot start
  gnss_forgets,        // at its start rate and navigation model are the part's defaults; port and
                       // messages stay, so that it goes on
  sensor_scale,        // axis reads by value (a share) more, besides its offset
  // On CAN: `address` is the sending device's number (of can_lost, can_cut: the one that is cut off);
  // anywhere: every sender, of can_cut all devices.
  can_bit_error,       // a bit of each frame is inverted; value n > 0: of the n-th frame only
  can_no_ack,          // the acknowledge does not pass
  can_lost,            // acknowledged, and yet not received
  can_late,            // each frame is held for value seconds before it may start
  can_cut,             // the wire is open
  can_stuck_dominant,  // the wire is held dominant
  can_babble,          // a node of identifier 0 takes the share `value` of the bus (0: all of it)
  capture_frozen,      // harness: the capture system goes on sending the pose that it sent last
  board_unplugged,  // board: without supply and off its wires while it lasts, then as from power-up
  sensor_drift,     // what axis reads runs away: value (SI) more with each minute since its start
  winding_short,  // harness: the bridge of motor `address` takes value amperes more while it drives
  capture_moved,  // harness: the capture system's poses lie value metres further along W's first axis
  capture_turned,  // harness: and are turned by value radians about W's third
};

std::optional<FaultKind> fault_kind(std::string_view name);  // "i2c_nack"
const char* name(FaultKind kind);

inline constexpr int kAnywhere = -1;

struct Fault {
  std::uint32_t number = 0;  // of the plan; reported back
  FaultKind kind{};
  Nanoseconds start_ns = 0;
  Nanoseconds end_ns = kNever;
  int bus = kAnywhere;      // I2C3: 3, SPI1: 1, USART2: 2
  int address = kAnywhere;  // see above
  int axis = 0;             // inertial: 0..2 accelerometer x y z, 3..5 gyro x y z; magnetometer:
                            // 0..2 x y z; barometer: 0 pressure, 1 temperature;
                            // GNSS: 0..2 position, 3..5 velocity, north east down
  double value = 0.0;
};

class FaultBook {
 public:
  using Applied = std::function<void(std::uint32_t number, Nanoseconds now)>;

  void on_applied(Applied sink) { sink_ = std::move(sink); }
  void on_added(std::function<void(const Fault&)> sink) { added_.push_back(std::move(sink)); }
  void add(const Fault& fault);

  // The first fault of that kind that is in force at that place, or null. Cheap when there is none.
  const Fault* find(FaultKind kind, int bus, int address, Nanoseconds now,
                    int axis = kAnywhere) const;
  // It really acted: told to the sink once per fault.
  void applied(const Fault& fault, Nanoseconds now);
  // find() and, when there is one (of that axis), applied().
  const Fault* apply(FaultKind kind, int bus, int address, Nanoseconds now, int axis = kAnywhere);

  std::vector<std::uint32_t> pending() const;  // numbers of faults that nobody applied

 private:
  struct Entry {
    Fault fault;
    bool applied = false;
  };
  std::deque<Entry> entries_;  // find() hands out pointers: they must stay
  Applied sink_;
  std::vector<std::function<void(const Fault&)>> added_;
};

// The same of a part that may have no book.
inline const Fault* apply(FaultBook* book, FaultKind kind, int bus, int address, Nanoseconds now,
                          int axis = kAnywhere) {
  return book == nullptr ? nullptr : book->apply(kind, bus, address, now, axis);
}

// What faults add to an axis of a sensor: sensor_offset and sensor_drift together.
double added_by_faults(FaultBook* book, int bus, int address, Nanoseconds now, int axis);

}  // namespace whirl::io
