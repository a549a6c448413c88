// Sensors that are DroneCAN nodes, as another node of their bus hears them.
#include <gtest/gtest.h>

#include <cmath>

#include "base/near.hpp"
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/protocols/dronecan/gnss.hpp"
#include "io_bridges/protocols/dronecan/imu_samples.hpp"
#include "io_bridges/protocols/dronecan/sensors.hpp"
#include "io_bridges/protocols/dronecan/vehicle_state.hpp"
#include "io_bridges/rack/tests/bench_rack.hpp"

namespace whirl::rack {
namespace {

using namespace io::dronecan;

template <typename Message>
struct Listener {
  BenchRack rack;
  io::DroneCanNode listener{rack.queue, rack.can_bus, {"listener", "org.test", -1, 10, 1e6}};
  std::vector<Message> heard;
  std::vector<Nanoseconds> when;

  explicit Listener(BoardDevice device) {
    device.bus = "can1";
    EXPECT_NE(rack.add(device), nullptr) << rack.error;
    listener.on<Message>([this](const Message& m, auto, Nanoseconds now) {
      heard.push_back(m);
      when.push_back(now);
    });
  }
  void fault(io::FaultKind kind, double from_ms, double to_ms, double value = 0.0, int axis = 0) {
    rack.book.add({.kind = kind,
                   .start_ns = static_cast<Nanoseconds>(from_ms * 1e6),
                   .end_ns = static_cast<Nanoseconds>(to_ms * 1e6),
                   .bus = 1,
                   .address = 0,
                   .axis = axis,
                   .value = value});
  }
  void forget() {
    heard.clear();
    when.clear();
  }
};

io::BodyMotion turning() {
  io::BodyMotion motion;
  motion.specific_force_B_mps2[0] = 1.0;
  motion.specific_force_B_mps2[1] = -2.0;
  motion.specific_force_B_mps2[2] = -9.8;
  motion.w_WB_B_radps[0] = 0.5;
  motion.w_WB_B_radps[1] = -1.0;
  motion.w_WB_B_radps[2] = 2.0;
  return motion;
}

template <typename Message>
void expect_body_axes(const BoardDevice& device) {
  Listener<Message> b(device);
  b.rack.send(turning());
  b.rack.run_ms(500);
  ASSERT_GT(b.heard.size(), 400u);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double a = 0.0, w = 0.0;
    for (std::size_t i = 200; i < 400; ++i) {
      a += b.heard[i].acceleration[axis] * Message::kAcceleration_step_mps2 / 200;
      w += b.heard[i].rate[axis] * Message::kRate_step_radps / 200;
    }
    const double want_a[] = {1.0, -2.0, -9.8}, want_w[] = {0.5, -1.0, 2.0};
    EXPECT_TRUE(near(a, want_a[axis], stated(1.0, "zero points, 3 sigma and scale")));
    EXPECT_TRUE(near(w, want_w[axis], stated(0.2, "zero points, 3 sigma and scale")));
  }
}

TEST(ImuOnCan, StampsTheInstantAtWhichItsPartWasReady) {
  Listener<Imu14> b({.name = "imu", .type = "mpu6000_dronecan"});
  b.rack.run_ms(200);
  std::vector<int> ready;
  for (io::Reader r(b.rack.posted.bytes()); r.next();) {
    if (r.header().kind != io::Kind::data_ready) continue;
    ready.push_back(static_cast<int>(r.header().t_ns / Imu14::kTime_step_ns) & 0xFFF);
  }
  ASSERT_GT(b.heard.size(), 100u);
  ASSERT_GE(ready.size(), b.heard.size());
  for (std::size_t i = 0; i < b.heard.size(); ++i) EXPECT_EQ(b.heard[i].time & 0xFFF, ready[i]);
}

TEST(ImuOnCan, TellsTheBodysAxesHoweverItsPartIsSoldered) {
  expect_body_axes<Imu14>({.name = "imu", .type = "mpu6000_dronecan"});
  BoardDevice turned{.name = "imu", .type = "mpu6000_dronecan"};
  turned.keys["axes"] = std::vector<std::string>{"-y", "+z", "-x"};
  turned.keys["params.message"] = std::string("imu16");
  expect_body_axes<Imu16>(turned);
}

// For firmware that is not ours.
TEST(ImuOnCan, RawImuTellsTheBodysAxesAndItsIntegralsAtARateOfAtMost250Hz) {
  BoardDevice turned{.name = "imu", .type = "mpu6000_dronecan"};
  turned.keys["axes"] = std::vector<std::string>{"-y", "+z", "-x"};
  turned.keys["params.message"] = std::string("raw");
  Listener<RawImu> b(turned);
  b.rack.send(turning());
  b.rack.run_ms(1000);
  b.forget();
  b.rack.run_ms(1000);
  ASSERT_GE(b.heard.size(), 247u);  // the part's clock is 1 % off at most
  ASSERT_LE(b.heard.size(), 253u);
  const double want_a[] = {1.0, -2.0, -9.8}, want_w[] = {0.5, -1.0, 2.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double a = 0.0, w = 0.0, v = 0.0, angle = 0.0, time_s = 0.0;
    for (const RawImu& imu : b.heard) {
      EXPECT_EQ(imu.time_us, 0u);
      a += static_cast<double>(imu.acceleration_mps2[axis]) / static_cast<double>(b.heard.size());
      w += static_cast<double>(imu.rate_radps[axis]) / static_cast<double>(b.heard.size());
      v += static_cast<double>(imu.acceleration_integral_mps[axis]);
      angle += static_cast<double>(imu.rate_integral_rad[axis]);
      time_s += static_cast<double>(imu.integration_interval_s);
    }
    EXPECT_TRUE(near(a, want_a[axis], stated(1.0, "zero points, 3 sigma and scale")));
    EXPECT_TRUE(near(w, want_w[axis], stated(0.2, "zero points, 3 sigma and scale")));
    // What the message tells twice agrees: nothing of a second is left out of its integrals, or there twice.
    EXPECT_TRUE(near(time_s, 1.0, stated(0.005, "one message more or less")));
    EXPECT_TRUE(near(v / time_s, a, stated(0.05, "float16 steps and noise of 188 Hz")));
    EXPECT_TRUE(near(angle / time_s, w, stated(0.01, "float16 steps and noise of 188 Hz")));
  }
}

TEST(ImuOnCan, RawImuComesNoOftenerThanItsKeySaysAndBeyond250HzIsRefused) {
  BoardDevice imu{.name = "imu", .type = "mpu6000_dronecan"};
  imu.keys["params.message"] = std::string("raw");
  imu.keys["params.raw_rate"] = 150.0;
  Listener<RawImu> b(imu);
  b.rack.run_ms(1000);
  b.forget();
  b.rack.run_ms(1000);
  EXPECT_GE(b.heard.size(), 141u);  // every seventh sample: 142.9 Hz, by a clock that is 1 % off
  EXPECT_LE(b.heard.size(), 145u);
  BenchRack rack;
  imu.bus = "can1";
  imu.keys["params.raw_rate"] = 251.0;
  EXPECT_EQ(rack.add(imu), nullptr);
  EXPECT_NE(rack.error.find("params.raw_rate"), std::string::npos) << rack.error;
}

TEST(ImuOnCan, StampsAreDataReadyByATenthOfAPeriodsHundredth) {
  Listener<Imu14> b({.name = "imu", .type = "mpu6000_dronecan"});
  b.rack.run_ms(300);
  ASSERT_GT(b.heard.size(), 200u);
  for (std::size_t i = 1; i < b.heard.size(); ++i) {
    const int steps = (b.heard[i].time - b.heard[i - 1].time) & 0xFFF;
    EXPECT_GE(steps, 100);  // 0.2 % of its clock: 1.002 ms
    EXPECT_LE(steps, 101);
    const auto sent_ns = b.when[i] - b.heard[i].time * Imu14::kTime_step_ns;
    const auto late_ns = sent_ns % Imu14::kTime_span_ns;
    EXPECT_GT(late_ns, 200'000);  // a burst and two frames
    EXPECT_LT(late_ns, 600'000);
  }
}

TEST(ImuOnCan, APartThatLostItsSupplyIsSetUpAnew) {
  Listener<Imu14> b({.name = "imu", .type = "mpu6000_dronecan"});
  b.fault(io::FaultKind::sensor_brown_out, 200, 205);
  b.rack.run_ms(205);
  b.forget();
  b.rack.run_ms(20);
  EXPECT_TRUE(b.heard.empty());
  b.rack.run_ms(300);
  EXPECT_GT(b.heard.size(), 100u);
  EXPECT_TRUE(b.rack.book.pending().empty());
}

TEST(AirOnCan, TellsPressureByTheSheetAndFollowsAFault) {
  Listener<StaticPressure> b({.name = "baro", .type = "ms5611_dronecan"});
  io::BodyMotion motion;
  motion.static_pressure_Pa = 95'000.0;
  motion.air_temperature_K = 278.15;
  b.fault(io::FaultKind::sensor_offset, 1500, 3000, 2000.0);
  b.rack.send(motion);
  b.rack.run_ms(1400);
  ASSERT_GT(b.heard.size(), 95u);
  EXPECT_LT(b.heard.size(), 107u);  // 75 a second
  EXPECT_TRUE(near(b.heard.back().pressure_Pa, 95'000.0, stated(450.0, "turn-on bias, 3 sigma")));
  const float before_Pa = b.heard.back().pressure_Pa;
  b.rack.run_ms(600);
  EXPECT_TRUE(near(b.heard.back().pressure_Pa - before_Pa, 2000.0, stated(30.0, "its noise")));
}

TEST(AirOnCan, TellsTemperatureInTheColdToo) {
  for (const double temperature_K : {303.15, 278.15, 253.15}) {
    Listener<StaticTemperature> b({.name = "baro", .type = "ms5611_dronecan"});
    io::BodyMotion motion;
    motion.air_temperature_K = temperature_K;
    b.rack.send(motion);
    b.rack.run_ms(500);
    ASSERT_GT(b.heard.size(), 8u);
    EXPECT_TRUE(near(b.heard.back().temperature_K, temperature_K, stated(0.13, "half precision")));
  }
}

TEST(FieldOnCan, TellsTheBodysAxesInGaussAndNothingThatOverflowed) {
  BoardDevice mag{.name = "mag", .type = "hmc5883l_dronecan"};
  mag.keys["axes"] = std::vector<std::string>{"+y", "-x", "+z"};
  Listener<MagneticFieldStrength2> b(mag);
  io::BodyMotion motion;
  motion.magnetic_field_B_T[0] = 20e-6;
  motion.magnetic_field_B_T[1] = -30e-6;
  motion.magnetic_field_B_T[2] = 45e-6;
  b.fault(io::FaultKind::sensor_saturated, 1000, 3000, 0.0, 1);
  b.rack.send(motion);
  b.rack.run_ms(500);  // the part's own first measurement, then set up
  b.forget();
  b.rack.run_ms(500);
  ASSERT_GE(b.heard.size(), 37u);  // 75 a second
  EXPECT_LE(b.heard.size(), 38u);
  const double want_Ga[] = {0.2, -0.3, 0.45};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_TRUE(near(b.heard.back().field_Ga[axis], want_Ga[axis],
                     stated(0.01, "2 mGa of noise and a count, four times")));
  }
  b.rack.run_ms(20);
  b.forget();
  b.rack.run_ms(500);
  EXPECT_TRUE(b.heard.empty());
}

TEST(GnssOnCan, TellsPlaceVelocityAndThatThereIsNoFix) {
  BoardDevice gps{.name = "gps", .type = "ublox_m8_dronecan"};
  gps.keys["params.first_fix"] = 1.0;
  Listener<Fix2> b(gps);
  io::BodyMotion motion;
  motion.v_WB_W_mps[0] = 5.0;
  motion.v_WB_W_mps[1] = -4.0;
  motion.v_WB_W_mps[2] = 3.0;
  b.fault(io::FaultKind::gnss_jammed, 6000, 9000);
  b.rack.send(motion);
  b.rack.run_ms(900);
  ASSERT_FALSE(b.heard.empty());
  EXPECT_EQ(b.heard.back().status, Fix2::no_fix);
  b.rack.run_ms(5000);
  EXPECT_GE(b.heard.size(), 25u);  // 5 Hz since its boot
  EXPECT_LE(b.heard.size(), 29u);
  const Fix2 fix = b.heard.back();
  EXPECT_EQ(fix.status, Fix2::fix_3d);
  EXPECT_TRUE(near(fix.latitude_1e8_deg * 1e-8, -35.28, stated(5e-4, "50 m")));
  EXPECT_TRUE(near(fix.longitude_1e8_deg * 1e-8, 149.13, stated(5e-4, "50 m")));
  EXPECT_TRUE(near(fix.height_ellipsoid_mm * 1e-3, 600.0, stated(60.0, "unsettled")));
  EXPECT_TRUE(near(fix.v_WB_W_mps[0], 5.0, stated(1.5, "unsettled")));
  EXPECT_TRUE(near(fix.v_WB_W_mps[1], -4.0, stated(1.5, "unsettled")));
  EXPECT_TRUE(near(fix.v_WB_W_mps[2], 3.0, stated(2.0, "unsettled")));
  ASSERT_EQ(fix.covariance.size, 6u);
  EXPECT_GT(fix.covariance.items[0], 0.0f);
  b.rack.run_ms(1500);
  EXPECT_EQ(b.heard.back().status, Fix2::no_fix);
}

TEST(BatteryOnCan, TellsThePacksVoltageAndCurrentTenTimesASecond) {
  Listener<BatteryInfo> b({.name = "battery", .type = "battery_dronecan"});
  io::BodyMotion motion;
  motion.bus_voltage_V = 15.5;
  motion.battery_current_A = 5.0;
  b.rack.send(motion);
  b.rack.run_ms(1000);
  ASSERT_EQ(b.heard.size(), 10u);
  EXPECT_TRUE(near(b.heard.back().voltage_V, 15.5, stated(0.12, "0.5 %, noise, half precision")));
  EXPECT_TRUE(near(b.heard.back().current_A, 5.0, stated(0.25, "noise, 5 sigma")));
}

TEST(SensorsOnCan, AShareOfTheBusNotMoreThanTheirMessagesNeed) {
  for (const auto& [message, most] : {std::pair{"imu14", 0.32}, {"imu16", 0.43}}) {
    BenchRack rack;
    BoardDevice imu{.name = "imu", .type = "mpu6000_dronecan", .bus = "can1"};
    imu.keys["params.message"] = std::string(message);
    ASSERT_NE(rack.add(imu), nullptr) << rack.error;
    io::DroneCanNode other(rack.queue, rack.can_bus, {"other", "org.test", -1, 11, 1e6});
    double busy_ns = 0.0;
    rack.can_bus.on_transfer(
        [&](const io::CanTransfer& t) { busy_ns += static_cast<double>(t.end_ns - t.start_ns); });
    rack.run_ms(200);
    busy_ns = 0.0;
    rack.run_ms(1000);
    EXPECT_GT(busy_ns, 0.24e9);
    EXPECT_LT(busy_ns, most * 1e9);
  }
}

}  // namespace
}  // namespace whirl::rack
