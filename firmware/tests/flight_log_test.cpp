// What the flight log writes, as a reader by other hands finds it (results/flight_log).
#include "firmware/log/flight_log.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "base/near.hpp"
#include "firmware/tests/vehicle_model.hpp"
#include "results/flight_log/ulog.hpp"

namespace fw {
namespace {

using whirl::results::ULog;

// A volume whose card takes `per_ms` bytes each millisecond out of a buffer.
struct PretendedVolume {
  bool append(std::span<const std::uint8_t> record) {
    if (record.size() > room()) return false;
    held += record.size();
    file.insert(file.end(), record.begin(), record.end());
    return true;
  }
  std::size_t room() const { return state() == LogState::logging ? 16384 - held : 0; }
  LogState state() const { return is_open ? LogState::logging : LogState::closed; }
  std::uint32_t files() const { return count; }
  void open() {
    is_open = true;
    begin_file();
  }
  void begin_file() {
    ++count;
    file.clear();
    held = 0;
  }
  void close() { is_open = false; }

  std::vector<std::uint8_t> file;
  std::size_t held = 0, per_ms = 200;
  bool is_open = false;
  std::uint32_t count = 0;
};

struct Rig {
  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i, ++tick) {
      vehicle.step(flight);
      now_us += 1000;
      TickTimes::keep_worst(times.start_us, 150);
      TickTimes::keep_worst(times.setpoint_us, 250);
      TickTimes::keep_worst(times.tick_us, 400);
      log.step(tick, now_us, 123, 7, times);
      volume.held -= std::min(volume.held, volume.per_ms);
    }
  }
  void arm() {
    run(3000);
    ASSERT_EQ(flight.arm(), Reason::none) << text_of(flight.ready_to_arm());
  }
  ULog read() const { return whirl::results::read_ulog(volume.file); }

  test::VehicleModel vehicle{{}};
  Flight flight;
  PretendedVolume volume;
  FlightLog<PretendedVolume> log{volume, flight};
  TickTimes times;
  std::uint32_t tick = 0, now_us = 5000;
};

std::set<std::uint64_t> steps_of(const std::vector<std::uint64_t>& times) {
  std::set<std::uint64_t> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.insert(times[i] - times[i - 1]);
  return steps;
}

TEST(FlightLog, LastsFromArmingToThreeSecondsAfterDisarming) {
  Rig rig;
  rig.arm();
  EXPECT_FALSE(rig.volume.is_open);
  rig.run(500);
  EXPECT_TRUE(rig.volume.is_open);
  ASSERT_EQ(rig.flight.disarm(), Reason::none);
  rig.run(2999);
  EXPECT_TRUE(rig.volume.is_open);
  rig.run(5);
  EXPECT_FALSE(rig.volume.is_open);
}

