// A board's CAN devices without the board: what the microcontroller hears of them, and they of it.
#include "io_bridges/rack/can_rack.hpp"

#include <gtest/gtest.h>

#include "io_bridges/protocols/dronecan/assembler.hpp"
#include "io_bridges/protocols/dronecan/esc.hpp"
#include "io_bridges/protocols/dronecan/transfer.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

namespace dc = io::dronecan;
constexpr Nanoseconds kMs = 1'000'000;

BoardDescription board_with(std::vector<BoardDevice> devices) {
  BoardDescription board;
  board.name = "afar";
  board.devices = std::move(devices);
  return board;
}

struct Rig {
  std::vector<io::CanFrame> heard;
  CanRack rack{2, 1e6, 1, [this](const io::CanFrame& frame) { heard.push_back(frame); }};

  std::vector<std::uint16_t> setpoints() {
    std::vector<std::uint16_t> all;
    for (io::Reader r(rack.happened().bytes()); r.next();) {
      if (r.header().kind == io::Kind::esc_setpoint) all.push_back(r.as<io::EscSetpoint>().value);
    }
    return all;
  }
  // Of esc.Status, the speeds.
  std::vector<int> speeds() const {
    dc::Assembler assembler(
        [](dc::Kind, std::uint16_t id) {
          return id == dc::EscStatus::kType.id ? &dc::EscStatus::kType : nullptr;
        },
        10);
    std::vector<int> all;
    for (const io::CanFrame& frame : heard) {
      const dc::Transfer* whole = assembler.take(frame, 0);
      if (whole == nullptr || whole->header.type_id != dc::EscStatus::kType.id) continue;
      if (const auto status = dc::decode<dc::EscStatus>(whole->payload)) {
        all.push_back(status->speed_rpm);
      }
    }
    return all;
  }
};

TEST(CanRack, ACommandFromAfarReachesItsEscAndTheStatusComesBack) {
  Rig rig;
  const BoardDevice esc{.name = "esc2", .type = "esc_dronecan", .bus = "can2", .motor = 2};
  ASSERT_TRUE(rig.rack.build(board_with({esc}), device_types()).ok());
  rig.rack.events().run_until(5 * kMs);  // before its first status
  io::Batch sensed;
  sensed.add(io::Kind::esc_state, 2, 5 * kMs, io::EscState{.speed_rpm = 2222});
  sensed.add(io::Kind::esc_state, 1, 5 * kMs, io::EscState{.speed_rpm = 1111});  // another's
  for (io::Reader r(sensed.bytes()); r.next();) rig.rack.on_message(r);
  dc::RawCommand command;
  command.commands.add(400);
  command.commands.add(800);
  const dc::Payload payload = dc::encode(command);
  const dc::Header header{dc::Kind::message, dc::RawCommand::kType.id, 5, 10, 0, 0};
  for (const io::CanFrame& frame :
       dc::frames_of(header, dc::RawCommand::kType.signature, payload.bytes())) {
    rig.rack.give(frame);
  }
  rig.rack.events().run_until(100 * kMs);
  EXPECT_EQ(rig.setpoints(), std::vector<std::uint16_t>{200});  // four steps are one
  ASSERT_FALSE(rig.speeds().empty());
  EXPECT_EQ(rig.speeds().back(), 2222);
}

TEST(CanRack, DevicesOfOtherBusesStayWithTheBoard) {
  Rig rig;
  const BoardDevice here{.name = "esc1", .type = "esc_dronecan", .bus = "can2", .motor = 1},
      there{.name = "esc2", .type = "esc_dronecan", .bus = "can1", .motor = 2},
      card{.name = "card", .type = "sd_card", .bus = "spi3"};
  ASSERT_TRUE(rig.rack.build(board_with({card, there, here}), device_types()).ok());
  EXPECT_EQ(rig.rack.devices(), 1u);
}

TEST(CanRack, EveryFrameIsToldWithWhoSentIt) {
  Rig rig;
  const BoardDevice esc{.name = "esc1", .type = "esc_dronecan", .bus = "can2", .motor = 1};
  ASSERT_TRUE(rig.rack.build(board_with({esc}), device_types()).ok());
  rig.rack.events().run_until(kMs);
  rig.rack.give({.id = 0x123, .length = 2, .data = {1, 2}});
  rig.rack.events().run_until(100 * kMs);
  int ours = 0, afar = 0;
  for (io::Reader r(rig.rack.happened().bytes()); r.next();) {
    if (r.header().kind != io::Kind::can_transfer) continue;
    EXPECT_EQ(r.header().port, 2);
    EXPECT_EQ(r.as<io::CanRecord>().error, 0);
    (r.as<io::CanRecord>().sender == -1 ? afar : ours) += 1;
  }
  EXPECT_EQ(afar, 1);
  EXPECT_EQ(static_cast<std::size_t>(ours), rig.heard.size());
  EXPECT_GT(ours, 3);  // esc.Status is three frames, 20 times a second
}

TEST(CanRack, AFaultActsOnItsPartAloneAndIsTold) {
  Rig rig;
  const BoardDevice card{.name = "card", .type = "sd_card", .bus = "spi3"},
      first{.name = "esc1", .type = "esc_dronecan", .bus = "can2", .motor = 1},
      second{.name = "esc2", .type = "esc_dronecan", .bus = "can2", .motor = 2};
  ASSERT_TRUE(rig.rack.build(board_with({card, first, second}), device_types()).ok());
  io::FaultCommand cut;
  cut.number = 5;
  cut.kind = static_cast<std::uint32_t>(*io::fault_kind("can_cut"));
  cut.start_ns = 200 * kMs;
  cut.end_ns = 400 * kMs;
  cut.bus = 2;
  cut.address = 2;  // esc2's place on the board
  io::Batch order;
  order.add(io::Kind::fault, 5, 0, cut);
  io::Reader reader(order.bytes());
  ASSERT_TRUE(reader.next());
  rig.rack.on_message(reader);
  rig.rack.events().run_until(600 * kMs);
  int applied = 0, of_first = 0, of_second = 0;
  for (io::Reader r(rig.rack.happened().bytes()); r.next();) {
    if (r.header().kind == io::Kind::fault_applied) applied += r.header().port == 5 ? 1 : 100;
    if (r.header().kind != io::Kind::can_transfer) continue;
    const auto record = r.as<io::CanRecord>();
    const bool within = record.start_ns > 210 * kMs && record.start_ns < 390 * kMs;
    if (within && record.error == 0) ++(record.sender == 1 ? of_first : of_second);
  }
  EXPECT_EQ(applied, 1);
  EXPECT_GT(of_first, 9);
  EXPECT_EQ(of_second, 0);
}

}  // namespace
}  // namespace whirl::rack
