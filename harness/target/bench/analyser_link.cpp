#include "harness/target/bench/analyser_link.hpp"

#include <chrono>
#include <cstdio>
#include <cstring>
#include <tuple>

namespace whirl::bench {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirst_sample{3000}, kPulse_seen{1000};

void add_finding(const std::string& text, std::int64_t t_ns, io::Batch& happened) {
  const std::string all = std::string("analyser") + '\0' + text;
  happened.add(io::Kind::finding, 0, t_ns, all.data(), static_cast<std::uint32_t>(all.size()));
}

}  // namespace

// Edges come from the source's thread, and are looked at from the bench's.
class AnalyserLink::Locked final : public copper::EdgeSink {
 public:
  explicit Locked(copper::BoardNames names) : decoding(std::move(names)) {}

  void begin(const std::vector<std::string>& channels, double rate_Hz) override {
    const std::scoped_lock lock(mutex);
    decoding.begin(channels, rate_Hz);
    begun = true;
    changed.notify_all();
  }
  void on_edge(const copper::Edge& edge) override {
    const std::scoped_lock lock(mutex);
    decoding.on_edge(edge);
  }
  void advance_to(std::int64_t t_ns) override {
    const std::scoped_lock lock(mutex);
    decoding.advance_to(t_ns);
    changed.notify_all();
  }

  std::mutex mutex;
  std::condition_variable changed;
  copper::Decoding decoding;
  bool begun = false;
  std::optional<Error> ended;
};

AnalyserLink::AnalyserLink(std::string name, std::unique_ptr<EdgeSource> source,
                           std::unique_ptr<MarkerLine> marker, copper::BoardNames names)
    : name_(std::move(name)),
      source_(std::move(source)),
      marker_(std::move(marker)),
      seen_(std::make_unique<Locked>(std::move(names))) {}

AnalyserLink::~AnalyserLink() {
  close();
}

Result<Done> AnalyserLink::open() {
  if (const auto opened = marker_->open(); !opened) return opened;
  if (const auto opened = source_->open(); !opened) return opened;
  thread_ = std::thread([this] {
    const auto ran = source_->run(*seen_);
    const std::scoped_lock lock(seen_->mutex);
    if (!ran) seen_->ended = ran.error();
    seen_->changed.notify_all();
  });
  {
    std::unique_lock lock(seen_->mutex);
    seen_->changed.wait_for(lock, kFirst_sample, [this] { return seen_->begun || seen_->ended; });
    if (seen_->ended) return *seen_->ended;
    if (!seen_->begun) {
      return Error{ErrorKind::bad_input, name_, "the analyser gives no samples",
                   "is it another program's, or its rate too high for this host?"};
    }
    if (seen_->decoding.error()) return *seen_->decoding.error();
  }
  return mark();
}

// A pulse that the clip does not see is found before anything turns.
Result<Done> AnalyserLink::mark() {
  const auto asked = marker_->pulse();
  if (!asked) return asked.error();
  asked_ns_.push_back(asked.value());
  std::unique_lock lock(seen_->mutex);
  const bool seen = seen_->changed.wait_for(lock, kPulse_seen, [this] {
    return seen_->decoding.marker_rises_ns().size() >= asked_ns_.size();
  });
  if (seen) return Done{};
  return Error{ErrorKind::bad_input, name_, "its clip 'marker' saw no pulse",
               "is it on the RTS pin of the marker's serial line?"};
}

Result<Done> AnalyserLink::serve(std::int64_t /*now_host_ns*/, Arrivals& /*arrivals*/) {
  const std::scoped_lock lock(seen_->mutex);
  if (seen_->ended) return *seen_->ended;
  return Done{};
}

