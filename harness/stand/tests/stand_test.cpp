// The stand against a board that is played by hand: what it sends, hears and weighs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/near.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/plan/requests.hpp"
#include "harness/stand/stand_world.hpp"
#include "plant/motor/motor_params.hpp"

namespace whirl::stand {
namespace {

constexpr std::int64_t kMs = 1'000'000;

lua::Table table(const std::string& text) {
  auto read = lua::read_text("return " + text, "plan.lua");
  EXPECT_TRUE(read.ok());
  return read.value();
}

const std::string kPropellers = std::string(WHIRL_SOURCE_FOLDER) + "/test_plans/propellers";

StandParams params(const std::string& text = R"({ prop = "hk_10x4.5", supply = "16 V" })") {
  auto read = catalogue::read_stand(table(text), kPropellers);
  EXPECT_TRUE(read.ok()) << read.error().message();
  return read.value();
}

// The golden frame of esc_stream_test.cpp: 16.25 V, 418.5 rad/s, inflow 0.0625, converged.
const std::vector<std::uint8_t> kFrame = {
    0xA5, 0x5A, 0x01, 0xA5, 0x78, 0x56, 0x34, 0x12, 0x00, 0x00, 0x82, 0x41, 0x00, 0x00,
    0xC0, 0x3F, 0x00, 0x00, 0x80, 0x3E, 0x00, 0x00, 0xA0, 0x3F, 0x00, 0x00, 0xA0, 0x40,
    0x00, 0x00, 0xE0, 0x3E, 0x00, 0x40, 0xD1, 0x43, 0x00, 0x00, 0xD2, 0x43, 0x00, 0x00,
    0x48, 0xC1, 0x00, 0x00, 0xAE, 0x41, 0xB0, 0x0F, 0xA1, 0x34, 0xBD, 0x37, 0x86, 0x37,
    0x00, 0x00, 0x30, 0x40, 0x00, 0x00, 0x80, 0x3D, 0x00, 0x04, 0x41, 0x05, 0xB4, 0x2E};

struct Bench {
  explicit Bench(const StandParams& stand = params()) : world(stand, 1) {}

  // Runs until t with the shaft at a speed; keeps what was sent.
  void run_until(std::int64_t to_ns, double speed_radps, double source_A = 0.0) {
    for (; t_ns <= to_ns; t_ns += kMs) {
      io::Batch happened, sensed;
      io::ShaftState shaft;
      shaft.speed_radps = speed_radps;
      shaft.source_current_A = source_A;
      happened.add(io::Kind::shaft_state, 1, t_ns, shaft);
      for (const io::I2cReplyHead& head : replies) {
        happened.add(io::Kind::i2c_reply, 2, t_ns - kMs / 2, head);
      }
      replies.clear();
      if (!serial.empty()) {
        happened.add(io::Kind::uart_received, 1, t_ns - kMs / 2, serial.data(),
                     static_cast<std::uint32_t>(serial.size()));
        serial.clear();
      }
      world.step(t_ns, happened, sensed);
      for (io::Reader r(sensed.bytes()); r.next();) keep(r);
    }
  }
  void keep(const io::Reader& r) {
    if (r.header().kind == io::Kind::uart_frame)
      typed.append(r.payload().begin(), r.payload().end());
    if (r.header().kind == io::Kind::pulse_train) trains.push_back(r.as<io::PulseTrain>());
    if (r.header().kind == io::Kind::shaft_load) load = r.as<io::ShaftLoad>();
    if (r.header().kind != io::Kind::i2c_order) return;
    const auto order = r.as<io::I2cOrder>();
    const auto bytes = r.tail_after(sizeof order);
    if (!bytes.empty()) {
      writes_ns.push_back(r.header().t_ns);
      last_write.assign(bytes.begin(), bytes.end());
    } else {
      reads_ns.push_back(r.header().t_ns);
    }
    if (answers) replies.push_back({.number = order.number, .acked = 1});
  }
  double signal(const std::string& name) const {
    std::vector<double> values(world.signals().size());
    world.read(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (world.signals()[i].name == name) return values[i];
    }
    ADD_FAILURE() << name;
    return std::nan("");
  }

