// The bridge between a world and a client's socket, without an emulator.
#include "harness/live/live_flight.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "harness/live/tests/live_tools.hpp"

namespace whirl::live {
namespace {

// Keeps what goes to its radio.
struct RadioWorld final : World {
  std::vector<Signal> all{{"told_armed", Dimension::none, ""}, {"height", Dimension::length, ""}};
  std::vector<Bytes> radio;
  std::vector<request::Sticks> sticks;
  const std::vector<Signal>& signals() const override { return all; }
  void read(std::span<double> values) const override {
    values[0] = 1.0;
    values[1] = 1.5;
  }
  void step(std::int64_t, const io::Batch&, io::Batch&) override {}
  Result<Done> command(const Command& command, std::int64_t) override {
    if (const auto* bytes = std::get_if<request::Radio>(&command)) {
      radio.push_back(bytes->bytes);
      return Done{};
    }
    if (const auto* given = std::get_if<request::Sticks>(&command)) {
      sticks.push_back(*given);
      return Done{};
    }
    return not_understood("a radio", word(command));
  }
  Result<Done> disturb(const Disturbance&, std::int64_t) override { return Done{}; }
  Result<bool> take_fault(const FaultSpec&) override { return false; }
  std::vector<std::uint32_t> applied_faults() const override { return {}; }
  std::string status() const override { return ""; }
};

class Bridge : public ::testing::Test {
 protected:
  static UdpPort port_to(std::uint16_t port) {
    return std::move(UdpPort::open("127.0.0.1:" + std::to_string(port), 0).value());
  }