void AnalyserLink::finish(const VirtualTime& virtual_ns, std::int64_t end_ns, io::Batch& happened) {
  if (!thread_.joinable()) return;
  const auto marked = mark();
  close();
  const std::vector<std::int64_t>& rises_ns = seen_->decoding.marker_rises_ns();
  std::string why = marked ? "" : marked.error().message();
  if (seen_->ended) why = seen_->ended->message();
  if (why.empty() && rises_ns.size() != asked_ns_.size()) {
    why = std::to_string(rises_ns.size()) + " marker pulses were seen, and " +
          std::to_string(asked_ns_.size()) + " sent";
  }
  std::vector<copper::MarkerPulse> pulses;
  for (std::size_t i = 0; i < asked_ns_.size() && i < rises_ns.size(); ++i) {
    pulses.push_back({asked_ns_[i].first, asked_ns_[i].second, rises_ns[i]});
  }
  const auto fit = copper::fit_clocks(pulses);
  if (why.empty() && fit && fit->rate_known) return tell_all(*fit, virtual_ns, end_ns, happened);
  tell_unread(why.empty() ? "two marker pulses are wanted" : why, end_ns, happened);
}

void AnalyserLink::tell_all(const copper::ClockFit& fit, const VirtualTime& virtual_ns,
                            std::int64_t end_ns, io::Batch& happened) const {
  const auto at = [&](std::int64_t analyser_ns) { return virtual_ns(fit.host_ns(analyser_ns)); };
  const io::Batch all = seen_->decoding.in_order();
  const double pace = static_cast<double>(virtual_ns(fit.host_zero_ns + 1'000'000'000) -
                                          virtual_ns(fit.host_zero_ns)) *
                      1e-9 * fit.rate;
  for (io::Reader r(all.bytes()); r.next();) {
    io::Header header = r.header();
    const std::int64_t then_ns = header.t_ns;
    header.t_ns = at(then_ns);
    if (header.t_ns < 0 || header.t_ns > end_ns) continue;  // before or behind the run
    if (header.kind == io::Kind::uart_received) continue;   // the serial link has told it
    std::vector<std::uint8_t> payload(r.payload().begin(), r.payload().end());
    const bool transfer =
        header.kind == io::Kind::i2c_transaction || header.kind == io::Kind::spi_transaction;
    if (transfer || header.kind == io::Kind::bus_unread) {  // both begin with their start
      std::int64_t start_ns = 0;
      std::memcpy(&start_ns, payload.data(), sizeof start_ns);
      start_ns = at(start_ns);
      std::memcpy(payload.data(), &start_ns, sizeof start_ns);
    }
    if (transfer) {
      const std::size_t first = sizeof(io::BusTransaction) + r.transferred().size();
      for (std::size_t i = first; i + 4 <= payload.size(); i += 4) {
        std::uint32_t passed_ns = 0;
        std::memcpy(&passed_ns, payload.data() + i, sizeof passed_ns);
        passed_ns = static_cast<std::uint32_t>(static_cast<double>(passed_ns) * pace);
        std::memcpy(payload.data() + i, &passed_ns, sizeof passed_ns);
      }
    }
    happened.add(header, payload);
  }
  char text[160];
  std::snprintf(text, sizeof text,
                "clocks aligned by %zu marker pulses: times hold to %.3f ms, the analyser's clock "
                "is %+.1f ppm off this "
                "host's",
                asked_ns_.size(), fit.residue_ns * 1e-6, (1.0 / fit.rate - 1.0) * 1e6);
  add_finding(text, end_ns, happened);
}

void AnalyserLink::tell_unread(const std::string& why, std::int64_t end_ns,
                               io::Batch& happened) const {
  for (const std::string& bus : seen_->decoding.buses()) {
    const io::BusUnread all{0, static_cast<std::uint8_t>(bus.starts_with("spi") ? 1 : 0), {}};
    happened.add(io::Kind::bus_unread, static_cast<std::uint16_t>(std::stoi(bus.substr(3))), end_ns,
                 all, why.data(), static_cast<std::uint32_t>(why.size()));
  }
  add_finding("nothing of its buses can be placed in time: " + why, end_ns, happened);
}

void AnalyserLink::close() {
  if (!thread_.joinable()) return;
  source_->stop();
  thread_.join();
}

std::vector<std::pair<std::string, std::string>> AnalyserLink::versions() const {
  return {{"link " + name_, source_->version()}};
}

}  // namespace whirl::bench