TEST(FlightLog, ThreeOfTwentyMillisecondsAreSampledAndNoneIsMissing) {
  Rig rig;
  rig.arm();
  rig.run(2000);
  const ULog log = rig.read();
  EXPECT_EQ(log.damage, "");
  EXPECT_TRUE(log.closed);
  EXPECT_TRUE(log.dropouts.empty());
  for (const char* name : {"vehicle_attitude", "sensor_combined", "vehicle_angular_velocity",
                           "vehicle_local_position", "actuator_outputs"}) {
    const auto& times = log.topics.at(name).time_us;
    EXPECT_GT(times.size(), 280u) << name;  // of 300, less the first ticks
    EXPECT_EQ(steps_of(times), (std::set<std::uint64_t>{6000, 7000})) << name;
  }
  EXPECT_EQ(steps_of(log.topics.at("cpuload").time_us), std::set<std::uint64_t>{100'000});
}

TEST(FlightLog, SaysWhatTheFlightKnows) {
  Rig rig;
  rig.arm();
  rig.run(500);
  ASSERT_EQ(rig.flight.take_off(1.1f), Reason::none);
  rig.run(1500 + 18 - static_cast<int>(rig.tick % 20));  // the last of them was tick 17
  rig.run(1);                                            // 18: sampled
  const ULog log = rig.read();
  const Estimator& seen = rig.flight.estimator();
  const auto last = [&log](const char* topic, const char* column) {
    return log.topics.at(topic).columns.at(column).back();
  };
  EXPECT_EQ(last("vehicle_attitude", "q[0]"), double{seen.q_WB().w()});
  EXPECT_EQ(last("vehicle_attitude", "q[3]"), double{seen.q_WB().z()});
  EXPECT_EQ(last("vehicle_local_position", "z"), double{seen.p_WB_W_m().z()});
  EXPECT_EQ(last("vehicle_local_position", "vx"), double{seen.v_WB_W_mps().x()});
  EXPECT_EQ(last("vehicle_angular_velocity", "xyz[1]"), double{seen.w_WB_B_radps().y()});
  EXPECT_EQ(last("sensor_combined", "accelerometer_m_s2[2]"), double{seen.imu().a_B_mps2.z()});
  EXPECT_EQ(last("actuator_outputs", "output[2]"), static_cast<double>(rig.flight.setpoints()[2]));
  EXPECT_EQ(last("flight_status", "state"), static_cast<double>(FlightState::flying));
  EXPECT_EQ(last("flight_timing", "setpoint_us"), 250.0);
  EXPECT_EQ(last("flight_timing", "deadlines_missed"), 7.0);
  EXPECT_EQ(last("cpuload", "load"), double{0.001f * 123.0f});
  EXPECT_EQ(log.infos.at("ver_hw"), "PX4FMU_V1");
  EXPECT_EQ(log.parameters.at("MAG_DECLINATION"), double{12.4f});
  ASSERT_FALSE(log.texts.empty());
  EXPECT_EQ(log.texts.back().words, text_of(Reason::commanded));
}

TEST(FlightLog, AParameterThatIsSetInFlightIsLogged) {
  Rig rig;
  rig.arm();
  rig.run(500);
  EXPECT_EQ(rig.read().parameters.at("EST_START_SCALE"), 1.0);
  ASSERT_TRUE(rig.flight.parameters().set(Parameter::est_start_scale, 1.25f));
  rig.run(50);
  EXPECT_EQ(rig.read().parameters.at("EST_START_SCALE"), 1.25);
}

TEST(FlightLog, ACardThatPausesTooLongCostsSamplesThatTheLogOwnsUpTo) {
  Rig rig;
  rig.arm();
  rig.run(500);
  rig.volume.per_ms = 0;
  rig.run(1500);
  rig.volume.per_ms = 200;
  rig.run(500);
  const ULog log = rig.read();
  EXPECT_EQ(log.damage, "");
  ASSERT_EQ(log.dropouts.size(), 1u);
  EXPECT_EQ(rig.log.dropouts(), 1u);
  // 16 KiB last for 0.6 s; after a pause of 1.5 s some 0.9 s are missing.
  EXPECT_TRUE(whirl::near(log.dropouts[0].duration_ms, 900,
                          whirl::stated(100, "the card's pause, 900 ms")));
  const auto& times = log.topics.at("vehicle_attitude").time_us;
  for (std::size_t i = 1; i < times.size(); ++i) {
    std::uint64_t gap_us = times[i] - times[i - 1];
    if (log.dropouts[0].after_us >= times[i - 1] && log.dropouts[0].after_us < times[i]) {
      gap_us -= 1000u * log.dropouts[0].duration_ms;
    }
    EXPECT_LE(gap_us, 7000u) << i;
  }
}

TEST(FlightLog, ANewFileBeginsAsTheFirstDid) {
  Rig rig;
  rig.arm();
  rig.run(500);
  rig.volume.begin_file();  // as after a card that was pulled and put in again
  rig.run(500);
  const ULog log = rig.read();
  EXPECT_EQ(log.damage, "");
  EXPECT_GT(log.topics.at("vehicle_attitude").time_us.size(), 60u);
  EXPECT_EQ(log.parameters.size(), kParameterCount);
}

}  // namespace
}  // namespace fw
