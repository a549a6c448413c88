// The check of a bench's CAN bus against nodes that are played on a bus in memory, on a clock that passes as it waits.
#include "harness/target/bench/can_check.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/local_node.hpp"
#include "io_bridges/socketcan/tests/memory_can.hpp"

namespace whirl::bench {
namespace {

namespace dc = io::dronecan;
constexpr std::int64_t kMillisecond = 1'000'000;

struct Esc {  // answers 3 ms late, and tells its status each 20 ms
  Esc(io::MemoryCan& bus, std::uint8_t id)
      : port(bus.join()), node(id, "org.example.esc", [this](const io::CanFrame& frame) {
          waiting.emplace_back(now_ns + 3 * kMillisecond, frame);
        }) {}
  void turn(std::int64_t t_ns) {
    now_ns = t_ns;
    node.poll(t_ns);
    while (const auto got = port->receive().value()) {
      if (!got->own) node.on_frame(got->frame, t_ns);
    }
    if (t_ns % (20 * kMillisecond) == 0) node.broadcast(dc::EscStatus{}, 16);
    while (!waiting.empty() && waiting.front().first <= t_ns) {
      std::ignore = port->send(waiting.front().second);
      waiting.erase(waiting.begin());
    }
  }
  std::unique_ptr<io::CanPort> port;
  std::int64_t now_ns = 0;
  std::vector<std::pair<std::int64_t, io::CanFrame>> waiting;
  dc::LocalNode node;
};

struct PlayedClock final : pacing::HostClock {
  std::int64_t t_ns = 1'000'000'000;
  std::vector<std::unique_ptr<Esc>> escs;
  std::int64_t now_ns() const override { return t_ns; }
  void sleep_until(std::int64_t until_ns) override { t_ns = until_ns; }
  void wait_for(std::span<pollfd> files, std::int64_t) override {
    if (poll(files.data(), files.size(), 0) > 0) return;
    t_ns += kMillisecond;
    for (const auto& esc : escs) esc->turn(t_ns);
  }
};

struct CheckRig {
  ~CheckRig() { clock.escs.clear(); }  // they leave the bus while it stands
  PlayedClock clock;
  io::MemoryCan bus{[this] { return clock.t_ns; }};
  std::unique_ptr<io::CanPort> port = bus.join();
  Result<std::vector<std::string>> check() {
    return check_can_bus(*port, clock, {.interface = "can0", .seconds = 1.5, .requests = 10});
  }
};

TEST(CanCheck, ABusWithoutNodesIsMissingSomething) {
  CheckRig rig;
  const auto told = rig.check();
  ASSERT_FALSE(told.ok());
  EXPECT_EQ(told.error().kind, ErrorKind::bad_input);
  EXPECT_NE(told.error().message().find("no DroneCAN node"), std::string::npos);
}

TEST(CanCheck, EachNodeIsToldWithItsNameAndHowFastItAnswers) {
  CheckRig rig;
  rig.clock.escs.push_back(std::make_unique<Esc>(rig.bus, 20));
  const auto told = rig.check();
  ASSERT_TRUE(told.ok()) << told.error().message();
  ASSERT_EQ(told.value().size(), 2u);
  EXPECT_NE(told.value()[0].find("load "), std::string::npos);
  const std::string& node = told.value()[1];
  EXPECT_NE(node.find("node 20 org.example.esc: 10 of 10 answers"), std::string::npos) << node;
  EXPECT_NE(node.find("esc.Status each p50 20.00"), std::string::npos) << node;
}

TEST(CanCheck, TwoNodesOfOneIdAreSaid) {
  CheckRig rig;
  rig.clock.escs.push_back(std::make_unique<Esc>(rig.bus, 20));
  rig.clock.escs.push_back(std::make_unique<Esc>(rig.bus, 20));
  rig.clock.escs[0]->node.poll(-300'000'000'000);  // it has been there for five minutes
  rig.clock.escs[0]->waiting.clear();
  const auto told = rig.check();
  ASSERT_TRUE(told.ok());
  EXPECT_NE(told.value()[1].find("TWO NODES"), std::string::npos) << told.value()[1];
}

}  // namespace
}  // namespace whirl::bench
