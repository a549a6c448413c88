// wires.vcd of each board: its buses, serial lines and named pins as wires of one bit (IEEE 1364, value change dump).
//
//   Wires    as io_bridges/copper/channel_name.hpp names them. Of buses: those that the head of the run lists
//   Edges    io_bridges/copper/wire_drawing.hpp says which of them are derived, and the file's own header does too
//   Order    a transfer is told at its end: edges wait kWaits_ns for those before them. What is longer begins where the
//            file stands by then; how often that was is the file's last comment
#include <algorithm>
#include <cstdio>
#include <map>

#include "io_bridges/copper/wire_drawing.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

using copper::Edge;

constexpr std::int64_t kWaits_ns = 1'000'000'000, kEach_ns = 100'000'000;
constexpr std::int64_t kReady_ns =
    50'000;  // of a data-ready pulse as it is drawn: its fall is not told

constexpr std::string_view kHeader =
    "$version whirl export --vcd $end\n"
    "$comment\n"
    "  What the run tells: START, STOP, selects, the time of each byte's last clock, a serial "
    "chunk's last stop bit,\n"
    "  pins, data ready (its rise), the pulses of a throttle line. DERIVED: all edges within a "
    "byte (evenly spaced, as\n"
    "  fast as the closest two bytes of the transfer), the address byte of I2C, SPI's mode (0), "
    "the start of a serial\n"
    "  chunk (bytes back to back at the board file's baud rate), the bits of a CAN frame from its "
    "fields, start and end, "
    "the 50 us of a data-ready pulse.\n"
    "  NOT DRAWN: of a transfer on SPI the bytes behind the 16th, serial lines whose rate the "
    "board file does not state.\n"
    "$end\n"
    "$timescale 1 ns $end\n";

std::optional<int> number_behind(const std::string& bus, std::string_view kind) {
  if (!bus.starts_with(kind)) return std::nullopt;
  const std::string digits = bus.substr(kind.size());
  if (digits.empty() || digits.size() > 2) return std::nullopt;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return std::stoi(digits);
}

// One board's file.
class Waves {
 public:
  Waves(const std::string& path, const NodeHead& node) : out_(path) {
    for (std::size_t i = 0; i < node.buses.size() && i < node.devices.size(); ++i) {
      add_device(node.devices[i], node.buses[i], static_cast<std::uint16_t>(i));
    }
    for (const auto& [uart, baud_Hz] : node.bauds_Hz) {
      const std::string name = "usart" + std::to_string(uart);
      uarts_[static_cast<std::uint16_t>(uart)] = {wire(name + "_tx", '1'), wire(name + "_rx", '1'),
                                                  baud_Hz};
    }
    for (const int motor : node.throttles) {
      pulses_[static_cast<std::uint16_t>(motor)].wire =
          wire("pulses_" + std::to_string(motor), '0');
    }
    for (const std::string& pin : node.pins) pins_.push_back(wire("pin_" + pin, 'x'));
    write_header(node.name);
  }

  void on_message(const io::Reader& message) {
    const io::Header& header = message.header();
    switch (header.kind) {
      case io::Kind::i2c_transaction:
        if (const auto bus = i2c_.find(header.port); bus != i2c_.end()) {
          bus->second.add(copper::transfer_of(message), waiting_);
        } else {
          ++nowhere_;
        }
        break;
      case io::Kind::spi_transaction:
        draw_select(message);
        break;
      case io::Kind::uart_received:
      case io::Kind::uart_delivered:
        draw_chunk(message);
        break;
      case io::Kind::can_transfer:
        draw_frame(message);
        break;
      case io::Kind::data_ready:
        if (const auto line = ready_.find(header.port); line != ready_.end()) {
          waiting_.push_back({header.t_ns, line->second, true});
          waiting_.push_back({header.t_ns + kReady_ns, line->second, false});
        }
        break;
      case io::Kind::pin_edge:
        if (header.port < pins_.size()) {
          waiting_.push_back(
              {header.t_ns, pins_[header.port], message.as<io::PinEdge>().level != 0});
        }
        break;
      case io::Kind::pulse_train:
        start_pulses(message);
        break;
      default:  // no wire of these
        break;
    }
  }

