#include "harness/target/bench/can_check.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>

#include "harness/target/bench/spread.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/socketcan/can_monitor.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;

constexpr std::uint8_t kTool_node = 126;  // the protocol leaves it to tools
constexpr std::int64_t kAnswer_ns = 100'000'000;

double ms(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-6;
}

struct Found {
  bool there = false;
  std::string name;
  std::vector<double> answered_ms;
  int asked = 0;
  std::int64_t last_status_ns = -1;
  std::vector<double> between_ms;  // of its esc.Status
};

class Check {
 public:
  Check(io::CanPort& port, pacing::HostClock& clock, const CanCheckOptions& options)
      : port_(port), clock_(clock), options_(options), monitor_(options.bit_rate_bps) {}

  Result<std::vector<std::string>> all() {
    const std::int64_t begin_ns = clock_.now_ns();
    const std::int64_t end_ns = begin_ns + static_cast<std::int64_t>(options_.seconds * 1e9);
    if (const auto heard = listen_until(end_ns); !heard) return heard.error();
    const auto load = monitor_.load_between(begin_ns, clock_.now_ns());
    if (std::none_of(nodes_.begin(), nodes_.end(), [](const Found& n) { return n.there; })) {
      return Error{ErrorKind::bad_input, options_.interface,
                   "no DroneCAN node tells of itself; " + monitor_.text(),
                   "is the board powered, and are both ends terminated?"};
    }
    for (std::size_t id = 1; id < nodes_.size(); ++id) {
      if (!nodes_[id].there) continue;
      if (const auto asked = ask(static_cast<std::uint8_t>(id)); !asked) return asked.error();
    }
    return told(load);
  }

 private:
  Result<Done> listen_until(std::int64_t end_ns, const bool* done = nullptr) {
    while (clock_.now_ns() < end_ns && (done == nullptr || !*done)) {
      if (const auto sent = send_waiting(); !sent) return sent;
      pollfd file{port_.file(), POLLIN, 0};
      clock_.wait_for({&file, 1}, std::min(end_ns, clock_.now_ns() + 1'000'000));
      for (;;) {
        const auto got = port_.receive();
        if (!got) return got.error();
        if (!got.value()) break;
        monitor_.on_arrival(*got.value());
        if (!got.value()->trouble && !got.value()->own) on_frame(*got.value());
      }
    }
    return Done{};
  }

  Result<Done> send_waiting() {
    for (; !waiting_.empty(); waiting_.pop_front()) {
      const auto sent = port_.send(waiting_.front());
      if (!sent) return sent.error();
      if (!sent.value()) return Done{};
    }
    return Done{};
  }

  void on_frame(const io::CanArrival& arrival) {
    const dc::Transfer* transfer = node_.on_frame(arrival.frame, arrival.host_ns);
    if (transfer == nullptr) return;
    Found& from = nodes_[transfer->header.source];
    from.there |= transfer->header.source != 0;
    if (node_.read<dc::EscStatus>(*transfer)) {
      if (from.last_status_ns >= 0) {
        from.between_ms.push_back(ms(arrival.host_ns - from.last_status_ns));
      }
      from.last_status_ns = arrival.host_ns;
    } else if (const auto info = node_.read<dc::GetNodeInfoResponse>(*transfer)) {
      from.name = info->name_text();
      from.answered_ms.push_back(ms(arrival.host_ns - asked_ns_));
      answered_ = true;
    }
  }

  Result<Done> ask(std::uint8_t id) {
    for (int n = 0; n < options_.requests; ++n) {
      answered_ = false;
      asked_ns_ = clock_.now_ns();
      node_.request(dc::GetNodeInfoRequest{}, id);
      ++nodes_[id].asked;
      if (const auto heard = listen_until(asked_ns_ + kAnswer_ns, &answered_); !heard) return heard;
      if (n == 4 && nodes_[id].answered_ms.empty()) break;  // it does not know how to
    }
    return Done{};
  }

  std::vector<std::string> told(const io::CanMonitor::Load& load) const {
    char text[300];
    std::vector<std::string> lines;
    if (options_.bit_rate_bps == 0) {
      lines.push_back(monitor_.text());
    } else {
      std::snprintf(text, sizeof text, "load %.1f to %.1f %%; ", 100 * load.least, 100 * load.most);
      lines.push_back(text + monitor_.text());
    }
    for (std::size_t id = 1; id < nodes_.size(); ++id) {
      const Found& node = nodes_[id];
      if (!node.there) continue;
      const Spread answer = spread_of(node.answered_ms), between = spread_of(node.between_ms);
      std::snprintf(text, sizeof text,
                    "node %zu %s: %zu of %d answers; p50 %.2f, p99 %.2f, most %.2f ms", id,
                    node.name.empty() ? "(no name)" : node.name.c_str(), node.answered_ms.size(),
                    node.asked, answer.p50_ms, answer.p99_ms, answer.most_ms);
      std::string line = text;
      if (!node.between_ms.empty()) {
        std::snprintf(text, sizeof text, "; esc.Status each p50 %.2f, p99 %.2f, most %.2f ms",
                      between.p50_ms, between.p99_ms, between.most_ms);
        line += text;
      }
      const auto& watched = node_.watch().node(static_cast<std::uint8_t>(id));
      if (watched.two_of_one_id) line += "; TWO NODES HAVE THIS ID";
      if (watched.restarts > 0)
        line += "; restarted " + std::to_string(watched.restarts) + " times";
      lines.push_back(line);
    }
    return lines;
  }

  io::CanPort& port_;
  pacing::HostClock& clock_;
  CanCheckOptions options_;
  io::CanMonitor monitor_;
  std::deque<io::CanFrame> waiting_;
  dc::LocalNode node_{kTool_node, "whirl.bench",
                      [this](const io::CanFrame& frame) { waiting_.push_back(frame); }};
  std::array<Found, 128> nodes_;
  std::int64_t asked_ns_ = 0;
  bool answered_ = false;
};

}  // namespace

Result<std::vector<std::string>> check_can_bus(io::CanPort& port, pacing::HostClock& clock,
                                               const CanCheckOptions& options) {
  return Check(port, clock, options).all();
}

}  // namespace whirl::bench
