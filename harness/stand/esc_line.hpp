// The stand's end of the ESC's serial line: lines to it, answers and the stream of signals from it.
//
//   Signals  esc_...: what the control core believes, from the latest frame of `stream HZ`; NaN before
//            the first and once it is older than 100 ms, or three periods of a slow stream
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/world/world.hpp"
#include "io_bridges/protocols/esc_stream.hpp"

namespace whirl::stand {

class EscLine {
 public:
  explicit EscLine(std::uint16_t port);
  EscLine(const EscLine&) = delete;
  EscLine& operator=(const EscLine&) = delete;

  void say(const std::string& line);
  // A line whose first line of answer is waited for. Refused while one before it, however it was said, is
  // not answered: the protocol names no question in its answers.
  Result<Done> ask(const std::string& line);
  // In order; no echoes, and nothing that came between a line's say() and its sending.
  const std::vector<std::string>& heard() const { return heard_; }
  void send(std::int64_t t_ns, io::Batch& sensed);
  void on_message(const io::Reader& message);  // ignores other ports

  struct Named {
    Signal signal;
    std::function<double()> value;
  };
  std::vector<Named> signals() const;

 private:
  using Field = double (*)(const io::EscSample&);
  double value(Field field) const;
  void hear(const std::string& line);

  std::uint16_t port_;
  std::string to_send_;
  io::EscStreamDecoder decoder_;
  std::vector<std::string> heard_;
  std::string echo_;  // the line that a terminal which echoes would send back next; empty: none
  std::vector<std::string> open_;  // lines of which nothing has been heard yet
  std::optional<io::EscSample> sample_;
  std::int64_t sample_ns_ = 0, period_ns_ = 0, now_ns_ = 0;
};

}  // namespace whirl::stand