  void advance_to(std::int64_t now_ns) {
    now_ns_ = now_ns;
    if (now_ns - flushed_ns_ < kEach_ns) return;
    flushed_ns_ = now_ns;
    pulses_until(now_ns);
    for (auto& [number, bus] : i2c_) {
      if (bus.open_end_ns() < now_ns - kWaits_ns / 2) bus.settle(waiting_);
    }
    flush(now_ns - kWaits_ns);
  }

  void finish(std::vector<Error>& lost) {
    pulses_until(now_ns_);
    for (auto& [number, bus] : i2c_) bus.settle(waiting_);
    flush(INT64_MAX);
    char text[200];
    std::snprintf(text, sizeof text,
                  "#%lld\n$comment %llu edges came too late and stand where the file was by then, "
                  "%llu transfers "
                  "were on no wire of the board file $end\n",
                  static_cast<long long>(std::max(now_ns_, written_ns_)),
                  static_cast<unsigned long long>(late_),
                  static_cast<unsigned long long>(nowhere_));
    out_.write(text);
    close(out_, lost);
  }

 private:
  struct Uart {
    std::uint16_t tx, rx;
    double baud_Hz;
    std::int64_t tx_free_ns = 0, rx_free_ns = 0;
  };
  struct Pulses {
    std::uint16_t wire = 0;
    io::PulseTrain train{.period_ns = 0};  // none yet
    std::int64_t next_ns = 0;
  };

  std::uint16_t wire(const std::string& name, char level) {
    names_.push_back(name);
    levels_.push_back(level);
    return static_cast<std::uint16_t>(names_.size() - 1);
  }

  void add_device(const std::string& device, const std::string& bus, std::uint16_t number) {
    if (const auto i2c = number_behind(bus, "i2c")) {
      const auto port = static_cast<std::uint16_t>(*i2c);
      if (i2c_.count(port) != 0) return;
      const std::uint16_t scl = wire(bus + "_scl", '1');
      i2c_.try_emplace(port, scl, wire(bus + "_sda", '1'));
    } else if (const auto spi = number_behind(bus, "spi")) {
      const auto port = static_cast<std::uint16_t>(*spi);
      auto [at, is_new] = spi_.try_emplace(port);
      if (is_new) {
        at->second.sck = wire(bus + "_sck", '0');
        at->second.mosi = wire(bus + "_mosi", '0');
        at->second.miso = wire(bus + "_miso", '0');
      }
      selects_[number] = wire(bus + "_cs_" + device, '1');
    } else {
      const auto can = number_behind(bus, "can");
      if (can && can_.count(static_cast<std::uint16_t>(*can)) == 0) {
        can_[static_cast<std::uint16_t>(*can)] = wire(bus, '1');
      }
      return;
    }
    ready_[number] = wire("ready_" + device, '0');  // of what never tells it the wire stays low
  }

  void write_header(const std::string& node) {
    out_.write(kHeader);
    out_.write("$scope module " + (node.empty() ? std::string("board") : node) + " $end\n");
    for (std::size_t i = 0; i < names_.size(); ++i) {
      out_.write("$var wire 1 " + code(i) + " " + names_[i] + " $end\n");
    }
    out_.write("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n");
    for (std::size_t i = 0; i < names_.size(); ++i) {
      out_.write(std::string(1, levels_[i]) + code(i) + "\n");
    }
    out_.write("$end\n");
  }

  // Printable characters from '!' on, as the format asks.
  static std::string code(std::size_t number) {
    std::string text(1, static_cast<char>('!' + number % 94));
    for (number /= 94; number > 0; number /= 94) text += static_cast<char>('!' + number % 94);
    return text;
  }

  void draw_select(const io::Reader& message) {
    const copper::Transfer t = copper::transfer_of(message);
    const auto bus = spi_.find(message.header().port);
    const auto select = selects_.find(t.address);
    if (bus == spi_.end() || select == selects_.end()) {
      ++nowhere_;
      return;
    }
    copper::SpiWireNumbers wires = bus->second;
    wires.select = select->second;
    copper::draw_spi(t, wires, waiting_);
  }

