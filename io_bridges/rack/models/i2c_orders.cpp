#include "io_bridges/rack/models/i2c_orders.hpp"

#include <algorithm>

namespace whirl::rack {
namespace {

constexpr io::Nanoseconds kTooLate_ns = 10'000'000;

}  // namespace

I2cOrders::I2cOrders(io::EventQueue& events, io::I2cBus& bus, double rate_Hz, std::uint16_t port,
                     io::Batch& happened)
    : events_(events),
      master_(events, bus, rate_Hz),
      due_(events, [this] { next(); }),
      port_(port),
      happened_(happened) {}

void I2cOrders::add(const io::I2cOrder& order, std::span<const std::uint8_t> bytes,
                    io::Nanoseconds t_ns) {
  waiting_.push_back({t_ns,
                      order.number,
                      {.address = static_cast<std::uint8_t>(order.address),
                       .write = {bytes.begin(), bytes.end()},
                       .read = order.read}});
  if (!due_.pending() && !master_.busy()) due_.at(waiting_.front().t_ns);
}

void I2cOrders::next() {
  if (master_.busy()) return;
  io::I2cReply expired;
  expired.timed_out = true;
  while (!waiting_.empty() && events_.now() - waiting_.front().t_ns > kTooLate_ns) {
    report(waiting_.front().number, expired);
    waiting_.pop_front();
  }
  if (waiting_.empty()) return;
  if (waiting_.front().t_ns > events_.now()) return due_.at(waiting_.front().t_ns);
  const std::uint32_t number = waiting_.front().number;
  io::I2cRequest request = std::move(waiting_.front().request);
  waiting_.pop_front();
  master_.transfer(std::move(request),
                   [this, number](const io::I2cReply& reply) { done(number, reply); });
}

void I2cOrders::done(std::uint32_t number, const io::I2cReply& reply) {
  report(number, reply);
  if (!waiting_.empty()) due_.at(std::max(waiting_.front().t_ns, events_.now()));
}

void I2cOrders::report(std::uint32_t number, const io::I2cReply& reply) {
  io::I2cReplyHead head;
  head.number = number;
  head.acked = reply.acked ? 1 : 0;
  head.timed_out = reply.timed_out ? 1 : 0;
  head.stretched_ns = reply.stretched_ns;
  happened_.add(io::Kind::i2c_reply, port_, events_.now(), head, reply.bytes.data(),
                static_cast<std::uint32_t>(reply.bytes.size()));
}

}  // namespace whirl::rack
