#include "harness/target/bench/line_check.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <string_view>

#include "harness/target/bench/spread.hpp"
#include "harness/target/bench/turn_of_bytes.hpp"
#include "io_bridges/devices/core/receiver.hpp"
#include "io_bridges/protocols/ubx.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kListen_ns = 1'000'000;
constexpr std::string_view kQuestion = "status\r\n";  // changes nothing at an ESC of ours

using Bytes = std::span<const std::uint8_t>;

class Listener {
 public:
  Listener(io::Tty tty, pacing::HostClock& clock) : tty_(std::move(tty)), clock_(clock) {}

  Result<Done> listen(
      double seconds, const std::function<void(Bytes)>& on_piece,
      const std::function<bool()>& done = [] { return false; }) {
    const std::int64_t end_ns = clock_.now_ns() + static_cast<std::int64_t>(seconds * 1e9);
    for (;;) {
      if (const auto flushed = tty_.flush(); !flushed) return flushed;
      const auto turned = read_turn(tty_, [&](Bytes piece) {
        bytes_ += piece.size();
        on_piece(piece);
      });
      if (!turned || clock_.now_ns() >= end_ns || done()) return turned;
      pollfd file{tty_.file(), POLLIN, 0};
      clock_.wait_for({&file, 1}, std::min(end_ns, clock_.now_ns() + kListen_ns));
    }
  }
  Result<Done> say(std::string_view text) {
    return tty_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  std::uint64_t bytes() const { return bytes_; }

 private:
  io::Tty tty_;
  pacing::HostClock& clock_;
  std::uint64_t bytes_ = 0;
};

std::string rate_text(std::uint64_t bytes, double seconds) {
  char text[80];
  std::snprintf(text, sizeof text, "%llu B in %g s, %.0f a second",
                static_cast<unsigned long long>(bytes), seconds,
                static_cast<double>(bytes) / seconds);
  return text;
}

std::string at(const LineCheckOptions& options, int baud, const char* frame) {
  return options.link.path + " at " + std::to_string(baud) + " baud " + frame;
}

// A flight controller that looks for its receiver asks on and on; one that has had its settings taken is silent.
Result<std::vector<std::string>> check_gps(const LineCheckOptions& options,
                                           pacing::HostClock& clock) {
  auto tty = io::Tty::open(options.link.path, options.gps_baud);
  if (!tty) return tty.error();
  Listener line(std::move(tty.value()), clock);
  std::uint64_t asked = 0;
  io::UbxParser parser([&](const io::UbxFrame&) { ++asked; });
  const auto heard = line.listen(options.seconds, [&](Bytes piece) {
    for (const std::uint8_t byte : piece) parser.add(byte);
  });
  if (!heard) return heard.error();
  const std::string where = at(options, options.gps_baud, "8N1, as the GPS starts: ");
  const std::string unknown =
      "; a receiver is asked and asks nothing: whether the flight controller hears it, and how "
      "soon it answers, cannot be known before a run";
  if (line.bytes() == 0) {
    return std::vector<std::string>{where + "nothing comes" + unknown};
  }
  const std::string seen = asked == 0
                               ? "no message of UBX among them: of another rate, or no GPS's line"
                               : std::to_string(asked) + " messages of UBX among them";
  return std::vector<std::string>{where + rate_text(line.bytes(), options.seconds) + ", " + seen +
                                  unknown};
}

Result<std::vector<std::string>> check_receiver(const LineCheckOptions& options,
                                                pacing::HostClock& clock) {
  constexpr int kBaud = static_cast<int>(core::receiver::kSbusBaud);
  auto tty = io::Tty::open(options.link.path, kBaud, io::TtyFrame::e82);
  if (!tty) return tty.error();
  Listener line(std::move(tty.value()), clock);
  if (const auto heard = line.listen(options.seconds, [](Bytes) {}); !heard) return heard.error();
  const std::string came = line.bytes() == 0 ? std::string("nothing comes, as it should be")
                                             : rate_text(line.bytes(), options.seconds) +
                                                   " come, where a receiver's line brings nothing";
  return std::vector<std::string>{at(options, kBaud, "8E2, SBUS: ") + came +
                                  "; one way: that the line is inverted and that anybody hears it "
                                  "cannot be known before a run"};
}

class CommandLine {
 public:
  CommandLine(const LineCheckOptions& options, io::Tty tty, pacing::HostClock& clock)
      : options_(options), clock_(clock), line_(std::move(tty), clock) {}

  Result<std::vector<std::string>> all() {
    const auto heard = line_.listen(options_.seconds, [](Bytes) {});
    if (!heard) return heard.error();
    const std::uint64_t unasked = line_.bytes();
    const std::string where = at(options_, options_.link.baud, "8N1: ");
    if (unasked > 0) {
      return std::vector<std::string>{
          where + rate_text(unasked, options_.seconds) +
          ", unasked: how soon a question is answered cannot be told from what it says anyway"};
    }
    for (int i = 0; i < options_.requests; ++i) {
      if (const auto asked = ask(); !asked) return asked.error();
      if (i == 2 && took_ms_.empty()) break;
    }
    if (took_ms_.empty()) {
      return Error{ErrorKind::bad_input, options_.link.path,
                   "says nothing, and does not answer \"status\"",
                   "is the board powered, its TX on this RX and its RX on this TX, the rate " +
                       std::to_string(options_.link.baud) +
                       " baud? Who has no command line leaves "
                       "the link out"};
    }
    const Spread s = spread_of(took_ms_);
    char text[160];
    std::snprintf(text, sizeof text,
                  "\"status\" answered %zu of %d times; to its first byte p50 %.2f, p99 %.2f, most "
                  "%.2f ms",
                  took_ms_.size(), options_.requests, s.p50_ms, s.p99_ms, s.most_ms);
    return std::vector<std::string>{where + text};
  }

 private:
  // Until its first byte; then its rest, which ends with the line.
  Result<Done> ask() {
    const std::int64_t asked_ns = clock_.now_ns();
    if (const auto said = line_.say(kQuestion); !said) return said;
    bool first = false, whole = false;
    std::int64_t came_ns = 0;
    const auto heard = line_.listen(
        options_.answer_s,
        [&](Bytes piece) {
          if (!first) came_ns = clock_.now_ns();
          first = true;
          whole |= std::find(piece.begin(), piece.end(), '\n') != piece.end();
        },
        [&] { return whole; });
    if (!heard) return heard;
    if (first) took_ms_.push_back(static_cast<double>(came_ns - asked_ns) * 1e-6);
    return Done{};
  }

  const LineCheckOptions& options_;
  pacing::HostClock& clock_;
  Listener line_;
  std::vector<double> took_ms_;
};

}  // namespace

Result<std::vector<std::string>> check_line(const LineCheckOptions& options,
                                            pacing::HostClock& clock) {
  if (options.end == LineEnd::gps) return check_gps(options, clock);
  if (options.end == LineEnd::receiver) return check_receiver(options, clock);
  auto tty = io::Tty::open(options.link.path, options.link.baud);
  if (!tty) return tty.error();
  return CommandLine(options, std::move(tty.value()), clock).all();
}

}  // namespace whirl::bench
