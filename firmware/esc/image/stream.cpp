#include "firmware/esc/image/stream.hpp"

#include <atomic>

#include "firmware/esc/image/serial.hpp"

namespace fw::esc::stream {
namespace {

constexpr float kTicks_Hz = 1000.0f;

struct State {
  std::atomic<std::uint32_t> every = 0;  // ticks; 0: off
  std::uint32_t since = 0;
  std::uint8_t next = 0;           // sequence
  std::uint8_t sequence = 0;       // of the sample
  std::atomic<bool> full = false;  // the sample waits for the main loop
  StreamSample sample{};
};
constinit State state;

}  // namespace

bool set_rate(float rate_Hz) {
  if (!(rate_Hz >= 0.0f && rate_Hz <= kTicks_Hz)) return false;
  state.every = rate_Hz > 0.0f ? static_cast<std::uint32_t>(kTicks_Hz / rate_Hz + 0.5f) : 0u;
  return true;
}

bool due() {
  if (state.every == 0 || ++state.since < state.every) return false;
  state.since = 0;
  return true;
}

void record(const StreamSample& sample) {
  const std::uint8_t sequence = state.next++;
  if (state.full) return;
  state.sample = sample;
  state.sequence = sequence;
  state.full = true;
}

void send() {
  if (!state.full) return;
  const StreamFrame frame = pack(state.sample, state.sequence);
  state.full = false;
  serial::put({frame.data(), frame.size()});  // no room: lost, the sequence tells
}

}  // namespace fw::esc::stream