  void open(LiveOptions options = {}) {
    options.wants_end = [this] { return wants_end_; };
    options.show = [this](const std::string& line) { shown_.push_back(line); };
    UdpPort port = port_to(client_.own_port());
    to_flight_.emplace(port_to(port.own_port()));
    flight_.emplace(clock_, std::move(port), options);
  }
  bool turn(std::int64_t ms) { return flight_->turn(ms * kMs, world_).value(); }
  void happen(io::Kind kind, std::uint16_t port, const Bytes& bytes, std::int64_t ms) {
    io::Batch happened;
    happened.add(kind, port, ms * kMs, bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    flight_->on_happened(ms * kMs, happened, world_);
  }

  ToldClock clock_;
  RadioWorld world_;
  UdpPort client_ = port_to(9);
  std::optional<UdpPort> to_flight_;
  std::optional<LiveFlight> flight_;
  bool wants_end_ = false;
  std::vector<std::string> shown_;
};

TEST_F(Bridge, WhatComesGoesIntoTheRadioAndIntoTheRecordingPieceByPiece) {
  open();
  Bytes two = heartbeat();
  two.insert(two.end(), {1, 2, 3});
  to_flight_->send(two);
  EXPECT_TRUE(turn(50));
  EXPECT_EQ(world_.radio, (std::vector<Bytes>{heartbeat(), {1, 2, 3}}));
  EXPECT_EQ(flight_->recording().pieces(), 2u);
}

TEST_F(Bridge, SticksAreGivenAsTheyChange) {
  request::Sticks held;
  held.thrust = 0.25;
  LiveOptions options;
  options.sticks = [&held] { return held; };
  open(options);
  EXPECT_TRUE(turn(0));
  EXPECT_TRUE(turn(20));
  EXPECT_EQ(world_.sticks.size(), 1u);
  held.thrust = 0.5;
  EXPECT_TRUE(turn(30));  // looked at each 20 ms
  EXPECT_EQ(world_.sticks.size(), 1u);
  EXPECT_TRUE(turn(40));
  ASSERT_EQ(world_.sticks.size(), 2u);
  held.transmitter_on = false;
  EXPECT_TRUE(turn(60));
  ASSERT_EQ(world_.sticks.size(), 3u);
  EXPECT_FALSE(world_.sticks[2].transmitter_on);
}

TEST_F(Bridge, FramesGoOutOneToADatagramAndTextOfATerminalDoesNot) {
  open();
  happen(io::Kind::uart_received, 2, heartbeat(), 1);
  happen(io::Kind::uart_received, 1, {'o', 'k'}, 2);
  happen(io::Kind::uart_delivered, 2, heartbeat(), 3);
  const auto datagram = client_.receive();
  ASSERT_TRUE(datagram.has_value());
  EXPECT_EQ(Bytes(datagram->begin(), datagram->end()), heartbeat());
  EXPECT_FALSE(client_.receive().has_value());
}

TEST_F(Bridge, AFloodLosesWhatTheSerialLineDoesNotCarryAndIsToldOf) {
  open();
  for (std::int64_t ms = 0; ms < 1000; ++ms) {
    to_flight_->send(Bytes(1400, 0x41));
    turn(ms);
  }
  std::size_t carried = 0;
  for (const Bytes& piece : world_.radio) carried += piece.size();
  EXPECT_GT(carried, 5000u);
  EXPECT_LE(carried, 5760u + 1024u);
  EXPECT_NE(flight_->summary()[1].find("1000 datagrams in"), std::string::npos);
  EXPECT_EQ(flight_->summary()[1].find(" 0 B dropped"), std::string::npos);
}

TEST_F(Bridge, GarbageTakesNoFramesPlace) {
  open();
  for (std::int64_t ms = 0; ms < 1000; ++ms) {
    to_flight_->send(Bytes(1400, 0x41));
    if (ms % 100 == 99) to_flight_->send(heartbeat());
    to_flight_->send(Bytes(9000, 0xFD));
    turn(ms);
  }
  EXPECT_EQ(std::count(world_.radio.begin(), world_.radio.end(), heartbeat()), 10);
}

TEST_F(Bridge, EndsAtItsTimeOrWhenItIsAskedTo) {
  LiveOptions options;
  options.end_ns = 10 * kMs;
  open(options);
  EXPECT_TRUE(turn(9));
  EXPECT_FALSE(turn(10));
  EXPECT_EQ(flight_->ended_ns(), 10 * kMs);
  open();
  wants_end_ = true;
  EXPECT_FALSE(turn(1));
}

TEST_F(Bridge, ShowsItsStateOnceASecondOfTheHost) {
  LiveOptions options;
  options.pace = 2.0;
  open(options);
  for (std::int64_t ms = 0; ms <= 5000; ++ms) {
    turn(ms);
    happen(io::Kind::uart_delivered, 2, {}, ms);
  }
  ASSERT_EQ(shown_.size(), 3u);  // at 0, 1 and 2 s of the host's 2.5
  EXPECT_NE(shown_[1].find("armed     silent"), std::string::npos) << shown_[1];
  EXPECT_NE(shown_[1].find("height  1.50 m"), std::string::npos) << shown_[1];
}

TEST_F(Bridge, AFrameOfMavlink1GoesOutAsWell) {
  open();
  const Bytes old{0xFE, 2, 0, 51, 68, 0, 7, 7, 8, 8};  // as radios tell their own state
  happen(io::Kind::uart_received, 2, old, 20);
  const auto out = client_.receive();
  ASSERT_TRUE(out);
  EXPECT_EQ(Bytes(out->begin(), out->end()), old);
}

// Its client is said to be at 127.0.0.2, and 127.0.0.1 sends.
TEST_F(Bridge, WhatAnotherHostSendsIsLeftOutWhereTheClientOnlyIsHeard) {
  for (const bool client_only : {true, false}) {
    world_.radio.clear();
    LiveOptions options;
    options.client_only = client_only;
    options.wants_end = [] { return false; };
    UdpPort port = std::move(UdpPort::open("127.0.0.2:9", 0).value());
    UdpPort other = port_to(port.own_port());
    LiveFlight flight(clock_, std::move(port), options);
    other.send(heartbeat());
    ASSERT_TRUE(flight.turn(0, world_).value());
    EXPECT_EQ(world_.radio.size(), client_only ? 0u : 1u);
    EXPECT_EQ(flight.summary().size(), client_only ? 3u : 2u);
    if (client_only) {
      EXPECT_EQ(flight.summary().back(),
                "UDP: 1 datagrams of another host than the client's were left out");
    }
  }
}

TEST_F(Bridge, TheClientsHostIsHeardFromAnyPort) {
  LiveOptions options;
  options.client_only = true;
  open(options);
  to_flight_->send(heartbeat());
  EXPECT_TRUE(turn(0));
  EXPECT_EQ(world_.radio.size(), 1u);
}

TEST_F(Bridge, OfABenchWaitsForNobodyAndSaysNothingOfItsPace) {
  LiveOptions options;
  options.waits = false;
  open(options);
  const std::int64_t begin_ns = clock_.now_ns();
  turn(1);
  turn(2000);
  happen(io::Kind::uart_delivered, 2, {}, 2000);
  EXPECT_EQ(clock_.now_ns(), begin_ns);
  ASSERT_EQ(shown_.size(), 1u);
  EXPECT_EQ(shown_[0].find("late"), std::string::npos) << shown_[0];
  ASSERT_EQ(flight_->summary().size(), 1u);
  EXPECT_EQ(flight_->summary()[0].rfind("UDP: ", 0), 0u);
}

}  // namespace
}  // namespace whirl::live
