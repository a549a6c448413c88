#include "io_bridges/copper/wire_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace whirl::copper {
namespace {

constexpr int kI2c_clocks = 9, kSpi_clocks = 8, kUart_bits = 10;

// Of the closest two bytes, and not more than what fits between start and the first one.
double clock_ns(const std::vector<std::int64_t>& passed_ns, int clocks, double most_ns) {
  double least = most_ns;
  for (std::size_t i = 1; i < passed_ns.size(); ++i) {
    least = std::min(least, static_cast<double>(passed_ns[i] - passed_ns[i - 1]) / clocks);
  }
  return std::max(least, 2.0);
}

std::int64_t ns(double t) {
  return std::llround(t);
}

}  // namespace

Transfer transfer_of(const io::Reader& message) {
  const auto head = message.as<io::BusTransaction>();
  Transfer t{head.start_ns, message.header().t_ns, head.address, head.read != 0, head.acked != 0};
  const auto bytes = message.transferred();
  t.bytes.assign(bytes.begin(), bytes.end());
  const auto times = message.tail_after(sizeof head).subspan(bytes.size());
  const std::size_t per_time = message.header().kind == io::Kind::spi_transaction ? 2 : 1;
  const std::size_t count = std::min(times.size() / sizeof(std::uint32_t), bytes.size() / per_time);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t passed = 0;
    std::memcpy(&passed, times.data() + i * sizeof passed, sizeof passed);
    if (passed == io::kLate) break;
    t.passed_ns.push_back(head.start_ns + passed);
  }
  t.bytes.resize(t.passed_ns.size() * per_time);
  return t;
}

void I2cDrawing::end(bool repeated, std::vector<Edge>& edges) {
  if (!ending_) return;
  const std::int64_t last = ending_->last_ns, stop = ending_->stop_ns;
  const std::int64_t third = std::max<std::int64_t>(1, (stop - last) / 3);
  edges.push_back({last + third, sda_, repeated});
  edges.push_back({last + 2 * third, scl_, true});
  if (!repeated)
    edges.push_back({stop, sda_, true});  // the fall of a repeated START is drawn as START
  ending_.reset();
}

void I2cDrawing::settle(std::vector<Edge>& edges) {
  end(false, edges);
}

void I2cDrawing::add(const Transfer& t, std::vector<Edge>& edges) {
  end(ending_ && ending_->stop_ns == t.start_ns, edges);
  const std::size_t bytes = t.passed_ns.size();
  const std::int64_t first_ns = bytes > 0 ? t.passed_ns.front() : t.stop_ns;
  // START, nine clocks of address, nine of the first byte; without one, the STOP behind the address.
  const double most = static_cast<double>(first_ns - t.start_ns) / (bytes > 0 ? 18.75 : 10.5);
  const double clock = clock_ns(t.passed_ns, kI2c_clocks, most);
  edges.push_back({t.start_ns, sda_, false});
  std::int64_t fall_ns = t.start_ns;
  const auto byte = [&](std::uint8_t value, bool nack, double end_ns) {
    const double begin_ns = end_ns - kI2c_clocks * clock;
    const auto begins = std::max(ns(begin_ns), fall_ns + 1);
    if (fall_ns == t.start_ns) edges.push_back({begins, scl_, false});
    for (int bit = 0; bit < kI2c_clocks; ++bit) {
      const double at = begin_ns + bit * clock;
      const bool high = bit == 8 ? nack : (value >> (7 - bit) & 1) != 0;
      edges.push_back({ns(at + clock * 0.25), sda_, high});
      edges.push_back({ns(at + clock * 0.5), scl_, true});
      edges.push_back({ns(at + clock), scl_, false});
    }
    fall_ns = ns(end_ns);
  };
  const double address_end = bytes > 0 ? static_cast<double>(first_ns) - kI2c_clocks * clock
                                       : static_cast<double>(first_ns) - clock;
  byte(static_cast<std::uint8_t>(t.address << 1 | (t.read ? 1 : 0)), !t.acked && bytes == 0,
       address_end);
  for (std::size_t i = 0; i < bytes; ++i) {
    const bool last = i + 1 == bytes;
    const bool nack = last && (t.read || !t.acked);
    byte(t.bytes[i], nack, static_cast<double>(t.passed_ns[i]));
  }
  ending_ = Ending{fall_ns, t.stop_ns};
}

void draw_spi(const Transfer& t, const SpiWireNumbers& wires, std::vector<Edge>& edges) {
  edges.push_back({t.start_ns, wires.select, false});
  const std::size_t pairs = t.passed_ns.size();
  const double most =
      pairs > 0 ? static_cast<double>(t.passed_ns.front() - t.start_ns) / kSpi_clocks : 0.0;
  const double clock = clock_ns(t.passed_ns, kSpi_clocks, most);
  for (std::size_t i = 0; i < pairs; ++i) {
    const double begin_ns = static_cast<double>(t.passed_ns[i]) - kSpi_clocks * clock;
    for (int bit = 0; bit < kSpi_clocks; ++bit) {
      const double at = begin_ns + bit * clock;
      edges.push_back({ns(at), wires.mosi, (t.bytes[2 * i] >> (7 - bit) & 1) != 0});
      edges.push_back({ns(at), wires.miso, (t.bytes[2 * i + 1] >> (7 - bit) & 1) != 0});
      edges.push_back({ns(at + clock * 0.5), wires.sck, true});
      edges.push_back({ns(at + clock), wires.sck, false});
    }
  }
  edges.push_back({t.stop_ns, wires.select, true});
}

std::int64_t draw_uart(std::span<const std::uint8_t> bytes, std::int64_t last_stop_ns,
                       double baud_Hz, std::uint16_t wire, std::int64_t after_ns,
                       std::vector<Edge>& edges) {
  const double bit = 1e9 / baud_Hz;
  double at = std::max(
      static_cast<double>(last_stop_ns) - bit * kUart_bits * static_cast<double>(bytes.size()),
      static_cast<double>(after_ns));
  for (const std::uint8_t byte : bytes) {
    const std::uint32_t bits = std::uint32_t{byte} << 1 | 1u << 9;
    for (int i = 0; i < kUart_bits; ++i) {
      edges.push_back({ns(at + i * bit), wire, (bits >> i & 1) != 0});
    }
    at += kUart_bits * bit;
  }
  return ns(at);
}

}  // namespace whirl::copper
