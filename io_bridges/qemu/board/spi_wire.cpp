#include "io_bridges/qemu/board/spi_wire.hpp"

#include <cmath>
#include <utility>

#include "base/check.hpp"

namespace whirl::board {

using io::WireAct;
using io::WireAnswer;
using io::WireMessage;

namespace {

constexpr int kByte_bits = 8;
constexpr double kUntil_last_bit = 7.5;  // periods

}  // namespace

LeaderSpi::LeaderSpi(LeaderWire& wire, std::uint8_t port, std::string name, io::Wire* ready,
                     Nanoseconds latency_ns)
    : wire_(wire),
      port_(port),
      name_(std::move(name)),
      ready_(ready),
      latency_ns_(latency_ns),
      due_(wire.site().events, [this] { put_ready(); }),
      sampled_(wire.site().events,
               [this] {
                 const Nanoseconds now = wire_.site().events.now();
                 miso_ = wire_.ask({now, WireAct::spi_end, mosi_, 0, port_}).byte;
               }),
      findings_(wire.site().finding) {
  if (ready_ == nullptr) return;
  driver_ = ready_->add_driver(name_);
  wire_.hear_lines(latency_ns_);
}

void LeaderSpi::select(bool selected, Nanoseconds now) {
  wire_.post({now, WireAct::select, 0, static_cast<std::uint8_t>(selected ? 1 : 0), port_});
}

void LeaderSpi::begin(std::uint8_t mosi, std::uint32_t sck_Hz, int mode, Nanoseconds now) {
  begun_ = true;
  mosi_ = mosi;
  sampled_.at(now + std::llround(kUntil_last_bit * 1e9 / sck_Hz));
  wire_.post({now, WireAct::spi_begin, static_cast<std::uint8_t>(mode), 0, port_});
}

std::uint8_t LeaderSpi::transfer(std::uint8_t, std::uint32_t, int, Nanoseconds now) {
  if (std::exchange(begun_, false)) return miso_;
  findings_.report({now, name_,
                    "a frame of 16 bits, or one that was under way when it was selected, is not "
                    "carried to the other board"});
  return 0xFF;
}

void LeaderSpi::edge(const io::WireEdge& edge) {
  if (ready_ == nullptr) return;
  edges_.emplace_back(edge.t_ns + latency_ns_, edge.level != 0);
  if (!due_.pending()) due_.at(edges_.front().first);
}

void LeaderSpi::put_ready() {
  const Nanoseconds now = wire_.site().events.now();
  while (!edges_.empty() && edges_.front().first <= now) {
    ready_->drive(driver_, edges_.front().second ? io::Drive::high : io::Drive::low, now);
    edges_.pop_front();
  }
  if (!edges_.empty()) due_.at(edges_.front().first);
}

FollowerSpi::FollowerSpi(FollowerWire& wire, std::uint8_t port, std::string name,
                         io::SpiSlave& slave, io::Wire& select, io::Wire* ready)
    : name_(std::move(name)),
      slave_(slave),
      select_(select),
      driver_(select.add_driver("another board")),
      findings_(wire.site().finding) {
  const Nanoseconds now = wire.site().events.now();
  select_.drive(driver_, io::Drive::high, now);
  if (ready == nullptr) return;
  const auto tell = [&wire, port](bool level, Nanoseconds at) {
    wire.tell({.t_ns = at, .port = port, .level = static_cast<std::uint8_t>(level ? 1 : 0)});
  };
  tell(ready->level(), now);
  ready->watch(tell);
}

bool FollowerSpi::act(const WireMessage& message, Nanoseconds now) {
  switch (message.act) {
    case WireAct::select:
      select_.drive(driver_, message.flag != 0 ? io::Drive::low : io::Drive::high, now);
      return false;
    case WireAct::spi_begin:
      begin(message.byte, now);
      return false;
    case WireAct::spi_end:
      miso_ = in_step_ ? slave_.sampled(message.byte, kByte_bits, now) : 0xFF;
      return true;
    default:
      WHIRL_CHECK(false, static_cast<int>(message.act));
  }
  return false;
}

void FollowerSpi::begin(int mode, Nanoseconds now) {
  in_step_ = (mode & 1) != 0 && mode == slave_.mode();
  if (in_step_) {
    slave_.shift_out(now);
    return;
  }
  findings_.report({now, name_,
                    "is clocked in mode " + std::to_string(mode) + " and set to mode " +
                        std::to_string(slave_.mode()) +
                        ((mode & 1) == 0 ? "; CPHA 0 is not carried over the wire" : "")});
}

WireAnswer FollowerSpi::reply(WireAnswer::Clock, Nanoseconds) {
  WireAnswer answer;
  answer.byte = miso_;
  return answer;
}

}  // namespace whirl::board
