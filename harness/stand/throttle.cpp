#include "harness/stand/throttle.hpp"

#include <algorithm>

namespace whirl::stand {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kRead_every_ns = 50 * kMs;
constexpr std::size_t kStatusBytes = 6;
constexpr std::int64_t kBoot_ns = 100 * kMs;  // nobody answers before

}  // namespace

void Throttle::order(std::int64_t t_ns, std::uint16_t read, const void* bytes, std::uint32_t size,
                     io::Batch& sensed) {
  const io::I2cOrder order{address_, read, sent_++};
  sensed.add(io::Kind::i2c_order, bus_, t_ns, order, bytes, size);
}

void Throttle::set_rate(double writes_Hz) {
  write_every_ns_ = std::llround(1e9 / writes_Hz);
}

void Throttle::send(std::int64_t t_ns, io::Batch& sensed) {
  if (t_ns < kBoot_ns) return;
  const std::int64_t every = write_every_ns_;
  const std::int64_t until = silent_ || !writes_ ? t_ns : t_ns + kMs;
  for (std::int64_t at = (t_ns + every - 1) / every * every; at < until; at += every) {
    const auto bytes = io::pack_setpoint(address_, v_);
    order(at, 0, bytes.data(), bytes.size(), sensed);
  }
  send_next_raw(t_ns, sensed);
  // Half a millisecond beside the writes.
  if (t_ns % kRead_every_ns == 0) order(t_ns + kMs / 2, 6, nullptr, 0, sensed);
}

void Throttle::send_next_raw(std::int64_t t_ns, io::Batch& sensed) {
  if (raw_.empty() || t_ns < raw_.front().next_ns) return;
  Raw& raw = raw_.front();
  raw_numbers_.push_back(sent_);
  order(t_ns + raw.offset_ns, raw.read, raw.write.data(),
        static_cast<std::uint32_t>(raw.write.size()), sensed);
  raw.next_ns = t_ns + raw.every_ns;
  raw.offset_ns = (raw.offset_ns + raw.shift_ns) % kMs;
  if (--raw.times <= 0) raw_.pop_front();
}

void Throttle::take_raw(const io::I2cReplyHead& head, std::span<const std::uint8_t> bytes) {
  ++raw_reported_.replies;
  if (head.acked != 0 && head.timed_out == 0) ++raw_reported_.acked;
  if (bytes.empty()) return;
  raw_reported_.read_bytes = static_cast<double>(bytes.size());
  raw_reported_.read_good = std::nan("");
  if (bytes.size() < kStatusBytes) return;
  const auto rest = bytes.subspan(kStatusBytes);
  const bool filled = std::all_of(rest.begin(), rest.end(), [](auto b) { return b == 0xFF; });
  const bool good = io::unpack_status(address_, bytes.first(kStatusBytes)).has_value();
  raw_reported_.read_good = filled && good ? 1.0 : 0.0;
}

void Throttle::on_message(const io::Reader& message) {
  if (message.header().port != bus_) return;
  const auto head = message.as<io::I2cReplyHead>();
  const auto bytes = message.tail_after(sizeof head);
  const std::int64_t step = message.header().t_ns / kMs;
  const double stretched_s = static_cast<double>(head.stretched_ns) * 1e-9;
  reported_.stretched_s =
      step == reported_step_ ? std::max(reported_.stretched_s, stretched_s) : stretched_s;
  reported_step_ = step;
  if (!raw_numbers_.empty() && raw_numbers_.front() == head.number) {
    raw_numbers_.pop_front();
    return take_raw(head, bytes);
  }
  ++reported_.replies;
  if (head.acked == 0 || head.timed_out != 0) {
    ++reported_.refused;
    return;
  }
  if (bytes.empty()) {
    if (head.number >= first_ && on_wire_ns_ < 0) on_wire_ns_ = message.header().t_ns;
    return;
  }
  const auto status = io::unpack_status(address_, bytes);
  if (!status) {
    ++reported_.refused;
    return;
  }
  reported_.current_A = status->bus_current_A;
  reported_.speed_rpm = status->speed_rpm;
  reported_.flags = status->flags;
}

}  // namespace whirl::stand
