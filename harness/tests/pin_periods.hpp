// A target that passes all on, and measures the periods between rising edges of a pin that its first board names.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>

#include "harness/target/target.hpp"

namespace whirl {

struct Periods {
  static constexpr std::int64_t kUsual_ns = 1'000'000, kFar_ns = 20'000;
  std::int64_t count = 0, least_ns = 0, most_ns = 0;
  std::int64_t far = 0;  // further than kFar_ns from a millisecond
  void add(std::int64_t period_ns) {
    least_ns = count == 0 ? period_ns : std::min(least_ns, period_ns);
    most_ns = std::max(most_ns, period_ns);
    if (std::abs(period_ns - kUsual_ns) > kFar_ns) ++far;
    ++count;
  }
};

class PinPeriods final : public Target {
 public:
  // pin: its place in the board's list. Periods that end before from_ns are left out. `periods` has to live as long.
  PinPeriods(std::unique_ptr<Target> target, std::uint16_t pin, std::int64_t from_ns,
             Periods& periods)
      : target_(std::move(target)), pin_(pin), from_ns_(from_ns), periods_(periods) {}

  Result<Done> start() override { return target_->start(); }
  void run(std::int64_t until_ns, const io::Batch& sensed) override {
    target_->run(until_ns, sensed);
  }
  Result<TargetState> arrive(io::Batch& happened) override {
    auto state = target_->arrive(happened);
    for (io::Reader r(happened.bytes()); r.next();) on_message(r);
    return state;
  }
  void stop(io::Batch& happened) override { target_->stop(happened); }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return target_->versions();
  }
  Offers offers() const override { return target_->offers(); }

 private:
  void on_message(const io::Reader& message) {
    const io::Header& head = message.header();
    if (head.kind != io::Kind::pin_edge || head.board != 0 || head.port != pin_) return;
    if (message.as<io::PinEdge>().level == 0) return;
    if (head.t_ns >= from_ns_ && rose_ns_ > 0) periods_.add(head.t_ns - rose_ns_);
    rose_ns_ = head.t_ns;
  }

  std::unique_ptr<Target> target_;
  std::uint16_t pin_;
  std::int64_t from_ns_, rose_ns_ = 0;
  Periods& periods_;
};

}  // namespace whirl
