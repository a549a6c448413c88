// The devices of a board: built from its description, hung on the chip's pins and buses, joined to
// the messages of the link.
//
//   Numbers   a device's number is its place in the description's list; motors and UARTs have theirs
//   Types     mpu6000 (bus spiN, cs, int), esc_i2c (bus i2cN, address, motor), mavlink_link
//             (bus usartN or uartN, baud), serial (bus, baud: text lines and bytes as messages),
//             i2c_master (bus i2cN; params rate: orders from the harness), power_stage (motor,
//             params of motor and shunt; pins as power_stage.hpp says), pulse_source (bus: the pin it
//             drives; motor), volts (bus: an analog pin; params volts), jumper (cs: the pin it copies,
//             int: the pin it drives)
//   Logs      every I2C transaction; every SPI transaction with its first 16 pairs of bytes (MOSI,
//             MISO); data-ready edges; set-points; frames down the radio and
//             lines from a serial port
//   Errors    bad_input: unknown type, a bus or pin that the part does not have, a missing key
#pragma once
#include <memory>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/board_description/board_description.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/messages/messages.hpp"
#include "io_bridges/qemu/stm32/chip_model.hpp"

namespace whirl::board {

class DeviceRack {
 public:
  struct Site {
    io::EventQueue& events;
    stm32::ChipModel& chip;
    io::Batch& happened;
    io::FindingSink finding;
    std::uint64_t seed = 1;
  };

  explicit DeviceRack(Site site);
  ~DeviceRack();

  Result<Done> build(const BoardDescription& board);
  // A message from the harness; false: of a kind that is not for devices.
  bool take(const io::Reader& message);
  // At a boundary, before what happened is posted: what devices tell at each one.
  void report(io::Nanoseconds now);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace whirl::board
