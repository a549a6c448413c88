// What the world of a flight sends over the radio, and when a command has come.
#include "base/near.hpp"
#include "harness/flight/tests/piloted_flight.hpp"

namespace whirl::flight {
namespace {

TEST(FlightWorld, SendsPosesAndCommandsOverTheRadio) {
  Flight flight;
  ASSERT_TRUE(plan::command(flight.world, table("{ arm = true }"), 0).ok());
  ASSERT_TRUE(plan::command(flight.world, table("{ takeoff = '1.1 m' }"), 0).ok());
  int poses = 0, commands = 0, targets = 0;
  io::MavlinkParser parser([&](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
    poses += frame.msgid == 104 ? 1 : 0;
    commands += frame.msgid == 76 ? 1 : 0;
    targets += frame.msgid == 84 ? 1 : 0;
  });
  for (int i = 0; i < 1000; ++i) {
    flight.step();
    io::Reader reader(flight.sensed.bytes());
    while (reader.next()) {
      if (reader.header().kind != io::Kind::uart_frame) continue;
      for (const std::uint8_t byte : reader.payload()) parser.add(byte);
    }
  }
  EXPECT_EQ(poses, 40);
  EXPECT_EQ(targets, 10);
  EXPECT_EQ(commands, 4);
}

TEST(FlightWorld, SetsAndReadsParametersOverTheRadio) {
  Flight flight;
  const char* set = "{ parameter = { name = 'EST_FILTER', value = 1 } }";
  ASSERT_TRUE(plan::command(flight.world, table(set), 0).ok());
  ASSERT_TRUE(plan::command(flight.world, table("{ parameter = { name = 'B' } }"), 0).ok());
  std::vector<std::uint32_t> sent;
  io::MavlinkParser parser([&](const io::MavlinkFrame& frame, std::span<const std::uint8_t>) {
    if (frame.msgid >= 20 && frame.msgid <= 23) sent.push_back(frame.msgid);
  });
  io::MavlinkSender vehicle{1, 1, 0};
  const auto step = [&](const io::Batch& happened) {
    io::Batch sensed;
    flight.world.step(flight.t_ns += kMs, happened, sensed);
    io::Reader reader(sensed.bytes());
    while (reader.next()) {
      if (reader.header().kind != io::Kind::uart_frame) continue;
      for (const std::uint8_t byte : reader.payload()) parser.add(byte);
    }
  };
  step({});
  EXPECT_EQ(flight.value("parameter_result"), -1.0);
  for (const char* name : {"EST_FILTER", "B"}) {
    EXPECT_EQ(flight.value("parameter_pending"), 1.0);
    io::ParamValue answer;
    answer.param_id = io::to_param_id(name);
    answer.param_value = 3.0f;
    const auto bytes = io::encode(io::pack(answer, vehicle));
    io::Batch happened;
    happened.add(io::Kind::uart_received, kRadioPort, flight.t_ns, bytes.data(),
                 static_cast<std::uint32_t>(bytes.size()));
    step(happened);
    EXPECT_EQ(flight.value("parameter_result"), name[0] == 'E' ? 2.0 : 0.0);
    EXPECT_EQ(flight.value("parameter_value"), 3.0);
  }
  EXPECT_EQ(flight.value("parameter_pending"), 0.0);
  EXPECT_EQ(sent, (std::vector<std::uint32_t>{23, 20}));
}

TEST(FlightWorld, TellsWhenACommandHasReachedTheVehiclesUart) {
  Flight flight;
  flight.run(0.1);
  EXPECT_LT(flight.world.command_on_wire_ns(), 0);
  ASSERT_TRUE(
      plan::command(flight.world, table("{ position = { height = '1 m' } }"), flight.t_ns).ok());
  std::vector<std::uint8_t> carrier;
  for (int i = 0; i < 10 && carrier.empty(); ++i) {
    flight.step();
    io::Reader reader(flight.sensed.bytes());
    while (reader.next()) {
      const bool target =
          reader.header().kind == io::Kind::uart_frame && reader.payload()[7] == 84;  // message id
      if (target) carrier.assign(reader.payload().begin(), reader.payload().end());
    }
  }
  ASSERT_FALSE(carrier.empty());
  EXPECT_LT(flight.world.command_on_wire_ns(), 0);
  io::Batch happened, sensed;
  happened.add(io::Kind::uart_delivered, kRadioPort, flight.t_ns + 123'456, carrier.data(),
               static_cast<std::uint32_t>(carrier.size()));
  flight.world.step(flight.t_ns + kMs, happened, sensed);
  EXPECT_EQ(flight.world.command_on_wire_ns(), flight.t_ns + 123'456);
}

// The radio that a second board plays: what goes up goes to it, and only what it hears counts.
TEST(FlightWorld, TheRadioMayBeOfAnotherBoard) {
  FlightParams params = hp_quad_file();
  params.ears.radios_board = 1;
  FlightWorld world(params, 1);
  ASSERT_TRUE(plan::command(world, table("{ position = { height = '1 m' } }"), 0).ok());
  io::MavlinkSender vehicle{1, 1, 0};
  io::Statustext text;
  text.text[0] = 'a';
  const auto bytes = io::encode(io::pack(text, vehicle));
  std::int64_t t_ns = 0;
  const auto texts_after_one_from = [&](std::uint8_t board) {
    io::Batch happened, sensed;
    const io::Header head{t_ns, io::Kind::uart_received, board, kRadioPort,
                          static_cast<std::uint32_t>(bytes.size())};
    EXPECT_EQ(world.hears(head), board == 1);
    happened.add(head, std::span<const std::uint8_t>(bytes));
    world.step(t_ns += kMs, happened, sensed);
    return world.told_texts().size();
  };
  EXPECT_EQ(texts_after_one_from(0), 0u);
  EXPECT_EQ(texts_after_one_from(1), 1u);
  int up = 0;
  for (int i = 0; i < 200; ++i) {
    io::Batch sensed;
    world.step(t_ns += kMs, {}, sensed);
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind != io::Kind::uart_frame) continue;
      EXPECT_EQ(r.header().board, 1);
      EXPECT_EQ(r.header().port, kRadioPort);
      ++up;
    }
  }
  EXPECT_GT(up, 0);
}

}  // namespace
}  // namespace whirl::flight
