#include "io_bridges/devices/mavlink_link.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr double kBitsPerByte = 10.0;     // 8N1
constexpr double kBaudTolerance = 0.025;  // of a receiver that samples mid-bit, with margin

}  // namespace

MavlinkLink::MavlinkLink(EventQueue& queue, const Params& params, FindingSink findings)
    : queue_(queue),
      params_(params),
      findings_(std::move(findings)),
      parser_([this](const MavlinkFrame&, std::span<const std::uint8_t> raw) { frame_down(raw); }),
      up_loss_(params.seed, "mavlink.uplink"),
      down_loss_(params.seed, "mavlink.downlink"),
      frame_due_(queue, [this] { next_frame(); }),
      byte_due_(queue, [this] { next_byte(); }) {
  WHIRL_CHECK(params.baud > 0.0 && params.air_bytes_per_s > 0.0, params.baud);
}

void MavlinkLink::report(Nanoseconds now, std::string what) {
  if (findings_) findings_({now, "mavlink_link", std::move(what)});
}

void MavlinkLink::send_frame(std::span<const std::uint8_t> bytes, Nanoseconds t_ns) {
  if (bytes.empty()) return;
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [t_ns](const Waiting& w) { return w.t_ns > t_ns; });
  waiting_.insert(later, {t_ns, {bytes.begin(), bytes.end()}});
  frame_due_.at(waiting_.front().t_ns);
}

// Books the air for so many bytes. False: they would wait too long and are gone.
bool MavlinkLink::takes_air(std::size_t bytes, Nanoseconds now, const char* direction) {
  const Nanoseconds begin = std::max(now, air_free_ns_);
  if (begin - now > params_.buffer_ns) {
    if (counts_.overruns++ == 0) {
      report(now, std::string("radio overrun: a frame for the ") + direction +
                      "link found the half-duplex air taken and the buffer full (later ones are "
                      "counted only)");
    }
    return false;
  }
  const double air_s = static_cast<double>(bytes) / params_.air_bytes_per_s;
  counts_.air_busy_s += air_s;
  air_free_ns_ = begin + std::llround(air_s * 1e9);
  return true;
}

void MavlinkLink::next_frame() {
  const Nanoseconds now = queue_.now();
  while (!waiting_.empty() && waiting_.front().t_ns <= now) {
    std::vector<std::uint8_t> bytes = std::move(waiting_.front().bytes);
    waiting_.pop_front();
    if (!takes_air(bytes.size(), now, "up")) continue;
    ++counts_.up;
    if (up_loss_.uniform() < params_.uplink_loss) {
      ++counts_.up_lost;
      continue;
    }
    // The radio hands bytes on while they come in: the serial line starts when the air does.
    const Nanoseconds air_ns =
        std::llround(static_cast<double>(bytes.size()) / params_.air_bytes_per_s * 1e9);
    const bool idle = to_mcu_.empty();
    to_mcu_.push_back(std::move(bytes));
    if (idle) {
      byte_due_.at(std::max(now, air_free_ns_ - air_ns) +
                   std::llround(kBitsPerByte / params_.baud * 1e9));
    }
  }
  if (!waiting_.empty()) frame_due_.at(waiting_.front().t_ns);
}

void MavlinkLink::next_byte() {
  const std::uint8_t value = to_mcu_.front()[sent_];
  const bool last = ++sent_ == to_mcu_.front().size();
  std::vector<std::uint8_t> frame;
  if (last) {
    frame = std::move(to_mcu_.front());
    to_mcu_.pop_front();
    sent_ = 0;
  }
  if (!to_mcu_.empty()) byte_due_.in(std::llround(kBitsPerByte / params_.baud * 1e9));
  send({.value = value}, {.baud = params_.baud});
  if (last && delivered_) delivered_(frame, queue_.now());
}

void MavlinkLink::check_format(const UartFormat& format, Nanoseconds now) {
  const bool fits = std::abs(format.baud / params_.baud - 1.0) <= kBaudTolerance &&
                    format.data_bits == 8 && format.parity == 'N';
  if (fits || format_told_) return;
  format_told_ = true;
  report(now, "the MCU sends " + std::to_string(std::lround(format.baud)) + " baud, " +
                  std::to_string(format.data_bits) + " data bits, parity " + format.parity +
                  "; the radio listens at " + std::to_string(std::lround(params_.baud)) + " 8N1");
}

void MavlinkLink::receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) {
  check_format(format, now);
  heard_ns_ = now;
  const bool garbled = std::abs(format.baud / params_.baud - 1.0) > kBaudTolerance;
  parser_.add(garbled ? static_cast<std::uint8_t>(byte.value ^ 0x55) : byte.value);
  note_stray(now);
}

// Told once, when the first byte is known to belong to no frame.
void MavlinkLink::note_stray(Nanoseconds now) {
  if (parser_.counts().stray == 0 || stray_told_) return;
  stray_told_ = true;
  report(now, "bytes outside of MAVLink frames (later ones are counted only)");
}

void MavlinkLink::frame_down(std::span<const std::uint8_t> raw) {
  if (!takes_air(raw.size(), heard_ns_, "down")) return;
  ++counts_.down;
  if (down_loss_.uniform() < params_.downlink_loss) {
    ++counts_.down_lost;
    return;
  }
  if (sink_) sink_(raw, heard_ns_);
}

}  // namespace whirl::io
