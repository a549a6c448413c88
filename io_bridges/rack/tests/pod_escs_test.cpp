// What the host of a pod makes of the ESCs that the pod plays.
#include "io_bridges/rack/devices/pod_escs.hpp"

#include <gtest/gtest.h>

#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

struct Rig {
  BenchRack rack;
  std::vector<std::vector<std::uint8_t>> frames;
  PodEscs escs{rack, [this](std::vector<std::uint8_t> frame) { frames.push_back(frame); }};

  void state(std::uint16_t motor, const io::EscState& state) {
    io::Batch batch;
    batch.add(io::Kind::esc_state, motor, 0, state);
    io::Reader reader(batch.bytes());
    ASSERT_TRUE(reader.next());
    escs.on_message(reader);
  }
  std::vector<std::pair<int, io::EscSetpoint>> told() {
    std::vector<std::pair<int, io::EscSetpoint>> all;
    for (io::Reader r(rack.posted.bytes()); r.next();) {
      if (r.header().kind == io::Kind::esc_setpoint) {
        all.emplace_back(r.header().port, r.as<io::EscSetpoint>());
      }
    }
    return all;
  }
};

TEST(PodEscs, AnEscsStateGoesToItsPartInTheCountsOfTheBus) {
  Rig rig;
  rig.state(3, {.bus_current_A = -0.1, .speed_rpm = 4001.0, .flags = 0x83});
  rig.rack.run_ms(20.0);
  // The third of four in 20 ms, and the only one that the harness has told of.
  ASSERT_EQ(rig.frames.size(), 1u);
  EXPECT_EQ(rig.frames[0], io::pack_pod_esc(0, 2, -100, 4001, 0x83));
  rig.rack.run_ms(100.0);
  EXPECT_EQ(rig.frames.size(), 6u);
}

TEST(PodEscs, NothingIsToldToThePodOfEscsThatNobodyPlays) {
  Rig rig;
  rig.rack.run_ms(100.0);
  EXPECT_TRUE(rig.frames.empty());
}

TEST(PodEscs, ASetPointIsItsMotorsAndARefusedOneIsNone) {
  Rig rig;
  rig.escs.told({.esc = 0, .valid = true, .value = 2047});
  rig.rack.run_ms(1.0);
  rig.escs.told({.esc = 3, .valid = false, .value = 700});
  rig.escs.told({.esc = 4, .valid = true, .value = 700});  // there is none
  const auto told = rig.told();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].first, 1);
  EXPECT_EQ(told[0].second.value, 2047);
  EXPECT_EQ(told[0].second.valid, 1);
  EXPECT_EQ(told[1].first, 4);
  EXPECT_EQ(told[1].second.value, 0);
  EXPECT_EQ(told[1].second.valid, 0);
  EXPECT_EQ(told[1].second.start_ns, 1'000'000);
  EXPECT_EQ(rig.escs.setpoints(), 2u);
  EXPECT_EQ(rig.escs.refused(), 1u);
}

}  // namespace
}  // namespace whirl::rack
