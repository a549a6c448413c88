#include "harness/target/bench/bench_target.hpp"

#include <algorithm>
#include <tuple>

#include "harness/pacing/real_time.hpp"

namespace whirl::bench {
namespace {

constexpr std::size_t kMost_samples = 2'000'000;  // of lateness: half an hour

}  // namespace

BenchTarget::BenchTarget(BenchOptions options, std::vector<std::unique_ptr<Link>> links,
                         pacing::HostClock& clock)
    : options_(std::move(options)),
      links_(std::move(links)),
      clock_(clock),
      pacer_(clock, options_.bench.pace, options_.bench.late_ns) {
  held_.pace = options_.bench.pace;
  held_.late_ns = options_.bench.late_ns;
  held_.late_share = options_.bench.late_share;
}

BenchTarget::~BenchTarget() {
  io::Batch nothing;
  stop(nothing);
}

Result<Done> BenchTarget::start() {
  for (const auto& link : links_) {
    if (auto opened = link->open(); !opened) {
      for (const auto& other : links_) {
        if (other == link) break;
        other->close();
      }
      links_.clear();
      return opened;
    }
  }
  started_ = true;
  if (options_.real_time) held_.scheduling = pacing::take_real_time().told;
  std::ignore = pacer_.due_ns(0);
  for (const auto& link : links_) link->keep_time(time());
  return Done{};
}

BenchTime BenchTarget::time() {
  return {[this](std::int64_t host_ns) {
            return std::clamp<std::int64_t>(pacer_.virtual_ns(host_ns), 0, until_ns_);
          },
          [this](std::int64_t t_ns) { return pacer_.due_ns(t_ns); }};
}

void BenchTarget::run(std::int64_t until_ns, const io::Batch& sensed) {
  until_ns_ = until_ns;
  if (!why_.empty()) return;
  for (io::Reader r(sensed.bytes()); r.next();) {
    if (r.header().kind == io::Kind::emergency_stop) {
      return make_safe({r.payload().begin(), r.payload().end()});
    }
    const std::int64_t due_host_ns = pacer_.due_ns(r.header().t_ns);
    for (const auto& link : links_) {
      if (link->take(r, due_host_ns)) break;
    }
  }
}

Result<TargetState> BenchTarget::arrive(io::Batch& happened) {
  const auto served = serve_until(pacer_.due_ns(until_ns_));
  pacer_.begun(until_ns_);
  const pacing::Lateness& late = pacer_.lateness();
  if (held_.lateness_s.size() < kMost_samples) {
    held_.lateness_s.push_back(static_cast<double>(late.latest_ns) * 1e-9);
  }
  held_.late_steps = late.late_steps;
  held_.slipped_ns = late.slipped_ns;
  tell(until_ns_, happened);
  if (!served) {
    make_safe(served.error().message());
    return served.error();
  }
  if (until_ns_ >= options_.bench.safety.longest_ns && why_.empty()) {
    make_safe("the bench's longest time is over");
    return Error{ErrorKind::bad_input, options_.bench.file, why_,
                 "a shorter plan, or more in its safety"};
  }
  if (host_stopped_) return Error{ErrorKind::host, options_.bench.name, why_, ""};
  return why_.empty() ? TargetState::running : TargetState::over_limit;
}

Result<Done> BenchTarget::serve_until(std::int64_t due_host_ns) {
  for (;;) {
    const std::int64_t now_host_ns = clock_.now_ns();
    if (const auto served = serve_all(now_host_ns); !served) return served;
    if (now_host_ns >= due_host_ns) return Done{};
    std::int64_t wake_ns = due_host_ns;
    std::vector<pollfd> files;
    for (const auto& link : links_) {
      wake_ns = std::min(wake_ns, link->next_due_host_ns());
      if (link->file() >= 0) files.push_back({link->file(), POLLIN, 0});
    }
    clock_.wait_for(files, wake_ns);
  }
}

Result<Done> BenchTarget::serve_all(std::int64_t now_host_ns) {
  for (const auto& link : links_) {
    if (const auto served = link->serve(now_host_ns, arrivals_); !served) return served;
    if (!link->heartbeat_lost() || !why_.empty()) continue;
    make_safe(link->name() + " heard nothing of this program for " +
              std::to_string(options_.bench.safety.heartbeat_ns / 1'000'000) + " ms");
    host_stopped_ = true;
  }
  if (options_.operator_stops && why_.empty() && options_.operator_stops()) {
    make_safe("stopped by the operator");
    host_stopped_ = true;
  }
  return Done{};
}

// A stamp before the step's begin is of something that its link told late: it stays before what comes now.
void BenchTarget::tell(std::int64_t until_ns, io::Batch& happened) {
  std::stable_sort(arrivals_.begin(), arrivals_.end(),
                   [](const Arrival& a, const Arrival& b) { return a.host_ns < b.host_ns; });
  for (const Arrival& arrival : arrivals_) {
    const std::int64_t t_ns =
        std::clamp<std::int64_t>(pacer_.virtual_ns(arrival.host_ns), 0, until_ns);
    happened.add(arrival.kind, arrival.port, t_ns, arrival.payload.data(),
                 static_cast<std::uint32_t>(arrival.payload.size()));
  }
  arrivals_.clear();
}

void BenchTarget::make_safe(const std::string& why) {
  for (const auto& link : links_) link->make_safe();
  if (why_.empty()) why_ = why;
}

void BenchTarget::stop(io::Batch& happened) {
  if (!started_ || stopped_) return;
  stopped_ = true;
  for (const auto& link : links_) link->make_safe();
  // Times are known from the first step on.
  const VirtualTime virtual_ns = [this](std::int64_t host_ns) {
    return pacer_.virtual_ns(host_ns);
  };
  for (const auto& link : links_) link->finish(virtual_ns, until_ns_, happened);
  for (const auto& link : links_) {
    link->close();
    for (const std::string& finding : link->findings()) {
      const std::string text = link->name() + '\0' + finding;
      happened.add(io::Kind::finding, 0, until_ns_, text.data(),
                   static_cast<std::uint32_t>(text.size()));
    }
  }
  if (options_.real_time) pacing::give_back_real_time();
}

Offers BenchTarget::offers() const {
  return options_.bench.analyser ? Offers{Offer::bus_log} : Offers{};
}

bool BenchTarget::sees(const std::string& wires) const {
  return options_.bench.analyser && options_.bench.analyser->sees(wires);
}

std::vector<std::pair<std::string, std::string>> BenchTarget::versions() const {
  std::vector<std::pair<std::string, std::string>> all{{"bench", options_.bench.file}};
  for (const auto& link : links_) {
    const auto of_link = link->versions();
    all.insert(all.end(), of_link.begin(), of_link.end());
  }
  all.emplace_back("scheduling", held_.scheduling);
  return all;
}

}  // namespace whirl::bench
