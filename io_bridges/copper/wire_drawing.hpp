// The edges of wires behind what a run tells of its buses: the other way round than the decoders.
//
//   Known    START and STOP, select and deselect, and when each byte's last clock had passed; of a UART when the last
//            stop bit of a chunk had
//   Derived  everything within a byte: its clocks are evenly spaced, as fast as the closest two bytes of the transfer
//            allow; a byte without neighbours fills the time that its transfer has. The address byte of I2C stands
//            directly before the first data byte. SPI is drawn in mode 0. The bytes of a UART's chunk stand back to back
//            before its end, at the baud rate that the board file states
//            The bits of a CAN frame come of its fields
//   Not      drawn: bytes that the run did not keep (of SPI those behind the first 16 pairs)
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io_bridges/copper/edge.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::copper {

struct Transfer {  // a BusTransaction with its bytes
  std::int64_t start_ns = 0, stop_ns = 0;
  std::uint16_t address = 0;
  bool read = false, acked = true;
  std::vector<std::uint8_t> bytes = {};  // SPI: MOSI and MISO in turn
  std::vector<std::int64_t> passed_ns =
      {};  // of each byte, SPI: of each pair; without those that are not known
};

// Of an i2c_transaction or spi_transaction.
Transfer transfer_of(const io::Reader& message);

class I2cDrawing {
 public:
  I2cDrawing(std::uint16_t scl, std::uint16_t sda) : scl_(scl), sda_(sda) {}

  void add(const Transfer& transfer, std::vector<Edge>& edges);
  // How the last transfer ended is known when the next one is, or when none comes: with STOP then.
  void settle(std::vector<Edge>& edges);
  std::int64_t open_end_ns() const { return ending_ ? ending_->stop_ns : INT64_MAX; }

 private:
  struct Ending {
    std::int64_t last_ns, stop_ns;  // the last fall of SCL; STOP
  };
  void end(bool repeated, std::vector<Edge>& edges);

  std::uint16_t scl_, sda_;
  std::optional<Ending> ending_;
};

struct SpiWireNumbers {
  std::uint16_t sck = 0, mosi = 0, miso = 0, select = 0;
};
void draw_spi(const Transfer& transfer, const SpiWireNumbers& wires, std::vector<Edge>& edges);

// `after_ns`: the line is taken until then; the chunk begins no earlier. Returns its end.
std::int64_t draw_uart(std::span<const std::uint8_t> bytes, std::int64_t last_stop_ns,
                       double baud_Hz, std::uint16_t wire, std::int64_t after_ns,
                       std::vector<Edge>& edges);

// A frame on CAN, as its receivers see the bus. A bit is a third of the intermission; of a frame that broke off, `bit`
// of them stand, then six dominant ones: how long the error flags overlapped is not told.
void draw_can(const io::CanRecord& frame, std::int64_t end_ns, std::uint16_t wire,
              std::vector<Edge>& edges);
// Its bits from start of frame to the end of its CRC, stuffed.
std::vector<bool> can_bits(const io::CanMessage& frame);

}  // namespace whirl::copper
