#include "harness/target/bench/pod_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>
#include <optional>

#include "harness/target/bench/can_check.hpp"
#include "harness/target/bench/spread.hpp"
#include "harness/target/bench/turn_of_bytes.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;

constexpr double kSample_s = 1e-3, kLearns_s = 1.0;
constexpr std::int64_t kPod_turn_ns = 1'000'000;
constexpr std::array<std::int16_t, 7> kStill{0, 0, 2048, 0, 0, 0, 0};  // 1 g of 16 along z

double in_ms(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-6;
}

// The link, whatever it is made of.
class Way {
 public:
  virtual ~Way() = default;
  virtual Result<Done> send(std::uint8_t number, std::uint16_t time_us) = 0;
  // Takes what has come, sends what waits.
  virtual Result<Done> turn(io::PodLinkReader& reader) = 0;
  virtual int file() const = 0;
  virtual std::string name() const = 0;
  virtual std::uint64_t heard() const = 0;  // bytes, or frames of others
  virtual const char* of_what() const = 0;
  virtual std::string look() const = 0;  // where nothing comes
};

class PodUart final : public Way {
 public:
  explicit PodUart(io::Tty tty) : tty_(std::move(tty)) {}
  Result<Done> send(std::uint8_t number, std::uint16_t time_us) override {
    return tty_.write(io::pack_pod_sample(number, time_us, kStill));
  }
  Result<Done> turn(io::PodLinkReader& reader) override {
    if (const auto flushed = tty_.flush(); !flushed) return flushed;
    return read_turn(tty_, [&](std::span<const std::uint8_t> piece) {
      bytes_ += piece.size();
      for (const std::uint8_t byte : piece) reader.add(byte);
    });
  }
  int file() const override { return tty_.file(); }
  std::string name() const override { return tty_.path(); }
  std::uint64_t heard() const override { return bytes_; }
  const char* of_what() const override { return "B"; }
  std::string look() const override {
    return "is the pod powered and flashed, its PA9 (TX) on this RX, its PA10 on this TX?";
  }

 private:
  io::Tty tty_;
  std::uint64_t bytes_ = 0;
};

class PodBus final : public Way {
 public:
  PodBus(io::CanPort& port, std::string name) : port_(port), name_(std::move(name)) {}
  Result<Done> send(std::uint8_t number, std::uint16_t time_us) override {
    constexpr std::uint8_t kUrgent = 6;
    node_.broadcast(dc::PodSample{number, time_us, kStill}, kUrgent);
    return send_waiting();
  }
  Result<Done> turn(io::PodLinkReader& reader) override {
    for (;;) {
      const auto got = port_.receive();
      if (!got) return got.error();
      if (!got.value()) return send_waiting();
      if (got.value()->own || got.value()->trouble) continue;
      ++frames_;
      const dc::Transfer* transfer = node_.on_frame(got.value()->frame, got.value()->host_ns);
      if (transfer == nullptr) continue;
      if (const auto told = node_.read<dc::PodFrame>(*transfer)) reader.add(*told);
    }
  }
  int file() const override { return port_.file(); }
  std::string name() const override { return name_; }
  std::uint64_t heard() const override { return frames_; }
  const char* of_what() const override { return "frames"; }
  std::string look() const override {
    return "is the pod powered and flashed, its transceiver on PB12 and PB13, 60 ohm across the "
           "bus?";
  }

 private:
  static constexpr std::uint8_t kHost_node = 100;

  Result<Done> send_waiting() {
    for (; !waiting_.empty(); waiting_.pop_front()) {
      const auto sent = port_.send(waiting_.front());
      if (!sent) return sent.error();
      if (!sent.value()) break;
    }
    return Done{};
  }

  io::CanPort& port_;
  std::string name_;
  std::deque<io::CanFrame> waiting_;
  dc::LocalNode node_{kHost_node, "whirl.bench",
                      [this](const io::CanFrame& frame) { waiting_.push_back(frame); }};
  std::uint64_t frames_ = 0;
};

class PodCheck {
 public:
  PodCheck(Way& way, const PodCheckOptions& options, pacing::HostClock& clock)
      : way_(way),
        options_(options),
        clock_(clock),
        reader_([this](const io::PodStatus& status) { on_status(status); }) {}

  Result<std::vector<std::string>> all() {
    if (const auto sent = send_for(kLearns_s); !sent) return sent.error();
    if (const auto there = somebody(); !there) return there.error();
    begin_ = status_;
    arrived_ms_.clear();
    way_ms_.clear();
    if (const auto sent = send_for(options_.seconds); !sent) return sent.error();
    if (!status_ || arrived_ms_.empty()) {
      return refused("has fallen silent", "look at its supply and its wires");
    }
    if (way_ms_.empty()) {
      return refused("tells its status, and hears nothing of this host", way_.look());
    }
    return std::vector<std::string>{answers(), counted(), took()};
  }

