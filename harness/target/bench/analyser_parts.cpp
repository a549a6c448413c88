// The real ends of an analyser's link: a device of libsigrok, and RTS of a serial line as the marker.
#include <sys/ioctl.h>
#include <termios.h>

#include <cerrno>
#include <cstring>

#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/analyser_link.hpp"
#include "io_bridges/serial/tty.hpp"
#include "io_bridges/sigrok/capture.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kHigh_ns = 2'000'000;  // a clip at 1 kHz would see it

class SigrokSource final : public EdgeSource {
 public:
  explicit SigrokSource(const AnalyserClips& clips)
      : options_{clips.driver, clips.connection, clips.model, clips.rate_Hz, clips.channels} {}

  Result<Done> open() override {
    auto device = sigrok::Device::open(options_);
    if (!device) return device.error();
    device_ = std::move(device.value());
    return Done{};
  }
  Result<Done> run(copper::EdgeSink& sink) override { return device_->run(sink); }
  void stop() override {
    if (device_) device_->stop();
  }
  std::string version() const override { return device_ ? device_->version() : options_.driver; }

 private:
  sigrok::DeviceOptions options_;
  std::unique_ptr<sigrok::Device> device_;
};

// RTS is inverted by most USB serial chips: what the host calls set is a low pin. Set at rest, a pulse clears it.
class RtsMarker final : public MarkerLine {
 public:
  explicit RtsMarker(std::string path) : path_(std::move(path)) {}

  Result<Done> open() override {
    auto tty = io::Tty::open(path_, 115200);
    if (!tty) return tty.error();
    tty_ = std::move(tty.value());
    return set(true);
  }
  Result<std::pair<std::int64_t, std::int64_t>> pulse() override {
    const std::int64_t before_ns = clock_.now_ns();
    if (const auto risen = set(false); !risen) return risen.error();
    const std::int64_t after_ns = clock_.now_ns();
    clock_.sleep_until(after_ns + kHigh_ns);
    if (const auto fallen = set(true); !fallen) return fallen.error();
    return std::pair(before_ns, after_ns);
  }

 private:
  Result<Done> set(bool on) {
    int bit = TIOCM_RTS;
    if (ioctl(tty_->file(), on ? TIOCMBIS : TIOCMBIC, &bit) == 0) return Done{};
    return Error{ErrorKind::bad_input, path_,
                 std::string("has no RTS to mark with: ") + std::strerror(errno),
                 "a USB serial adapter with its RTS pin led out"};
  }

  std::string path_;
  std::optional<io::Tty> tty_;
  pacing::MonotonicClock clock_;
};

}  // namespace

std::unique_ptr<EdgeSource> sigrok_source(const AnalyserClips& clips) {
  return std::make_unique<SigrokSource>(clips);
}

std::unique_ptr<MarkerLine> rts_marker(const std::string& path) {
  return std::make_unique<RtsMarker>(path);
}

}  // namespace whirl::bench
