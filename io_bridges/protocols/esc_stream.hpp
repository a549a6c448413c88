// What comes out of the ESC's serial line: lines of text, and binary frames of its internal signals.
//
//   Frame    70 bytes: A5 5A, version 1, sequence (u8), tick (u32 LE), 14 floats LE in the order of
//            EscSample, solver status, iterations, flags, mode, CRC-16/MCRF4XX over version..mode
//   Text     printable ASCII up to CR or LF, whole between frames; a line with any other byte, or with a
//            frame inside, is dropped
//   Lost     bytes: the decoder looks for the next sync inside what it held, so that no good frame
//            behind a torn one is lost. Frames: counted by the gaps of the sequence (up to 255 each)
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace whirl::io {

enum class EscSolver : std::uint8_t { converged, not_observable, out_of_model, no_convergence };

struct EscSample {
  std::uint8_t sequence = 0;
  std::uint32_t tick = 0;  // control ticks of 1 ms since power-up
  float bus_voltage_V = 0;
  float raw_current_A = 0;   // of the bus, mean of the tick, before zero, gain and offset
  float zero_current_A = 0;  // found at rest, taken off
  float bus_current_A = 0;   // calibrated, mean of the tick
  float winding_current_A = 0;
  float duty = 0;
  float speed_radps = 0;
  float wanted_speed_radps = 0;
  float acceleration_radps2 = 0;
  float power_W = 0;  // aerodynamic
  float CP = 0, CT = 0;
  float thrust_N = 0;
  float inflow_ratio = 0;  // valid if converged
  EscSolver solver = EscSolver::out_of_model;
  std::uint8_t iterations = 0;
  std::uint8_t flags = 0;
  std::uint8_t mode = 0;
};

class EscStreamDecoder {
 public:
  struct Counts {
    std::uint64_t frames = 0;
    std::uint64_t lost_frames = 0;
    std::uint64_t bad_crc = 0;  // frames, or bytes that looked like the begin of one
    std::uint64_t lines = 0;
    std::uint64_t dropped_lines = 0;
  };

  static constexpr std::size_t kFrameSize = 70;

  void on_sample(std::function<void(const EscSample&)> sink) { sample_sink_ = std::move(sink); }
  void on_line(std::function<void(const std::string&)> sink) { line_sink_ = std::move(sink); }
  void decode(std::span<const std::uint8_t> bytes);
  const Counts& counts() const { return counts_; }

 private:
  std::size_t step(std::span<const std::uint8_t> held);
  void take_text(std::uint8_t byte);
  void drop_line();
  void take_frame(std::span<const std::uint8_t> frame);

  std::function<void(const EscSample&)> sample_sink_;
  std::function<void(const std::string&)> line_sink_;
  std::vector<std::uint8_t> held_;  // the begin of a frame
  std::string line_;
  bool spoilt_ = false;  // the running line
  bool first_ = true;
  std::uint8_t next_sequence_ = 0;
  Counts counts_;
};

}  // namespace whirl::io