  StandWorld world;
  io::ShaftLoad load;
  std::vector<std::int64_t> writes_ns, reads_ns;
  std::vector<std::uint8_t> last_write;
  std::vector<io::I2cReplyHead> replies;
  std::vector<io::PulseTrain> trains;
  std::vector<std::uint8_t> serial;  // from the board in the next step
  std::string typed;                 // to it
  bool answers = false;
  std::int64_t t_ns = 0;
};

TEST(Stand, WritesAtFiftyAndReadsAtTwentyHertz) {
  Bench b;
  b.run_until(1099 * kMs, 0.0);
  EXPECT_EQ(b.writes_ns.size(), 50u);  // in [0.1 s, 1.1 s)
  EXPECT_EQ(b.reads_ns.size(), 20u);
  // Zero, as the protocol writes it: hi, lo, CRC-8 (polynomial 7) over 0x52, 0, 0.
  EXPECT_EQ(b.last_write, (std::vector<std::uint8_t>{0x00, 0x00, 0xF2}));
}

TEST(Stand, FloodsTheWireAsFastAsItIsTold) {
  Bench b;
  b.run_until(199 * kMs, 0.0);
  b.writes_ns.clear();
  ASSERT_TRUE(plan::command(b.world, table(R"({ setpoint_rate = "10 kHz" })"), b.t_ns).ok());
  b.run_until(202 * kMs, 0.0);
  ASSERT_EQ(b.writes_ns.size(), 30u);  // those of the three steps that begin at 200, 201, 202 ms
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(b.writes_ns[i], 200 * kMs + static_cast<std::int64_t>(i) * 100'000);
  }
}

// A quarter of the pack sags under 2 A as the whole one under 8 A.
TEST(Stand, AShareOfThePackSagsAsTheWholeUnderAllMotors) {
  Bench whole(params(R"({ prop = "hk_10x4.5", battery = "4s_2200" })"));
  Bench share(params(R"({ prop = "hk_10x4.5", battery = { pack = "4s_2200", share = "25 %" } })"));
  whole.run_until(20'000 * kMs, 400.0, 8.0);
  share.run_until(20'000 * kMs, 400.0, 2.0);
  EXPECT_LT(whole.load.source_V, 16.6);
  EXPECT_TRUE(near(share.load.source_V, whole.load.source_V, round_off(1000, 16.0)));
  EXPECT_TRUE(near(2.0 * share.load.source_ohm, 8.0 * whole.load.source_ohm, round_off(4, 1.0)));
}

TEST(Stand, CommandIsOnTheWireOnceItsOwnWriteWasAnswered) {
  Bench b;
  b.answers = true;
  b.run_until(200 * kMs, 0.0);
  ASSERT_TRUE(plan::command(b.world, table(R"({ thrust = "2 N" })"), b.t_ns).ok());
  EXPECT_LT(b.world.command_on_wire_ns(), 0);
  b.run_until(218 * kMs, 0.0);
  EXPECT_LT(b.world.command_on_wire_ns(), 0);  // the next write is due at 220 ms
  b.run_until(221 * kMs, 0.0);
  EXPECT_EQ(b.world.command_on_wire_ns(), 220 * kMs + kMs / 2);
}

TEST(Stand, DowndraftTakesThrustAndUpdraftGivesIt) {
  Bench b;
  b.run_until(1000 * kMs, 400.0);
  const double calm_N = b.signal("thrust");
  EXPECT_GT(calm_N, 1.0);
  ASSERT_TRUE(plan::disturb(b.world, table(R"({ down = "3 m/s", edge = "100 ms" })"), b.t_ns).ok());
  b.run_until(1051 * kMs, 400.0);
  EXPECT_TRUE(near(b.signal("wind"), 1.5, stated(1e-9, "half of the ramp")));
  b.run_until(2000 * kMs, 400.0);
  EXPECT_LT(b.signal("thrust"), 0.85 * calm_N);
  ASSERT_TRUE(plan::disturb(b.world, table(R"({ down = "-1 m/s" })"), b.t_ns).ok());
  b.run_until(4000 * kMs, 400.0);
  EXPECT_GT(b.signal("thrust"), calm_N);
}

TEST(Stand, TellsTheTorqueThatTheAirTakesAndTheSupply) {
  Bench b;
  b.run_until(1000 * kMs, 400.0);
  EXPECT_TRUE(near(b.load.torque_Nm_s2 * 400.0 * 400.0, b.signal("torque"), round_off(1, 4)));
  EXPECT_EQ(b.load.source_V, 16.0);
  EXPECT_EQ(b.load.source_ohm, 0.01);
}

TEST(Stand, BatteryLosesTheChargeThatTheBridgeTakes) {
  Bench b(params(R"({ prop = "hk_10x4.5", battery = "4s_2200" })"));
  b.run_until(1000 * kMs, 400.0, 10.0);
  EXPECT_TRUE(near(b.signal("charge_used"), 10.0, stated(1e-6, "a thousand sums")));
  EXPECT_LT(b.load.source_V, 16.80);
}

TEST(Stand, DipLowersTheSupplyWhileItLasts) {
  Bench b;
  FaultSpec dip;
  dip.number = 7;
  dip.kind = "supply_dip";
  dip.start_ns = 100 * kMs;
  dip.end_ns = 200 * kMs;
  dip.value = 4.0;
  ASSERT_TRUE(b.world.take_fault(dip).value());
  FaultSpec other;
  other.kind = "i2c_nack";
  EXPECT_FALSE(b.world.take_fault(other).value());  // the board's
  b.run_until(50 * kMs, 0.0);
  EXPECT_TRUE(b.world.applied_faults().empty());
  b.run_until(150 * kMs, 0.0);
  EXPECT_EQ(b.load.source_V, 12.0);
  b.run_until(250 * kMs, 0.0);
  EXPECT_EQ(b.load.source_V, 16.0);
  EXPECT_EQ(b.world.applied_faults(), std::vector<std::uint32_t>{7});
}

// What the plan says of motor and shunt, and nothing else, goes to the power stage of that motor.
TEST(Stand, MotorAndShuntOfThePlanReachTheBoardsPowerStage) {
  const StandParams stand = params(R"({ prop = "hk_10x4.5", supply = "16 V",
      motor = { inertia = "+12 %", resistance = "90 mohm", kv_rpm_per_V = 950 },
      shunt = { gain = "-5 %" } })");
  BoardDescription board;
  board.devices = {{.name = "terminal", .type = "serial"},
                   {.name = "stage",
                    .type = "power_stage",
                    .motor = 1,
                    .keys = {{"params.inductance", 2e-5},
                             {"params.resistance", 1.0},
                             {"params.shunt.gain", 0.1}}}};  // which the part's own error replaces
  const auto set = set_stage(board, stand.esc.motor, stand.stage);
  ASSERT_TRUE(set) << set.error().message();
  EXPECT_TRUE(board.devices[0].keys.empty());
  const auto& stage = board.devices[1].keys;
  EXPECT_EQ(stage.size(), 5u);
  const auto is = [&](const char* key, double want) {
    const auto it = stage.find(std::string("params.") + key);
    ASSERT_NE(it, stage.end()) << key;
    EXPECT_TRUE(near(std::get<double>(it->second), want, round_off(4, want))) << key;
  };
  is("inductance", 2e-5);
  is("resistance", 0.09);
  is("inertia", 1.12 * plant::MotorParams{}.inertia_kgm2);
  is("torque_constant", 60.0 / (2.0 * std::numbers::pi * 950.0));
  is("shunt.gain_error", -0.05);
  EXPECT_FALSE(set_stage(board, 2, stand.stage));  // no such motor
}

TEST(Stand, RawTransfersGoOutAsTheyStandAndMoveThroughTheirMillisecond) {
  Bench b;
  b.run_until(200 * kMs, 0.0);
  b.writes_ns.clear();
  ASSERT_TRUE(plan::command(b.world,
                            table(R"({ silence = true, i2c_raw = { bytes = "5A 3 c1 00", times = 3,
                                      every = "7 ms", shift = "400 us" } })"),
                            b.t_ns)
                  .ok());
  b.run_until(300 * kMs, 0.0);
  EXPECT_EQ(b.last_write, (std::vector<std::uint8_t>{0x5A, 0x03, 0xC1, 0x00}));
  const std::int64_t first = 201 * kMs + kMs / 4;
  EXPECT_EQ(b.writes_ns, (std::vector<std::int64_t>{first, first + 7 * kMs + 400'000,
                                                    first + 14 * kMs - 200'000}));
  EXPECT_FALSE(plan::command(b.world, table(R"({ i2c_raw = { bytes = "5A G1" } })"), b.t_ns).ok());
  EXPECT_FALSE(plan::command(b.world, table("{ i2c_raw = {} }"), b.t_ns).ok());
}

TEST(Stand, PulsesCarryTheSetPointsAndNothingIsWrittenOverI2c) {
  Bench b(params(
      R"({ prop = "hk_10x4.5", supply = "16 V", throttle = "pwm", pulse_rate = "400 Hz" })"));
  b.run_until(200 * kMs, 0.0);
  EXPECT_TRUE(b.writes_ns.empty());
  EXPECT_FALSE(b.reads_ns.empty());
  ASSERT_EQ(b.trains.size(), 1u);
  EXPECT_EQ(b.trains[0].width_ns, 1'000'000);
  EXPECT_EQ(b.trains[0].period_ns, 2'500'000);
  ASSERT_TRUE(
      plan::command(b.world, table(R"({ thrust = "8 N" })"), b.t_ns).ok());  // the mode's end
  b.run_until(210 * kMs, 0.0);
  ASSERT_EQ(b.trains.size(), 2u);
  EXPECT_EQ(b.trains[1].width_ns, 1'950'000);
  ASSERT_TRUE(plan::command(b.world, table("{ silence = true }"), b.t_ns).ok());
  b.run_until(220 * kMs, 0.0);
  ASSERT_EQ(b.trains.size(), 3u);
  EXPECT_EQ(b.trains[2].width_ns, 0);
  const auto wrong = table(R"({ pulses = { width = "3 ms", rate = "400 Hz" } })");
  EXPECT_FALSE(plan::command(b.world, wrong, b.t_ns).ok());
}

TEST(Stand, StreamedSignalsAreNoNumbersBeforeAndLongAfterAFrame) {
  Bench b;
  b.run_until(10 * kMs, 0.0);
  EXPECT_TRUE(std::isnan(b.signal("esc_speed")));
  b.serial = kFrame;
  b.run_until(20 * kMs, 0.0);
  EXPECT_EQ(b.signal("esc_speed"), 418.5);
  EXPECT_EQ(b.signal("esc_inflow"), 0.0625);
  EXPECT_EQ(b.signal("esc_observable"), 1.0);
  b.run_until(105 * kMs, 0.0);
  EXPECT_EQ(b.signal("esc_bus_voltage"), 16.25);
  b.run_until(115 * kMs, 0.0);
  EXPECT_TRUE(std::isnan(b.signal("esc_bus_voltage")));
  EXPECT_EQ(b.signal("esc_frames_lost"), 0.0);
}

TEST(Stand, LinesGoOutWithTheirEndAndAnswersAreKept) {
  Bench b;
  ASSERT_TRUE(b.world.say("get kt"));
  b.run_until(10 * kMs, 0.0);
  EXPECT_EQ(b.typed, "get kt\r\n");
  for (const char c : std::string("kt 1e-2\r\nok\r\n"))
    b.serial.push_back(static_cast<std::uint8_t>(c));
  b.run_until(20 * kMs, 0.0);
  EXPECT_EQ(b.world.heard(), (std::vector<std::string>{"kt 1e-2", "ok"}));
}

TEST(Stand, TheEchoOfALineIsNoAnswer) {
  Bench b;
  const auto hear = [&b](const std::string& text, int until_ms) {
    for (const char c : text) b.serial.push_back(static_cast<std::uint8_t>(c));
    b.run_until(until_ms * kMs, 0.0);
  };
  ASSERT_TRUE(b.world.say("get kt"));
  b.run_until(1 * kMs, 0.0);
  hear("> get kt\r\nkt 1e-2\r\n", 10);
  EXPECT_EQ(b.world.heard(), (std::vector<std::string>{"kt 1e-2"}));
  hear("get kt\r\n", 20);  // said by itself, later: no echo any more
  EXPECT_EQ(b.world.heard().size(), 2u);
}

TEST(Stand, WhatComesBeforeAQuestionIsSentIsNoAnswerToIt) {
  Bench b;
  const auto hear = [&b](const std::string& text) {
    for (const char c : text) b.serial.push_back(static_cast<std::uint8_t>(c));
  };
  b.run_until(5 * kMs, 0.0);
  ASSERT_TRUE(b.world.say("get kt"));
  hear("of before\r\n");  // arrives with the step that sends the question
  b.run_until(6 * kMs, 0.0);
  EXPECT_TRUE(b.world.heard().empty());
  hear("kt 1e-2\r\n");
  b.run_until(7 * kMs, 0.0);
  EXPECT_EQ(b.world.heard(), std::vector<std::string>{"kt 1e-2"});
}

TEST(Stand, ALateAnswerIsNotTakenForThatToTheNextQuestion) {
  Bench b;
  ASSERT_TRUE(b.world.say("get kt"));
  b.run_until(10 * kMs, 0.0);
  const auto refused = b.world.say("get kv");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what,
            "'get kt' is not answered yet: what it says late could not be told from the answer to "
            "'get kv'");
  b.run_until(11 * kMs, 0.0);
  EXPECT_EQ(b.typed, "get kt\r\n");
  for (const char c : std::string("kt 1e-2\r\n")) b.serial.push_back(static_cast<std::uint8_t>(c));
  b.run_until(12 * kMs, 0.0);
  EXPECT_TRUE(b.world.say("get kv"));  // now it is answered
}

// Typed by t:command: it is answered, too.
TEST(Stand, ALineThatNobodyAsksAboutIsAQuestionToo) {
  Bench b;
  ASSERT_TRUE(plan::command(b.world, table("{ line = 'mode 0' }"), 0));
  ASSERT_TRUE(plan::command(b.world, table("{ line = 'mode 1' }"), 0));
  for (int ms = 10; ms <= 12; ++ms) {
    b.run_until(ms * kMs, 0.0);
    EXPECT_EQ(b.world.say("get kt").ok(), ms == 12);
    for (const char c : {'o', 'k', '\r', '\n'}) b.serial.push_back(static_cast<std::uint8_t>(c));
  }
}

TEST(Stand, WhatAFlightDoesIsRefusedByItsKey) {
  Bench b;
  const auto refusal = [](const Result<Done>& done) {
    return done ? "none" : done.error().message();
  };
  const auto command = [&](const char* text) {
    return refusal(plan::command(b.world, table(text), 0));
  };
  const auto disturb = [&](const char* text) {
    return refusal(plan::disturb(b.world, table(text), 0));
  };
  EXPECT_EQ(command("{ arm = true }"), "plan.lua:1: arm: means nothing to a stand");
  EXPECT_EQ(command("{ takeoff = '1 m' }"), "plan.lua:1: takeoff: means nothing to a stand");
  EXPECT_EQ(disturb("{ down = '2 m/s', after = '1 s' }"),
            "plan.lua:1: after: means nothing to a stand");
  EXPECT_EQ(disturb("{ east = '2 m/s' }"),
            "plan.lua:1: east: the stand's flow goes along the shaft only (down)");
  EXPECT_EQ(disturb("{ down = '21 m/s' }"),
            "plan.lua:1: down: must be at least -20 at most 20 (SI)");
  EXPECT_EQ(disturb("{ jet = { up = '3 m/s', radius = '35 cm' } }"),
            "plan.lua:1: jet: means nothing to a stand");
}

TEST(Stand, MistakesAreNamed) {
  const auto complaint = [](const std::string& text) {
    const auto read = catalogue::read_stand(table(text), kPropellers);
    return read ? "none" : read.error().message();
  };
  EXPECT_NE(complaint(R"({ prop = "hk_10x4.5" })").find("battery or a supply"), std::string::npos);
  EXPECT_NE(complaint(R"({ prop = "hk_99", supply = "16 V" })").find("hk_99"), std::string::npos);
  EXPECT_NE(complaint(R"({ prop = "hk_10x4.5", supply = "16 V", moed = "rpm" })").find("moed"),
            std::string::npos);
  const auto motor = [&](const std::string& inner) {
    return complaint(R"({ prop = "hk_10x4.5", supply = "16 V", motor = { )" + inner + " } }");
  };
  EXPECT_NE(motor(R"(inertai = "+12 %")").find("motor.inertai"), std::string::npos);
  EXPECT_NE(motor(R"(inertia = "12 V")").find("kg m2"), std::string::npos);
  EXPECT_NE(motor(R"(inertia = "-100 %")").find("outside"), std::string::npos);
  EXPECT_NE(motor(R"(resistance = "0 ohm")").find("positive"), std::string::npos);
  Bench b;
  const auto wrong = plan::command(b.world, table(R"({ duty = "20 %" })"), 0);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message().find("mode"), std::string::npos);
}

}  // namespace
}  // namespace whirl::stand