 private:
  Result<Done> send_for(double seconds) {
    const std::int64_t begin_ns = clock_.now_ns();
    const double step_ns = kSample_s * 1e9 / options_.pace;
    const auto steps = std::llround(seconds / kSample_s);
    for (std::int64_t i = 0; i < steps; ++i, ++number_) {
      const auto number = static_cast<std::uint8_t>(number_);
      sent_host_ns_[number] = clock_.now_ns();
      const auto time_us = static_cast<std::uint16_t>(1000 * number_);
      if (const auto sent = way_.send(number, time_us); !sent) return sent;
      const std::int64_t due_ns = begin_ns + std::llround(static_cast<double>(i + 1) * step_ns);
      if (const auto listened = listen_until(due_ns); !listened) return listened;
    }
    return Done{};
  }

  Result<Done> listen_until(std::int64_t end_ns) {
    do {
      if (const auto turned = way_.turn(reader_); !turned) return turned;
      pollfd file{way_.file(), POLLIN, 0};
      clock_.wait_for({&file, 1}, std::min(end_ns, clock_.now_ns() + kPod_turn_ns));
    } while (clock_.now_ns() < end_ns);
    return way_.turn(reader_);
  }

  // The newest sample in it had come up to a millisecond before it was told.
  void on_status(const io::PodStatus& status) {
    const std::int64_t now_ns = clock_.now_ns();
    if (status_) arrived_ms_.push_back(in_ms(now_ns - last_host_ns_));
    last_host_ns_ = now_ns;
    const bool moves = status_ && status.newest_sample != status_->newest_sample;
    if (moves) way_ms_.push_back(in_ms(now_ns - sent_host_ns_[status.newest_sample]));
    status_ = status;
  }

  Result<Done> somebody() const {
    if (status_) return Done{};
    if (way_.heard() == 0) return refused("says nothing in a second", way_.look());
    return refused("carries " + std::to_string(way_.heard()) + " " + way_.of_what() +
                       ", and no status of a pod",
                   "is the image pod, and this the pod's link at its rate?");
  }
  Error refused(const std::string& what, const std::string& cure) const {
    return {ErrorKind::bad_input, way_.name(), what, cure};
  }

  std::string answers() const {
    const Spread s = spread_of(arrived_ms_);
    char text[200];
    std::snprintf(text, sizeof text,
                  "a pod answers on %s: %zu statuses, between two p50 %.1f, p99 %.1f, most %.1f ms",
                  way_.name().c_str(), arrived_ms_.size(), s.p50_ms, s.p99_ms, s.most_ms);
    return text;
  }

  std::string counted() const {
    const auto since = [](std::uint16_t now, std::uint16_t then) {
      return static_cast<int>(static_cast<std::uint16_t>(now - then));
    };
    char text[240];
    std::snprintf(text, sizeof text,
                  "of %lld samples, 1 ms apart, it counts %d lost and %d late, the longest wait of "
                  "one %d us; %d frames damaged, %d of its own without room",
                  std::llround(options_.seconds / kSample_s), since(status_->lost, begin_->lost),
                  since(status_->late, begin_->late), status_->wait_us,
                  since(status_->damaged, begin_->damaged), since(status_->unsent, begin_->unsent));
    return text;
  }

  std::string took() const {
    const Spread s = spread_of(way_ms_);
    char text[200];
    std::snprintf(text, sizeof text,
                  "from a sample's leaving to a status that has it, both ways and up to 1 ms: p50 "
                  "%.2f, p99 %.2f, most %.2f ms",
                  s.p50_ms, s.p99_ms, s.most_ms);
    return text;
  }

  Way& way_;
  const PodCheckOptions& options_;
  pacing::HostClock& clock_;
  io::PodLinkReader reader_;
  std::int64_t number_ = 0, last_host_ns_ = 0;
  std::array<std::int64_t, 256> sent_host_ns_{};
  std::optional<io::PodStatus> status_, begin_;
  std::vector<double> arrived_ms_, way_ms_;
};

}  // namespace

Result<std::vector<std::string>> check_pod(const PodCheckOptions& options, const CanMaker& can,
                                           pacing::HostClock& clock) {
  if (!options.link.path.empty()) {
    auto tty = io::Tty::open(options.link.path, static_cast<int>(io::kPodBaud));
    if (!tty) return tty.error();
    PodUart line(std::move(tty.value()));
    return PodCheck(line, options, clock).all();
  }
  const auto port = can(options.link.can);
  if (!port) return port.error();
  PodBus bus(*port.value(), options.link.can.interface);
  auto lines = PodCheck(bus, options, clock).all();
  if (!lines) return lines;
  lines.value().insert(lines.value().begin(), port.value()->version());
  // It tells of itself once a second, from the first frame of a host on.
  const auto nodes = check_can_bus(*port.value(), clock,
                                   {.interface = options.link.can.interface,
                                    .bit_rate_bps = options.link.can.bit_rate_bps,
                                    .seconds = std::max(2.0, options.seconds) / options.pace});
  if (!nodes) return nodes;
  lines.value().insert(lines.value().end(), nodes.value().begin(), nodes.value().end());
  return lines;
}

}  // namespace whirl::bench
