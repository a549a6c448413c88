#include "harness/stand/throttle.hpp"

namespace whirl::stand {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWrite_every_ns = 20 * kMs, kRead_every_ns = 50 * kMs;
constexpr std::int64_t kBoot_ns = 100 * kMs;  // nobody answers before

}  // namespace

void Throttle::order(std::int64_t t_ns, std::uint16_t read, const void* bytes, std::uint32_t size,
                     io::Batch& sensed) {
  const io::I2cOrder order{address_, read, sent_++};
  sensed.add(io::Kind::i2c_order, bus_, t_ns, order, bytes, size);
}

void Throttle::send(std::int64_t t_ns, io::Batch& sensed) {
  if (t_ns < kBoot_ns) return;
  if (t_ns % kWrite_every_ns == 0 && !silent_) {
    const auto bytes = io::pack_setpoint(address_, v_);
    order(t_ns, 0, bytes.data(), bytes.size(), sensed);
  }
  // Half a millisecond beside the writes.
  if (t_ns % kRead_every_ns == 0) order(t_ns + kMs / 2, 6, nullptr, 0, sensed);
}

void Throttle::take(const io::Reader& message) {
  if (message.header().port != bus_) return;
  const auto head = message.as<io::I2cReplyHead>();
  const auto bytes = message.tail_after(sizeof head);
  ++told_.replies;
  if (head.acked == 0 || head.timed_out != 0) {
    ++told_.refused;
    return;
  }
  if (bytes.empty()) {
    if (head.number >= first_ && on_wire_ns_ < 0) on_wire_ns_ = message.header().t_ns;
    return;
  }
  const auto status = io::unpack_status(address_, bytes);
  if (!status) {
    ++told_.refused;
    return;
  }
  told_.current_A = status->bus_current_A;
  told_.speed_rpm = status->speed_rpm;
  told_.flags = status->flags;
}

}  // namespace whirl::stand
