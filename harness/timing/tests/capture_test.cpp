// Taking down a report from a target: up to its last line, or as far as the target came.
#include "harness/timing/capture.hpp"

#include <gtest/gtest.h>

namespace whirl::timing {
namespace {

// Sends a few bytes each step on a port, and other bytes on another one.
class Sender final : public Target {
 public:
  Sender(std::string text, std::size_t locks_after) : text_(std::move(text)), locks_(locks_after) {}

  Result<Done> start() override { return Done{}; }
  void run(std::int64_t until_ns, const io::Batch&) override { now_ns_ = until_ns; }
  Result<TargetState> arrive(io::Batch& happened) override {
    happened.clear();
    const std::string piece = text_.substr(std::min(sent_, text_.size()), 7);
    sent_ += piece.size();
    happened.add(io::Kind::uart_received, 1, now_ns_, "noise\n", 6);
    happened.add(io::Kind::uart_received, 2, now_ns_, piece.data(),
                 static_cast<std::uint32_t>(piece.size()));
    return sent_ >= locks_ ? TargetState::cpu_locked : TargetState::running;
  }
  void stop(io::Batch&) override { stopped = true; }
  Offers offers() const override { return kAll_offers; }
  std::vector<std::pair<std::string, std::string>> versions() const override { return {}; }

  std::int64_t now_ns() const { return now_ns_; }
  bool stopped = false;

 private:
  std::string text_;
  std::size_t locks_, sent_ = 0;
  std::int64_t now_ns_ = 0;
};

constexpr const char* kText = "timing 1 stm32f405\nrow add_16 128 128\nend 1\n";

TEST(TimingCapture, EndsWithTheLastLineOfItsPort) {
  Sender target(std::string(kText) + "more", 1000);
  const auto text = capture(target, 2);
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(text.value().find(kText), 0u) << text.value();
  EXPECT_EQ(text.value().find("noise"), std::string::npos);
  EXPECT_LT(target.now_ns(), 1'000'000'000);
  EXPECT_TRUE(target.stopped);
}

TEST(TimingCapture, GivesWhatCameBeforeALockUp) {
  Sender target(kText, 21);
  const auto text = capture(target, 2);
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(text.value(), "timing 1 stm32f405\nro");
  EXPECT_TRUE(target.stopped);
}

TEST(TimingCapture, GivesUpOnAnImageThatNeverEnds) {
  Sender target("timing 1 stm32f405\nrow add_16 128 128\n", 1000);
  const auto text = capture(target, 2);
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(target.now_ns(), 60'000'000'000);
  EXPECT_EQ(text.value().size(), 38u);
}

}  // namespace
}  // namespace whirl::timing
