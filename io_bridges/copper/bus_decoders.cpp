#include "io_bridges/copper/bus_decoders.hpp"

#include <algorithm>

namespace whirl::copper {
namespace {

int place_in(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

Error wrong(const std::string& channel, const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, channel, what, cure};
}

void add_frame(io::Kind kind, int bus, io::BusTransaction head, std::int64_t stop_ns,
               std::span<const std::uint8_t> bytes, std::span<const std::int64_t> passed_ns,
               io::Batch& out) {
  std::vector<std::uint32_t> times;
  for (const std::int64_t at : passed_ns) times.push_back(io::passed_ns(head.start_ns, at));
  io::add_transaction(kind, static_cast<std::uint16_t>(bus), stop_ns, head, bytes, times, out);
}

// At one instant data changes with a low clock: it follows the fall and goes before the rise. A select frames all.
int order(const std::optional<ChannelName>& name, bool level) {
  if (!name) return 2;
  const bool clock = name->role == Role::scl || name->role == Role::sck;
  if (name->role == Role::chip_select) return level ? 4 : 0;
  return clock ? (level ? 3 : 1) : 2;
}

}  // namespace

Result<std::unique_ptr<BusDecoders>> BusDecoders::make(const std::vector<std::string>& channels,
                                                       const BoardNames& names) {
  auto made = std::make_unique<BusDecoders>();
  made->roles_.resize(channels.size());
  made->numbers_.resize(channels.size(), -1);
  for (std::size_t wire = 0; wire < channels.size(); ++wire) {
    made->roles_[wire] = channel_name(channels[wire]);
    if (!made->roles_[wire]) continue;
    const auto joined =
        made->join(static_cast<int>(wire), *made->roles_[wire], channels[wire], names);
    if (!joined) return joined.error();
  }
  if (const auto whole = made->check_whole(); !whole) return whole.error();
  made->make_decoders();
  return made;
}

Result<Done> BusDecoders::join(int wire, const ChannelName& name, const std::string& channel,
                               const BoardNames& names) {
  int& number = numbers_[static_cast<std::size_t>(wire)];
  switch (name.role) {
    case Role::scl:
      i2c_[name.bus].scl = wire;
      break;
    case Role::sda:
      i2c_[name.bus].sda = wire;
      break;
    case Role::sck:
      spi_[name.bus].sck = wire;
      break;
    case Role::mosi:
      spi_[name.bus].mosi = wire;
      break;
    case Role::miso:
      spi_[name.bus].miso = wire;
      break;
    case Role::chip_select:
    case Role::ready:
      number = place_in(names.devices, name.thing);
      if (number < 0) return wrong(channel, "the board has no device '" + name.thing + "'");
      if (name.role == Role::ready) break;
      spi_[name.bus].selects.push_back({wire, number, nullptr});
      break;
    case Role::pin:
      number = place_in(names.pins, name.thing);
      if (number < 0) return wrong(channel, "the board file names no pin '" + name.thing + "'");
      break;
    case Role::tx:
    case Role::rx:
      if (const auto baud = names.bauds.find(name.bus); baud != names.bauds.end()) {
        const auto uart = static_cast<std::uint16_t>(name.bus);
        const bool sent = name.role == Role::tx;  // what the board hears is nobody's message
        uarts_.push_back(
            {wire,
             std::make_unique<UartDecoder>(
                 baud->second,
                 [this, uart, sent](const UartByte& b) {
                   if (!sent) return;
                   out_->add(io::Kind::uart_received, uart, b.stop_ns, &b.byte, 1);
                 },
                 [this, channel](const Unread& what) { add_unread(channel, false, -1, what); })});
      }
      break;
    case Role::marker:
      break;
  }
  return Done{};
}

// A bus of which a wire is missing would be read as silent.
Result<Done> BusDecoders::check_whole() const {
  for (const auto& [number, wires] : i2c_) {
    if (wires.scl >= 0 && wires.sda >= 0) continue;
    const std::string bus = "i2c" + std::to_string(number);
    return wrong(bus, "has one wire of two in the capture",
                 "name " + bus + "_scl and " + bus + "_sda");
  }
  for (const auto& [number, wires] : spi_) {
    if (wires.sck >= 0 && wires.mosi >= 0 && wires.miso >= 0 && !wires.selects.empty()) continue;
    const std::string bus = "spi" + std::to_string(number);
    return wrong(bus, "has not all of its wires in the capture",
                 "name " + bus + "_sck, _mosi, _miso and _cs_DEVICE");
  }
  return Done{};
}

void BusDecoders::make_decoders() {
  for (auto& [bus, wires] : i2c_) {
    const int number = bus;
    wires.decoder = std::make_unique<I2cDecoder>(
        [this, number](const I2cFrame& f) {
          io::BusTransaction head;
          head.start_ns = f.start_ns;
          head.address = f.address;
          head.read = f.read ? 1 : 0;
          head.acked = f.acked ? 1 : 0;
          head.length = static_cast<std::uint32_t>(f.bytes.size());
          add_frame(io::Kind::i2c_transaction, number, head, f.stop_ns, f.bytes, f.passed_ns,
                    *out_);
        },
        [this, number](const Unread& what) {
          add_unread("i2c" + std::to_string(number), false, number, what);
        });
  }
  for (auto& [bus, wires] : spi_) {
    for (SpiWires::Select& select : wires.selects) {
      const int number = bus, device = select.device;
      select.decoder = std::make_unique<SpiDecoder>(
          [this, number, device](const SpiFrame& f) {
            io::BusTransaction head;
            head.start_ns = f.start_ns;
            head.address = static_cast<std::uint16_t>(device);
            head.length = static_cast<std::uint32_t>(f.passed_ns.size());
            const std::size_t kept = std::min(kKept_pairs, f.passed_ns.size());
            add_frame(io::Kind::spi_transaction, number, head, f.stop_ns,
                      std::span(f.pairs).first(2 * kept), std::span(f.passed_ns).first(kept),
                      *out_);
          },
          [this, number](const Unread& what) {
            add_unread("spi" + std::to_string(number), true, number, what);
          });
    }
  }
}

void BusDecoders::add_unread(const std::string& bus, bool spi, int number, const Unread& what) {
  ++unread_count_;
  if (number >= 0) {
    const io::BusUnread gap{what.start_ns, static_cast<std::uint8_t>(spi ? 1 : 0), {}};
    out_->add(io::Kind::bus_unread, static_cast<std::uint16_t>(number), what.stop_ns, gap,
              what.why.data(), static_cast<std::uint32_t>(what.why.size()));
  }
  const std::string text = bus + '\0' + "a frame cannot be read: " + what.why;
  out_->add(io::Kind::finding, 0, what.stop_ns, text.data(),
            static_cast<std::uint32_t>(text.size()));
}

void BusDecoders::on_edge(const Edge& edge, io::Batch& out) {
  out_ = &out;
  if (!instant_.empty() && instant_.front().t_ns != edge.t_ns) settle();
  instant_.push_back(edge);
}

void BusDecoders::advance_to(std::int64_t t_ns, io::Batch& out) {
  out_ = &out;
  settle();
  for (const UartWire& uart : uarts_) uart.decoder->advance_to(t_ns);
}

void BusDecoders::settle() {
  if (instant_.size() > 1) {
    std::stable_sort(instant_.begin(), instant_.end(), [this](const Edge& a, const Edge& b) {
      return order(roles_[a.wire], a.level) < order(roles_[b.wire], b.level);
    });
  }
  for (const Edge& edge : instant_) route(edge);
  instant_.clear();
}

void BusDecoders::route(const Edge& edge) {
  const auto& name = roles_[edge.wire];
  if (!name) return;
  const auto number = static_cast<std::uint16_t>(std::max(0, numbers_[edge.wire]));
  switch (name->role) {
    case Role::scl:
      return i2c_[name->bus].decoder->scl(edge.level, edge.t_ns);
    case Role::sda:
      return i2c_[name->bus].decoder->sda(edge.level, edge.t_ns);
    case Role::sck:
      for (auto& s : spi_[name->bus].selects) s.decoder->sck(edge.level, edge.t_ns);
      return;
    case Role::mosi:
      for (auto& s : spi_[name->bus].selects) s.decoder->mosi(edge.level);
      return;
    case Role::miso:
      for (auto& s : spi_[name->bus].selects) s.decoder->miso(edge.level);
      return;
    case Role::chip_select:
      for (auto& s : spi_[name->bus].selects) {
        if (s.wire == edge.wire) s.decoder->select(edge.level, edge.t_ns);
      }
      return;
    case Role::tx:
    case Role::rx:
      for (const UartWire& uart : uarts_) {
        if (uart.wire == edge.wire) uart.decoder->line(edge.level, edge.t_ns);
      }
      return;
    case Role::ready:
      if (edge.level) out_->add(io::Kind::data_ready, number, edge.t_ns, nullptr, 0);
      return;
    case Role::pin: {
      const io::PinEdge level{static_cast<std::uint8_t>(edge.level ? 1 : 0), {}};
      out_->add(io::Kind::pin_edge, number, edge.t_ns, level);
      return;
    }
    case Role::marker:
      if (edge.level) marker_ns_.push_back(edge.t_ns);
      return;
  }
}

std::vector<std::string> BusDecoders::buses() const {
  std::vector<std::string> all;
  for (const auto& [number, wires] : i2c_) all.push_back("i2c" + std::to_string(number));
  for (const auto& [number, wires] : spi_) all.push_back("spi" + std::to_string(number));
  return all;
}

}  // namespace whirl::copper
