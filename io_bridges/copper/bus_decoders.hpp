// All decoders of a capture: edges in, the messages of a board's buses out, as the virtual board tells them.
//
//   Out      i2c_transaction, spi_transaction, data_ready (rises of ready_DEVICE), pin_edge, and uart_received, byte
//            by byte, of the board's TX; what cannot be read is a bus_unread and a finding
//   Kept     of SPI as many pairs as the virtual board keeps (kKept_pairs); the length counts all of them
//   Times    those of the edges; each message stands at its frame's end, in order of time on each bus
//   Marker   its rises are kept apart: they align the clocks
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/copper/channel_name.hpp"
#include "io_bridges/copper/edge.hpp"
#include "io_bridges/copper/i2c_decoder.hpp"
#include "io_bridges/copper/spi_decoder.hpp"
#include "io_bridges/copper/uart_decoder.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::copper {

inline constexpr std::size_t kKept_pairs = 16;

struct BoardNames {  // what stands behind a channel's name, by number
  std::vector<std::string> devices = {}, pins = {};
  std::map<int, double> bauds = {};  // by UART; one that is not here is not read
};

class BusDecoders {
 public:
  // channels: by wire number.
  // Errors  bad_input: a device or pin that the board has not; half of a bus
  static Result<std::unique_ptr<BusDecoders>> make(const std::vector<std::string>& channels,
                                                   const BoardNames& names);

  // In order of time. What ended is appended to `out`.
  void on_edge(const Edge& edge, io::Batch& out);
  // Nothing more comes before that time.
  void advance_to(std::int64_t t_ns, io::Batch& out);

  std::vector<std::string> buses() const;  // "i2c3", "spi1": that are seen whole
  const std::vector<std::int64_t>& marker_rises_ns() const { return marker_ns_; }
  std::uint64_t unread() const { return unread_count_; }

 private:
  struct I2cWires {
    int scl = -1, sda = -1;
    std::unique_ptr<I2cDecoder> decoder;
  };
  struct SpiWires {
    int sck = -1, mosi = -1, miso = -1;
    struct Select {
      int wire, device;
      std::unique_ptr<SpiDecoder> decoder;
    };
    std::vector<Select> selects;
  };
  struct UartWire {
    int wire;
    std::unique_ptr<UartDecoder> decoder;
  };

  Result<Done> join(int wire, const ChannelName& name, const std::string& channel,
                    const BoardNames& names);
  Result<Done> check_whole() const;
  void make_decoders();
  void settle();
  void route(const Edge& edge);
  void add_unread(const std::string& bus, bool spi, int number, const Unread& what);

  std::map<int, I2cWires> i2c_;
  std::map<int, SpiWires> spi_;
  std::vector<UartWire> uarts_;
  std::vector<std::optional<ChannelName>> roles_;  // by wire
  std::vector<int> numbers_;                       // by wire: of its device or pin
  std::vector<Edge> instant_;  // edges of one time, which have an order of their own
  std::vector<std::int64_t> marker_ns_;
  std::uint64_t unread_count_ = 0;
  io::Batch* out_ = nullptr;
};

}  // namespace whirl::copper
