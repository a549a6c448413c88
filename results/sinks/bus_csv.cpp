// bus.csv of each board: every transfer on I2C and SPI and every frame on CAN with its bytes and times.
// On CAN the address is the identifier, the direction who sent: "mcu", or the device's number.
#include <algorithm>
#include <cstdio>
#include <span>

#include "base/text.hpp"
#include "results/sinks/bus_row.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

class BusCsv : public Sink {
 public:
  explicit BusCsv(const SinkSetup& setup) {
    for (std::size_t node = 0; node < setup.head.nodes.size(); ++node) {
      files_.emplace_back(file_of_node(setup, node, "bus", ".csv"));
      files_.back().write(kBus_columns);
    }
  }

  void on_message(const io::Reader& message) override {
    const std::string row = bus_row(message);
    if (!row.empty()) files_[message.header().board].write(row);
  }

  std::vector<Error> finish() override {
    std::vector<Error> lost;
    for (OutputFile& file : files_) close(file, lost);
    return lost;
  }

 private:
  std::vector<OutputFile> files_;
};

std::string frame_row(const io::Reader& message) {
  const auto r = message.as<io::CanRecord>();
  const std::string sender =
      r.sender < 0 ? "mcu"
      : r.sender >= io::CanRecord::kFirst_board
          ? "board " + std::to_string(r.sender - io::CanRecord::kFirst_board + 1)
          : "device " + std::to_string(r.sender);
  char text[128];
  std::snprintf(text, sizeof text, "%.9f,%.9f,can%d,0x%0*X,%s,%d,%u,",
                static_cast<double>(r.start_ns) * 1e-9,
                static_cast<double>(message.header().t_ns) * 1e-9, message.header().port,
                (r.frame.flags & 1) != 0 ? 8 : 3, r.frame.id,
                r.sender == -2 ? "babbling" : sender.c_str(), r.error == 0 ? 1 : 0, r.frame.length);
  std::string row = text;
  add_hex(std::span(r.frame.data).first(std::min<std::size_t>(r.frame.length, 8)), row);
  return row + '\n';
}

}  // namespace

std::string bus_row(const io::Reader& message) {
  const io::Header& header = message.header();
  if (header.kind == io::Kind::can_transfer) return frame_row(message);
  const bool spi = header.kind == io::Kind::spi_transaction;
  if (!spi && header.kind != io::Kind::i2c_transaction) return {};
  const auto t = message.as<io::BusTransaction>();
  char text[96];
  std::snprintf(text, sizeof text, "%.9f,%.9f,%s%d,0x%02X,%s,%d,%u,",
                static_cast<double>(t.start_ns) * 1e-9, static_cast<double>(header.t_ns) * 1e-9,
                spi ? "spi" : "i2c", header.port, t.address,
                spi ? "both" : (t.read != 0 ? "read" : "write"), t.acked != 0 ? 1 : 0, t.length);
  std::string row = text;
  add_hex(message.transferred(), row);
  return row + '\n';
}

const SinkType kBus_csv{"csv", "bus.csv", true, make_sink<BusCsv>};

}  // namespace whirl::results
