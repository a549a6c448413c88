// The check of a pod's link against a pod that the test plays, on a clock that passes as it waits.
#include "harness/target/bench/pod_check.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "io_bridges/protocols/crc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kGrain_ns = 250'000, kStatus_ns = 10'000'000;

struct PlayedPod {
  std::uint16_t lost = 0, late = 0;
  std::uint8_t newest = 0;
  bool began = false, deaf = false;

  void sample(std::uint8_t number) {
    if (deaf) return;
    if (began) lost = static_cast<std::uint16_t>(lost + std::uint8_t(number - newest - 1));
    began = true;
    newest = number;
  }
  // As firmware/pod/host_link.hpp says: settings, the newest, and from byte 16 on what was lost and late.
  std::vector<std::uint8_t> status() const {
    std::vector<std::uint8_t> payload(56);
    payload[8] = newest;
    payload[16] = static_cast<std::uint8_t>(lost);
    payload[17] = static_cast<std::uint8_t>(lost >> 8);
    payload[18] = static_cast<std::uint8_t>(late);
    return payload;
  }
};

std::vector<std::uint8_t> framed(const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> frame{0xA5, 0x81, 0x01, static_cast<std::uint8_t>(payload.size())};
  for (const std::uint8_t byte : payload) frame.push_back(byte);
  std::uint16_t crc = 0xFFFF;
  for (std::size_t i = 1; i < frame.size(); ++i) crc = io::crc16_add(crc, frame[i]);
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

struct PodClock final : pacing::HostClock {
  std::int64_t t_ns = 1'000'000'000;
  std::function<void(std::int64_t)> turn = [](std::int64_t) {};
  std::int64_t now_ns() const override { return t_ns; }
  void sleep_until(std::int64_t until_ns) override { wait_for({}, until_ns); }
  void wait_for(std::span<pollfd>, std::int64_t until_ns) override {
    t_ns = std::max(t_ns, std::min(until_ns, t_ns + kGrain_ns));
    turn(t_ns);
  }
};

// At the end of a line; each drop-th sample is lost on its way.
struct LineRig {
  PlayedPod pod;
  PodClock clock;
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  bool silent = false;
  int drop = 0, seen = 0;
  std::int64_t told_ns = 0, silent_from_ns = 1'000'000'000'000;
  std::vector<std::uint8_t> bytes;

  LineRig() {
    clock.turn = [this](std::int64_t now_ns) {
      std::vector<std::uint8_t> piece(1024);
      piece.resize(far.read(piece));
      bytes.insert(bytes.end(), piece.begin(), piece.end());
      for (; bytes.size() >= io::kPodSampleBytes;
           bytes.erase(bytes.begin(), bytes.begin() + io::kPodSampleBytes)) {
        ASSERT_EQ(bytes[0], 0xA5);
        ++seen;
        if (drop == 0 || seen % drop != 0) pod.sample(bytes[2]);
      }
      if (silent || now_ns > silent_from_ns || now_ns < told_ns + kStatus_ns) return;
      told_ns = now_ns;
      far.write(framed(pod.status()));
    };
  }
  Result<std::vector<std::string>> check(double pace = 1.0) {
    return check_pod({.link = {.name = "pod", .board = "pod", .path = far.path(), .can = {}},
                      .seconds = 1.0,
                      .pace = pace},
                     nullptr, clock);
  }
};

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

TEST(PodCheck, TellsWhatThePodCountsAndHowLongTheWayTakes) {
  LineRig rig;
  rig.pod.lost = 7;  // of another run
  const auto told = rig.check();
  ASSERT_TRUE(told.ok()) << told.error().message();
  ASSERT_EQ(told.value().size(), 3u);
  EXPECT_TRUE(has(told.value()[0], "100 statuses, between two p50 10.0, p99 10.0, most 10.0 ms"))
      << told.value()[0];
  EXPECT_TRUE(has(told.value()[1], "of 1000 samples, 1 ms apart, it counts 0 lost and 0 late"))
      << told.value()[1];
  EXPECT_TRUE(has(told.value()[2], "most 0.")) << told.value()[2];
  EXPECT_EQ(rig.seen, 2000);
}

TEST(PodCheck, LostAndLateAreThoseOfItsOwnSamples) {
  LineRig rig;
  rig.pod.lost = 65'530;  // and wraps
  rig.drop = 100;
  rig.pod.late = 3;
  const auto turn = rig.clock.turn;
  rig.clock.turn = [&](std::int64_t t_ns) {
    turn(t_ns);
    if (rig.seen == 1500) rig.pod.late = 5;
  };
  const auto told = rig.check();
  ASSERT_TRUE(told.ok()) << told.error().message();
  EXPECT_TRUE(has(told.value()[1], "it counts 10 lost and 2 late")) << told.value()[1];
}

TEST(PodCheck, OfASlowBenchSamplesAreFurtherApart) {
  LineRig rig;
  const std::int64_t begin_ns = rig.clock.t_ns;
  ASSERT_TRUE(rig.check(0.1).ok());
  EXPECT_EQ(rig.seen, 2000);
  EXPECT_GE(rig.clock.t_ns - begin_ns, 20'000'000'000);
}

TEST(PodCheck, EachSilenceHasItsOwnWords) {
  LineRig dead;
  dead.silent = true;
  EXPECT_TRUE(has(dead.check().error().message(), "says nothing in a second")) << "dead";
  LineRig other;
  other.silent = true;
  const std::uint8_t text[] = {'h', 'e', 'l', 'l', 'o'};
  const auto turn = other.clock.turn;
  other.clock.turn = [&](std::int64_t t_ns) {
    turn(t_ns);
    if (t_ns % 10'000'000 == 0) other.far.write(text);
  };
  EXPECT_TRUE(has(other.check().error().message(), "and no status of a pod")) << "other";
  LineRig deaf;
  deaf.pod.deaf = true;
  EXPECT_TRUE(has(deaf.check().error().message(), "hears nothing of this host")) << "deaf";
  LineRig dies;
  dies.silent_from_ns = dies.clock.t_ns + 1'000'000'000;
  EXPECT_TRUE(has(dies.check().error().message(), "has fallen silent")) << "dies";
}

// Where nothing comes before its host has spoken, and then each 30 ms.
TEST(PodCheck, OnCanItsBusAndItsNodeAreToldToo) {
  PodClock clock;
  io::MemoryCan bus([&] { return clock.t_ns; });
  PlayedPod pod;
  const auto port = bus.join();
  dc::LocalNode node(20, "org.whirlstand.pod",
                     [&](const io::CanFrame& frame) { std::ignore = port->send(frame); });
  std::int64_t told_ns = 0;
  clock.turn = [&](std::int64_t now_ns) {
    while (const auto got = port->receive().value()) {
      if (got->own) continue;
      const dc::Transfer* transfer = node.on_frame(got->frame, now_ns);
      if (transfer == nullptr) continue;
      if (const auto sample = node.read<dc::PodSample>(*transfer)) pod.sample(sample->sequence);
    }
    if (!pod.began) return;
    node.poll(now_ns);
    if (now_ns < told_ns + 3 * kStatus_ns) return;
    told_ns = now_ns;
    node.broadcast(io::pod_message(framed(pod.status())), 16);
  };
  const auto told = check_pod(
      {.link = {.name = "pod", .board = "pod", .path = "", .can = {}}, .seconds = 1.0},
      [&](const CanBusLink&) -> Result<std::unique_ptr<io::CanPort>> { return bus.join(); }, clock);
  ASSERT_TRUE(told.ok()) << told.error().message();
  ASSERT_EQ(told.value().size(), 6u);
  EXPECT_EQ(told.value()[0], "a bus in memory");
  EXPECT_TRUE(has(told.value()[1], "between two p50 30.0")) << told.value()[1];
  EXPECT_TRUE(has(told.value()[2], "it counts 0 lost")) << told.value()[2];
  EXPECT_TRUE(has(told.value()[4], "load ")) << told.value()[4];
  EXPECT_TRUE(has(told.value()[5], "node 20 org.whirlstand.pod: 50 of 50 answers"))
      << told.value()[5];
}

}  // namespace
}  // namespace whirl::bench
