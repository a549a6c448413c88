#include "harness/target/bench/mavlink_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "harness/target/bench/mavlink_line.hpp"
#include "harness/target/bench/spread.hpp"
#include "io_bridges/protocols/mavlink_messages.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kTurn_ns = 1'000'000;

double ms(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-6;
}

class MavlinkCheck {
 public:
  MavlinkCheck(const MavlinkCheckOptions& options, pacing::HostClock& clock)
      : options_(options),
        clock_(clock),
        line_(options.link),
        parser_([this](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
          on_frame(frame);
        }) {}

  Result<std::vector<std::string>> all() {
    if (const auto opened = line_.open(); !opened) return opened.error();
    const auto listening_ns = static_cast<std::int64_t>(options_.seconds * 1e9);
    if (const auto heard = listen(listening_ns, [] { return false; }); !heard) {
      return heard.error();
    }
    if (const auto there = somebody(); !there) return there.error();
    std::vector<std::string> lines{what_comes(), heartbeat()};
    for (int i = 0; i < options_.requests; ++i) {
      if (const auto asked = ask(); !asked) return asked.error();
    }
    lines.push_back(answers());
    return lines;
  }

 private:
  Result<Done> listen(std::int64_t for_ns, const std::function<bool()>& done) {
    const std::int64_t end_ns = clock_.now_ns() + for_ns;
    while (clock_.now_ns() < end_ns && !done()) {
      Arrivals arrivals;
      if (const auto served = line_.serve(clock_.now_ns(), arrivals); !served) {
        return served.error();
      }
      heard_host_ns_ = clock_.now_ns();
      for (const Arrival& arrival : arrivals) {
        if (arrival.kind != io::Kind::uart_received) continue;
        for (const std::uint8_t byte : arrival.payload) parser_.add(byte);
      }
      pollfd file{line_.file(), POLLIN, 0};
      if (!done()) clock_.wait_for({&file, 1}, std::min(end_ns, heard_host_ns_ + kTurn_ns));
    }
    return Done{};
  }

  void on_frame(const io::MavlinkFrame& frame) {
    if (const auto beat = io::unpack<io::Heartbeat>(frame)) on_beat(frame, *beat);
    const auto sync = io::unpack<io::Timesync>(frame);
    if (sync && sync->tc1 != 0 && sync->ts1 == asked_host_ns_) answered_ = true;
  }

  // Of the first autopilot: who else is on a radio's air, a ground station or a gimbal, says that it is none.
  void on_beat(const io::MavlinkFrame& frame, const io::Heartbeat& beat) {
    constexpr std::uint8_t kMav_autopilot_invalid = 8;
    if (beat.autopilot == kMav_autopilot_invalid) return;
    if (!sender_) sender_ = frame;
    if (frame.sysid != sender_->sysid || frame.compid != sender_->compid) return;
    beats_host_ns_.push_back(heard_host_ns_);
  }

  Result<Done> somebody() const {
    const MavlinkLine::Counts counts = line_.counts();
    char within[40];
    std::snprintf(within, sizeof within, " in %g s", options_.seconds);
    const auto refused = [&](const std::string& what, const std::string& cure) {
      return Error{ErrorKind::bad_input, options_.link.path, what + within, cure};
    };
    if (counts.bytes == 0) {
      return refused("says nothing", "is the board on, its TX on this RX, a radio paired?");
    }
    if (counts.frames == 0) return line_.no_frames(within);
    if (!sender_) return refused("sends no HEARTBEAT of an autopilot", "is one behind it?");
    return Done{};
  }

  std::string what_comes() const {
    const MavlinkLine::Counts counts = line_.counts();
    char text[200];
    std::snprintf(text, sizeof text,
                  "MAVLink of %d/%d at %d baud: %.1f frames and %.0f B a second; %llu missing by "
                  "their numbers, %llu B outside of frames",
                  sender_->sysid, sender_->compid, options_.link.baud,
                  static_cast<double>(counts.frames) / options_.seconds,
                  static_cast<double>(counts.bytes) / options_.seconds,
                  static_cast<unsigned long long>(counts.missing),
                  static_cast<unsigned long long>(counts.outside_B));
    return text;
  }

  std::string heartbeat() const {
    std::vector<double> periods_ms;
    for (std::size_t i = 1; i < beats_host_ns_.size(); ++i) {
      periods_ms.push_back(ms(beats_host_ns_[i] - beats_host_ns_[i - 1]));
    }
    const std::string heard = "HEARTBEAT heard " + std::to_string(beats_host_ns_.size()) + " times";
    if (periods_ms.empty()) return heard + ": no period";
    const double p50_ms = spread_of(periods_ms).p50_ms;
    double off_ms = 0.0;
    for (const double period_ms : periods_ms)
      off_ms = std::max(off_ms, std::abs(period_ms - p50_ms));
    char text[100];
    std::snprintf(text, sizeof text, ", period %.1f ms, %.1f ms off it at most", p50_ms, off_ms);
    return heard + text;
  }

  Result<Done> ask() {
    answered_ = false;
    asked_host_ns_ = clock_.now_ns();
    const auto frame = io::encode(io::pack(io::Timesync{.ts1 = asked_host_ns_,
                                                        .target_system = sender_->sysid,
                                                        .target_component = sender_->compid},
                                           ours_));
    io::Batch order;
    order.add(io::Kind::uart_frame, options_.link.uart, 0, frame.data(),
              static_cast<std::uint32_t>(frame.size()));
    io::Reader reader(order.bytes());
    reader.next();
    line_.take(reader, asked_host_ns_);
    const auto limit_ns = static_cast<std::int64_t>(options_.answer_s * 1e9);
    const auto heard = listen(limit_ns, [this] { return answered_; });
    if (heard && answered_) took_ms_.push_back(ms(heard_host_ns_ - asked_host_ns_));
    return heard;
  }

  std::string answers() const {
    std::string text = "TIMESYNC answered " + std::to_string(took_ms_.size()) + " of " +
                       std::to_string(options_.requests) + " times";
    if (took_ms_.empty()) return text + ": what is sent there may not arrive, or it knows none";
    const Spread s = spread_of(took_ms_);
    char took[100];
    std::snprintf(took, sizeof took, "; both ways p50 %.1f, p99 %.1f, most %.1f ms", s.p50_ms,
                  s.p99_ms, s.most_ms);
    return text + took;
  }

  MavlinkCheckOptions options_;
  pacing::HostClock& clock_;
  MavlinkLine line_;
  io::MavlinkParser parser_;
  io::MavlinkSender ours_;
  std::optional<io::MavlinkFrame> sender_;  // of the first HEARTBEAT
  std::vector<std::int64_t> beats_host_ns_;
  std::vector<double> took_ms_;
  std::int64_t heard_host_ns_ = 0, asked_host_ns_ = 0;
  bool answered_ = false;
};

}  // namespace

Result<std::vector<std::string>> check_mavlink(const MavlinkCheckOptions& options,
                                               pacing::HostClock& clock) {
  return MavlinkCheck(options, clock).all();
}

}  // namespace whirl::bench
