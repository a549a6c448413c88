#include "firmware/link/telemetry.hpp"
#include "base/near.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "base/near.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw {
namespace {

using mavlink::Message;

struct Downlink {
  std::map<std::uint32_t, int> frames;
  std::size_t bytes = 0;
  std::vector<mavlink::Frame> all;
};

// Runs the link's slots (5 ms) and reads back what comes down.
Downlink listen(Telemetry& telemetry, int slots, std::uint32_t from_ms = 0) {
  Downlink down;
  mavlink::Parser parser;
  for (int i = 0; i < slots; ++i) {
    const auto frame = telemetry.next(from_ms + 5 * static_cast<std::uint32_t>(i), {}, {});
    down.bytes += frame.size();
    for (const std::uint8_t byte : frame) {
      if (!parser.push(byte)) continue;
      ++down.frames[parser.frame().id];
      down.all.push_back(parser.frame());
    }
  }
  return down;
}

void send_command(Telemetry& telemetry, std::uint16_t command, float param1, float param7) {
  Message m(mavlink::kCommandLong, 33);
  m.put(0, param1).put(24, param7).put(28, command).put<std::uint8_t>(30, 1);
  telemetry.receive(m.frame(255, 190, 0));
}

TEST(Telemetry, KeepsTheRatesOfTheRadioPlan) {
  Flight flight;
  Telemetry telemetry(flight);
  const Downlink down = listen(telemetry, 2000);
  EXPECT_EQ(down.frames.at(mavlink::kHeartbeat), 10);
  EXPECT_EQ(down.frames.at(mavlink::kSysStatus), 10);
  EXPECT_EQ(down.frames.at(mavlink::kAttitudeQuaternion), 200);
  EXPECT_EQ(down.frames.at(mavlink::kLocalPositionNed), 100);
  EXPECT_EQ(down.frames.at(mavlink::kHighresImu), 20);
  EXPECT_EQ(down.frames.at(mavlink::kDebugFloatArray), 100);
}

// 57600 baud carry 5760 B/s both ways together. Up: 40 poses of 44 bytes and 10 targets of 65 are
// 2410 B/s; 80 % of the whole leaves 2198 B/s down.
TEST(Telemetry, LeavesAFifthOfTheHalfDuplexRadioFree) {
  Flight flight;
  Telemetry telemetry(flight);
  test::VehicleModel vehicle({});
  vehicle.run(flight, 3.0);  // real numbers, so that truncation does not flatter
  listen(telemetry, 200, 1000);
  EXPECT_LT(listen(telemetry, 2000, 3000).bytes / 10, 2198u);
}

TEST(Telemetry, AnswersEveryCommandOnceWithItsResult) {
  Flight flight;
  Telemetry telemetry(flight);
  for (const auto& [command, result] : std::map<std::uint16_t, int>{{400, 1}, {21, 2}, {999, 3}}) {
    send_command(telemetry, command, 1.0f, 0.0f);
    int acks = 0;
    for (const mavlink::Frame& frame : listen(telemetry, 100).all) {
      if (frame.id != mavlink::kCommandAck) continue;
      ++acks;
      EXPECT_EQ(frame.get<std::uint16_t>(0), command);
      EXPECT_EQ(frame.get<std::uint8_t>(2), result) << command;
    }
    EXPECT_EQ(acks, 1) << command;
  }
}

TEST(Telemetry, CommandsForOthersAreNotOurs) {
  Flight flight;
  Telemetry telemetry(flight);
  Message m(mavlink::kCommandLong, 33);
  m.put<std::uint16_t>(28, 400).put<std::uint8_t>(30, 7);
  telemetry.receive(m.frame(255, 190, 0));
  EXPECT_EQ(listen(telemetry, 100).frames.count(mavlink::kCommandAck), 0u);
}

TEST(Telemetry, ArmsByCommandAndTellsItsState) {
  Flight flight;
  Telemetry telemetry(flight);
  test::VehicleModel vehicle({});
  vehicle.run(flight, 3.0);
  const auto heartbeat = [&] {
    mavlink::Frame last;
    for (const mavlink::Frame& frame : listen(telemetry, 200).all) {
      if (frame.id == mavlink::kHeartbeat) last = frame;
    }
    return last;
  };
  EXPECT_EQ(heartbeat().get<std::uint8_t>(7), 3);  // standby
  send_command(telemetry, 400, 1.0f, 0.0f);
  EXPECT_EQ(heartbeat().get<std::uint32_t>(0), 1u);
  EXPECT_NE(heartbeat().get<std::uint8_t>(6) & 0x80, 0);
  EXPECT_EQ(heartbeat().get<std::uint8_t>(7), 4);
  send_command(telemetry, 400, 0.0f, 0.0f);
  EXPECT_EQ(heartbeat().get<std::uint8_t>(6) & 0x80, 0);
}

TEST(Telemetry, PosesOverTheRadioReachTheEstimate) {
  Flight flight;
  Telemetry telemetry(flight);
  Message m(mavlink::kViconPositionEstimate, 32);
  m.put(8, 1.0f).put(12, -2.0f).put(16, -0.5f).put(28, 0.7f);
  telemetry.receive(m.frame(255, 190, 0));
  EXPECT_EQ(flight.estimator().p_WB_W_m(), Vector3(1.0f, -2.0f, -0.5f));
  EXPECT_TRUE(flight.estimator().position_known());
}

// Bits of the mask: 0 to 2 place, 3 to 5 velocity, 6 to 8 acceleration are to be ignored.
void send_target(Telemetry& telemetry, std::uint16_t mask, float x, float vx) {
  Message m(mavlink::kSetPositionTargetLocalNed, 53);
  m.put(4, x).put(12, -1.1f).put(16, vx).put(48, mask);
  m.put<std::uint8_t>(50, 1).put<std::uint8_t>(52, 1);
  telemetry.receive(m.frame(255, 190, 0));
}

// 1.1 m high, 6 s after the take-off.
struct TelemetryAloft : ::testing::Test {
  TelemetryAloft() {
    vehicle.run(flight, 3.0);
    EXPECT_EQ(flight.arm(), Reason::none);
    EXPECT_EQ(flight.take_off(1.1f), Reason::none);
    vehicle.run(flight, 6.0);
  }
  Flight flight;
  Telemetry telemetry{flight};
  test::VehicleModel vehicle{{}};
};

TEST_F(TelemetryAloft, ATargetIsAPlaceAVelocityOrAPointOfATrajectoryByItsMask) {
  const auto fly = [&](std::uint16_t mask, float x, float vx) {
    for (int i = 0; i < 10; ++i) {
      send_target(telemetry, mask, x, vx);
      vehicle.run(flight, 0.1);
    }
  };
  fly(0x09C3, 5.0f, 0.5f);  // velocity: the place along the floor counts for nothing
  EXPECT_TRUE(
      whirl::near(flight.reference().v_W_mps().x(), 0.5, whirl::stated(0.02, "1 s of 1.2 m/s2")));
  EXPECT_FALSE(flight.reference().tracking());
  fly(0x09F8, 0.5f, 0.5f);  // a place: the velocity counts for nothing
  vehicle.run(flight, 2.0);
  EXPECT_TRUE(
      whirl::near(flight.reference().p_W_m().x(), 0.5, whirl::stated(0.05, "the approach's end")));
  fly(0x0800, 0.5f, 0.0f);
  EXPECT_TRUE(flight.reference().tracking());
  fly(0x0800, 3.0f, 0.0f);  // too far to be joined: it goes there first
  EXPECT_FALSE(flight.reference().tracking());
}

TEST_F(TelemetryAloft, ATrajectoryFarAwayIsAPlaceToGoToFirst) {
  send_target(telemetry, 0x0800, 1.0f, 0.0f);
  vehicle.run(flight, 0.1);
  EXPECT_FALSE(flight.reference().tracking());
  for (int i = 0; i < 40; ++i) {
    send_target(telemetry, 0x0800, 1.0f, 0.0f);
    vehicle.run(flight, 0.1);
  }
  EXPECT_TRUE(flight.reference().tracking());
}

// What no vehicle flies is no point of a trajectory; and where the points stop, it stays.
TEST_F(TelemetryAloft, AnAbsurdTrajectoryIsNotFlownAndOneThatStopsIsLeft) {
  for (const float vx : {40.0f, -1e25f}) {
    for (int i = 0; i < 10; ++i) {
      send_target(telemetry, 0x0800, flight.reference().p_W_m().x(), vx);
      vehicle.run(flight, 0.1);
    }
    EXPECT_FALSE(flight.reference().tracking()) << vx;
    EXPECT_LT(vehicle.v_W_.norm(), 0.2) << vx;
  }
  send_target(telemetry, 0x0800, 0.0f, 0.8f);
  vehicle.run(flight, 0.1);
  EXPECT_TRUE(flight.reference().tracking());
  vehicle.run(flight, 1.9);
  EXPECT_FALSE(flight.reference().tracking());
  EXPECT_LT(vehicle.v_W_.norm(), 0.3);
  EXPECT_LT(vehicle.p_W_.x(), 1.2);
}

TEST(Telemetry, ANonFinitePoseIsNotFlown) {
  Flight flight;
  Telemetry telemetry(flight);
  Message m(mavlink::kViconPositionEstimate, 32);
  m.put(8, std::nanf(""));
  telemetry.receive(m.frame(255, 190, 0));
  EXPECT_FALSE(flight.estimator().position_known());
}

// STATUSTEXT after the two seconds that a card has to come up, and bit 24 of SYS_STATUS' health
// (MAV_SYS_STATUS_LOGGING).
TEST(Telemetry, SaysThatThereIsNoLogOnceAndInItsHealth) {
  Flight flight;
  Telemetry telemetry(flight);
  mavlink::Parser parser;
  int texts = 0;
  std::uint32_t health_of_log = 0;
  const auto listen_s = [&](std::uint32_t from_s, std::uint32_t to_s, const char* trouble) {
    for (std::uint32_t ms = 1000 * from_s; ms < 1000 * to_s; ms += 5) {
      for (const std::uint8_t byte : telemetry.next(ms, {}, {.log_trouble = trouble})) {
        if (!parser.push(byte)) continue;
        const mavlink::Frame& frame = parser.frame();
        if (frame.id == mavlink::kSysStatus) health_of_log = frame.get<std::uint32_t>(8) >> 24 & 1;
        const std::string words(frame.payload.begin() + 1, frame.payload.begin() + 4);
        if (frame.id == mavlink::kStatustext && words == "log") ++texts;
      }
    }
  };
  listen_s(0, 2, "log: no SD card");
  EXPECT_EQ(texts, 0);
  EXPECT_EQ(health_of_log, 0u);
  listen_s(2, 5, "log: no SD card");
  EXPECT_EQ(texts, 1);
  listen_s(5, 7, nullptr);
  EXPECT_EQ(texts, 1);
  EXPECT_EQ(health_of_log, 1u);
}

}  // namespace
}  // namespace fw
