#include "harness/target/bench/analyser_link.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "base/near.hpp"
#include "io_bridges/copper/wire_drawing.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000, kSecond_ns = 1'000'000'000;
constexpr std::uint16_t kScl = 0, kSda = 1, kMarker = 2;

// An analyser whose clock runs 60 ppm fast and started 3 s after the host's zero.
std::int64_t analyser_ns(std::int64_t host_ns) {
  return std::llround(static_cast<double>(host_ns - 3 * kSecond_ns) * 1.00006);
}

class FakeSource final : public EdgeSource {
 public:
  Result<Done> open() override { return Done{}; }
  Result<Done> run(copper::EdgeSink& sink) override {
    sink.begin({"i2c2_scl", "i2c2_sda", "marker"}, 24e6);
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return stopped_ || fails_ || !edges_.empty(); });
      if (fails_) return Error{ErrorKind::host, "fake", "lost samples", ""};
      while (!edges_.empty()) {
        sink.on_edge(edges_.front());
        sink.advance_to(edges_.front().t_ns);
        edges_.pop_front();
      }
      if (stopped_) return Done{};
    }
  }
  void stop() override {
    say([this] { stopped_ = true; });
  }
  void fail() {
    say([this] { fails_ = true; });
  }
  std::string version() const override { return "fake"; }
  void push(const std::vector<copper::Edge>& edges) {
    say([&] { edges_.insert(edges_.end(), edges.begin(), edges.end()); });
  }
  void mark(std::int64_t host_ns) {
    const std::int64_t t_ns = analyser_ns(host_ns);
    push({{t_ns, kMarker, true}, {t_ns + 2 * kMs_ns, kMarker, false}});
  }

 private:
  template <typename Change>
  void say(Change change) {
    const std::scoped_lock lock(mutex_);
    change();
    changed_.notify_one();
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<copper::Edge> edges_;
  bool stopped_ = false, fails_ = false;
};

// Rises 0.3 ms after it was asked for, of the millisecond that the call takes.
class FakeMarker final : public MarkerLine {
 public:
  explicit FakeMarker(FakeSource& source) : source_(source) {}
  Result<Done> open() override { return Done{}; }
  Result<std::pair<std::int64_t, std::int64_t>> pulse() override {
    if (!dead) source_.mark(next_host_ns + 300'000);
    return std::pair(next_host_ns, next_host_ns + kMs_ns);
  }
  std::int64_t next_host_ns = 10 * kSecond_ns;
  bool dead = false;

 private:
  FakeSource& source_;
};

class Analyser : public testing::Test {
 protected:
  void make() {
    auto source = std::make_unique<FakeSource>();
    auto marker = std::make_unique<FakeMarker>(*source);
    source_ = source.get();
    marker_ = marker.get();
    link_ = std::make_unique<AnalyserLink>("analyser", std::move(source), std::move(marker),
                                           copper::BoardNames{});
  }
  // A write of two bytes that begins then, of the host's time.
  void write_at(std::int64_t host_ns) {
    copper::I2cDrawing drawing(kScl, kSda);
    std::vector<copper::Edge> edges;
    const std::int64_t t = analyser_ns(host_ns);
    drawing.add({t, t + 94'000, 0x29, false, true, {0x0F, 0xA0}, {t + 47'500, t + 70'000}}, edges);
    drawing.settle(edges);
    source_->push(edges);
  }
  io::Batch finish_at(std::int64_t host_ns) {
    marker_->next_host_ns = host_ns;
    io::Batch happened;
    link_->finish([](std::int64_t host) { return host - 11 * kSecond_ns; },
                  host_ns - 11 * kSecond_ns, happened);
    return happened;
  }

  std::unique_ptr<AnalyserLink> link_;
  FakeSource* source_ = nullptr;
  FakeMarker* marker_ = nullptr;
};

TEST_F(Analyser, WritesStandAtTheHostsTimeWithinTheResidue) {
  make();
  ASSERT_TRUE(link_->open());
  for (int i = 0; i < 50; ++i) write_at(12 * kSecond_ns + i * kSecond_ns);
  const io::Batch happened = finish_at(70 * kSecond_ns);
  int writes = 0;
  std::string told;
  for (io::Reader r(happened.bytes()); r.next();) {
    if (r.header().kind == io::Kind::finding) told.assign(r.payload().begin(), r.payload().end());
    if (r.header().kind != io::Kind::i2c_transaction) continue;
    const auto head = r.as<io::BusTransaction>();
    EXPECT_TRUE(near(static_cast<double>(head.start_ns), (1.0 + writes) * 1e9,
                     stated(500e3, "half of the millisecond in which the pulse was asked for")));
    EXPECT_GT(r.header().t_ns, head.start_ns);
    EXPECT_EQ(head.address, 0x29);
    ++writes;
  }
  EXPECT_EQ(writes, 50);
  EXPECT_NE(told.find("times hold to 0.500 ms, the analyser's clock is +60.0 ppm"),
            std::string::npos)
      << told;
}

TEST_F(Analyser, AMarkerThatNoClipSeesIsRefusedBeforeAnythingTurns) {
  make();
  marker_->dead = true;
  const auto opened = link_->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, ErrorKind::bad_input);
  EXPECT_NE(opened.error().message().find("saw no pulse"), std::string::npos);
}

TEST_F(Analyser, WithoutTheSecondPulseNothingOfTheBusIsClaimed) {
  make();
  ASSERT_TRUE(link_->open());
  write_at(12 * kSecond_ns);
  marker_->dead = true;
  const io::Batch happened = finish_at(70 * kSecond_ns);
  int unread = 0;
  for (io::Reader r(happened.bytes()); r.next();) {
    EXPECT_NE(r.header().kind, io::Kind::i2c_transaction);
    if (r.header().kind != io::Kind::bus_unread) continue;
    ++unread;
    EXPECT_EQ(r.header().port, 2);
    EXPECT_EQ(r.as<io::BusUnread>().start_ns, 0);
    EXPECT_EQ(r.header().t_ns, 59 * kSecond_ns);
  }
  EXPECT_EQ(unread, 1);
}

TEST_F(Analyser, OneThatStopsByItselfEndsTheRun) {
  make();
  ASSERT_TRUE(link_->open());
  source_->fail();
  Arrivals nothing;
  auto served = link_->serve(0, nothing);
  for (int i = 0; i < 1000 && served; ++i) {
    std::this_thread::yield();
    served = link_->serve(0, nothing);
    if (served) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_FALSE(served);
  EXPECT_EQ(served.error().kind, ErrorKind::host);
}

}  // namespace
}  // namespace whirl::bench