  void draw_frame(const io::Reader& message) {
    const auto bus = can_.find(message.header().port);
    if (bus == can_.end()) {
      ++nowhere_;
      return;
    }
    copper::draw_can(message.as<io::CanRecord>(), message.header().t_ns, bus->second, waiting_);
  }

  void draw_chunk(const io::Reader& message) {
    const auto uart = uarts_.find(message.header().port);
    if (uart == uarts_.end()) return;
    const bool sent = message.header().kind == io::Kind::uart_received;
    std::int64_t& free_ns = sent ? uart->second.tx_free_ns : uart->second.rx_free_ns;
    free_ns = copper::draw_uart(message.payload(), message.header().t_ns, uart->second.baud_Hz,
                                sent ? uart->second.tx : uart->second.rx, free_ns, waiting_);
  }

  void start_pulses(const io::Reader& message) {
    pulses_until(message.header().t_ns);
    const auto pulses = pulses_.find(message.header().port);
    if (pulses == pulses_.end()) return;
    pulses->second.train = message.as<io::PulseTrain>();
    pulses->second.next_ns = message.header().t_ns;
  }

  void pulses_until(std::int64_t now_ns) {
    for (auto& [motor, p] : pulses_) {
      if (p.train.period_ns <= 0) continue;
      for (; p.next_ns < now_ns; p.next_ns += p.train.period_ns) {
        if (p.train.width_ns <= 0) continue;
        waiting_.push_back({p.next_ns, p.wire, true});
        waiting_.push_back({p.next_ns + p.train.width_ns, p.wire, false});
      }
    }
  }

  void flush(std::int64_t before_ns) {
    std::stable_sort(waiting_.begin(), waiting_.end(),
                     [](const Edge& a, const Edge& b) { return a.t_ns < b.t_ns; });
    std::size_t i = 0;
    for (; i < waiting_.size() && waiting_[i].t_ns < before_ns; ++i) write(waiting_[i]);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(i));
    out_.write(text_);
    text_.clear();
  }

  void write(const Edge& edge) {
    const char level = edge.level ? '1' : '0';
    if (levels_[edge.wire] == level) return;
    levels_[edge.wire] = level;
    if (edge.t_ns < written_ns_) ++late_;
    if (edge.t_ns > written_ns_) {
      written_ns_ = edge.t_ns;
      text_ += '#';
      text_ += std::to_string(written_ns_);
      text_ += '\n';
    }
    text_ += level;
    text_ += code(edge.wire);
    text_ += '\n';
  }

  OutputFile out_;
  std::vector<std::string> names_;
  std::vector<char> levels_;
  std::map<std::uint16_t, copper::I2cDrawing> i2c_;
  std::map<std::uint16_t, copper::SpiWireNumbers> spi_;
  std::map<std::uint16_t, std::uint16_t> can_;
  std::map<std::uint16_t, std::uint16_t> selects_, ready_;  // by device
  std::map<std::uint16_t, Uart> uarts_;
  std::map<std::uint16_t, Pulses> pulses_;  // by motor
  std::vector<std::uint16_t> pins_;
  std::vector<Edge> waiting_;
  std::string text_;
  std::int64_t now_ns_ = 0, flushed_ns_ = 0, written_ns_ = 0;
  std::uint64_t late_ = 0, nowhere_ = 0;
};

class Vcd : public Sink {
 public:
  explicit Vcd(const SinkSetup& setup) {
    for (std::size_t node = 0; node < setup.head.nodes.size(); ++node) {
      boards_.push_back(std::make_unique<Waves>(file_of_node(setup, node, "wires", ".vcd"),
                                                setup.head.nodes[node]));
    }
  }

  void on_message(const io::Reader& message) override {
    boards_[message.header().board]->on_message(message);
  }
  void on_row(std::int64_t t_ns, std::span<const double> /*values*/) override {
    for (const auto& board : boards_) board->advance_to(t_ns);
  }
  std::vector<Error> finish() override {
    std::vector<Error> lost;
    for (const auto& board : boards_) board->finish(lost);
    return lost;
  }

 private:
  std::vector<std::unique_ptr<Waves>> boards_;
};

}  // namespace

const SinkType kVcd{"vcd", "wires.vcd", false, make_sink<Vcd>};

}  // namespace whirl::results
