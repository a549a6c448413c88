#include "firmware/esc/image/stream_frame.hpp"

#include <bit>

#include "firmware/link/crc16.hpp"

namespace fw::esc {
namespace {

constexpr std::size_t kSync = 2;

class Writer {
 public:
  explicit Writer(StreamFrame& frame) : frame_(frame) {}
  void byte(std::uint32_t value) { frame_[n_++] = static_cast<char>(value & 0xFF); }
  void word(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) byte(value >> shift);
  }
  void number(float value) { word(std::bit_cast<std::uint32_t>(value)); }
  void crc() {
    std::uint16_t crc = kCrcStart;
    for (std::size_t i = kSync; i < n_; ++i) {
      crc = crc_add(crc, static_cast<std::uint8_t>(frame_[i]));
    }
    byte(crc);
    byte(crc >> 8);
  }

 private:
  StreamFrame& frame_;
  std::size_t n_ = 0;
};

}  // namespace

StreamFrame pack(const StreamSample& s, std::uint8_t sequence) {
  StreamFrame frame;
  Writer out(frame);
  out.byte(0xA5);
  out.byte(0x5A);
  out.byte(kStreamVersion);
  out.byte(sequence);
  out.word(s.tick);
  for (const float value :
       {s.bus_voltage_V, s.raw_current_A, s.zero_current_A, s.bus_current_A, s.winding_current_A,
        s.duty, s.speed_radps, s.wanted_speed_radps, s.acceleration_radps2, s.power_W, s.CP, s.CT,
        s.thrust_N, s.inflow_ratio}) {
    out.number(value);
  }
  for (const std::uint8_t value : {s.solver_status, s.iterations, s.flags, s.mode}) out.byte(value);
  out.crc();
  return frame;
}

}  // namespace fw::esc
