#include "io_bridges/protocols/esc_stream.hpp"

#include <bit>
#include <cstring>

#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kSync[] = {0xA5, 0x5A};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kLongest_line = 512;

class Fields {
 public:
  explicit Fields(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  std::uint8_t byte() { return word(1) & 0xFF; }
  std::uint32_t word(std::size_t size = 4) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(rest_[i]) << 8 * i;
    rest_ = rest_.subspan(size);
    return value;
  }
  float number() { return std::bit_cast<float>(word()); }

 private:
  std::span<const std::uint8_t> rest_;
};

EscSample unpack(std::span<const std::uint8_t> body) {
  Fields in(body);
  EscSample s;
  in.byte();  // version
  s.sequence = in.byte();
  s.tick = in.word();
  for (float* value :
       {&s.bus_voltage_V, &s.raw_current_A, &s.zero_current_A, &s.bus_current_A,
        &s.winding_current_A, &s.duty, &s.speed_radps, &s.wanted_speed_radps,
        &s.acceleration_radps2, &s.power_W, &s.CP, &s.CT, &s.thrust_N, &s.inflow_ratio}) {
    *value = in.number();
  }
  s.solver = static_cast<EscSolver>(in.byte());
  s.iterations = in.byte();
  s.flags = in.byte();
  s.mode = in.byte();
  return s;
}

}  // namespace

void EscStreamDecoder::decode(std::span<const std::uint8_t> bytes) {
  held_.insert(held_.end(), bytes.begin(), bytes.end());
  std::size_t used = 0;
  while (const std::size_t n = step(std::span(held_).subspan(used))) used += n;
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(used));
}

// How many bytes are dealt with; 0: more must come first.
std::size_t EscStreamDecoder::step(std::span<const std::uint8_t> held) {
  if (held.empty()) return 0;
  if (held[0] != kSync[0]) return take_text(held[0]), 1;
  if (held.size() == 1) return 0;
  if (held[1] != kSync[1]) return take_text(held[0]), 1;
  if (held.size() < kFrameSize) return 0;
  const auto body = held.subspan(sizeof kSync, kFrameSize - sizeof kSync - 2);
  const unsigned crc = held[kFrameSize - 2] | held[kFrameSize - 1] << 8;
  if (body[0] != kVersion || crc16(body) != crc) {
    ++counts_.bad_crc;
    return take_text(held[0]), 1;
  }
  take_frame(body);
  return kFrameSize;
}

void EscStreamDecoder::take_frame(std::span<const std::uint8_t> body) {
  const EscSample sample = unpack(body);
  if (spoilt_ || !line_.empty()) drop_line();  // lines come whole: this one was torn
  ++counts_.frames;
  if (!first_) counts_.lost_frames += static_cast<std::uint8_t>(sample.sequence - next_sequence_);
  first_ = false;
  next_sequence_ = static_cast<std::uint8_t>(sample.sequence + 1);
  if (sample_sink_) sample_sink_(sample);
}

void EscStreamDecoder::drop_line() {
  ++counts_.dropped_lines;
  line_.clear();
  spoilt_ = false;
}

void EscStreamDecoder::take_text(std::uint8_t byte) {
  if (byte == '\r' || byte == '\n') {
    if (spoilt_) return drop_line();
    if (line_.empty()) return;
    ++counts_.lines;
    if (line_sink_) line_sink_(line_);
    line_.clear();
  } else if (byte < 0x20 || byte > 0x7E || line_.size() >= kLongest_line) {
    spoilt_ = true;
  } else {
    line_.push_back(static_cast<char>(byte));
  }
}

}  // namespace whirl::io
