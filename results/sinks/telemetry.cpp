// What a board sent on its UARTs. MAVLink is telemetry.tlog, framed as it came: time in us (big-endian
// u64) before each chunk of one message, as ground stations keep their logs. Anything else is serial.txt,
// byte for byte. Which of the two it is shows at the end only: both are written, one stays.
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

// A radio hands over whole frames, and a frame begins with the mark of MAVLink 1 or 2.
bool begins_frame(std::span<const std::uint8_t> bytes) {
  return bytes[0] == 0xFD || bytes[0] == 0xFE;
}

class Telemetry : public Sink {
 public:
  explicit Telemetry(const SinkSetup& setup) {
    for (std::size_t node = 0; node < setup.head.nodes.size(); ++node) {
      files_.push_back({OutputFile(file_of_node(setup, node, "telemetry", ".tlog")),
                        OutputFile(file_of_node(setup, node, "serial", ".txt"))});
    }
  }

  void on_message(const io::Reader& message) override {
    const io::Header& header = message.header();
    if (header.kind != io::Kind::uart_received || message.payload().empty()) return;
    const std::string chunk(message.payload().begin(), message.payload().end());
    Files& files = files_[header.board];
    files.mavlink = files.mavlink && begins_frame(message.payload());
    files.serial.write(chunk);
    if (!files.mavlink) return;
    const std::uint64_t t_us = static_cast<std::uint64_t>(header.t_ns) / 1000;
    std::string framed;
    for (int shift = 56; shift >= 0; shift -= 8) framed += static_cast<char>(t_us >> shift);
    files.tlog.write(framed + chunk);
  }

  std::vector<Error> finish() override {
    std::vector<Error> lost;
    for (Files& files : files_) {
      close(files.mavlink ? files.tlog : files.serial, lost);
    }
    return lost;
  }

 private:
  struct Files {
    OutputFile tlog, serial;
    bool mavlink = true;  // so far
  };
  std::vector<Files> files_;
};

}  // namespace

const SinkType kTelemetry{"csv", "telemetry.tlog or serial.txt", true, make_sink<Telemetry>};

}  // namespace whirl::results
