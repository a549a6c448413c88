#include "harness/flight/parameter_requests.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "harness/flight/station.hpp"

namespace whirl::flight {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// A station, what it sends, and a vehicle that answers by hand.
struct Air {
  Station station;
  std::vector<io::MavlinkFrame> sent;
  std::vector<std::int64_t> times;
  io::MavlinkSender vehicle{1, 1, 0};
  io::MavlinkParser parser{
      [this](const io::MavlinkFrame& f, std::span<const std::uint8_t>) { sent.push_back(f); }};

  void run(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms; ms < to_ms; ++ms) {
      station.step(ms * kMs, [this](std::int64_t t_ns, std::span<const std::uint8_t> frame) {
        times.push_back(t_ns);
        for (const std::uint8_t byte : frame) parser.add(byte);
      });
    }
  }
  void answer(const std::string& name, float value) {
    io::ParamValue message;
    message.param_id = io::to_param_id(name);
    message.param_value = value;
    station.receive(io::encode(io::pack(message, vehicle)), 0);
  }
  const ParameterRequests& parameters() const { return station.parameters(); }
};

TEST(ParameterRequests, AValueIsSentEvery300msUntilItsNameAnswers) {
  Air air;
  air.station.request_parameter("EST_START_SCALE", 1.25f);
  air.run(0, 700);
  ASSERT_EQ(air.sent.size(), 3u);
  EXPECT_EQ(air.times[2], 600 * kMs);
  const auto set = io::unpack<io::ParamSet>(air.sent[2]);
  ASSERT_TRUE(set);
  EXPECT_EQ(io::param_name(set->param_id), "EST_START_SCALE");
  EXPECT_EQ(set->param_value, 1.25f);
  EXPECT_EQ(set->param_type, 9);  // MAV_PARAM_TYPE_REAL32
  EXPECT_EQ(set->target_system, 1);
  EXPECT_EQ(set->target_component, 1);
  air.answer("EST_START_TILT", 1.25f);
  EXPECT_TRUE(air.parameters().pending());
  EXPECT_EQ(air.parameters().last_result(), -1);
  air.answer("EST_START_SCALE", 1.25f);
  EXPECT_FALSE(air.parameters().pending());
  EXPECT_EQ(air.parameters().last_result(), 0);
  EXPECT_EQ(air.parameters().last_value(), 1.25);
  air.run(700, 2000);
  EXPECT_EQ(air.sent.size(), 3u);
}

TEST(ParameterRequests, AnotherValueInTheAnswerIsARefusal) {
  Air air;
  air.station.request_parameter("EST_FILTER", 5.0f);
  air.run(0, 1);
  air.answer("EST_FILTER", 1.0f);
  EXPECT_EQ(air.parameters().last_result(), 2);
  EXPECT_EQ(air.parameters().last_value(), 1.0);
}

TEST(ParameterRequests, WithoutAValueItIsAskedForByName) {
  Air air;
  air.station.request_parameter("EST_FILTER", std::nullopt);
  air.run(0, 1);
  ASSERT_EQ(air.sent.size(), 1u);
  const auto read = io::unpack<io::ParamRequestRead>(air.sent[0]);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->param_index, -1);
  EXPECT_EQ(io::param_name(read->param_id), "EST_FILTER");
  air.answer("EST_FILTER", 1.0f);
  EXPECT_EQ(air.parameters().last_result(), 0);
  EXPECT_EQ(air.parameters().last_value(), 1.0);
}

TEST(ParameterRequests, WhatIsNeverAnsweredIsGivenUpAfterTwentyTries) {
  Air air;
  air.station.request_parameter("NOBODY", 1.0f);
  air.run(0, 6000);
  EXPECT_EQ(air.parameters().last_result(), -1);
  air.run(6000, 6100);
  EXPECT_EQ(air.sent.size(), 20u);
  EXPECT_EQ(air.parameters().last_result(), -2);
  EXPECT_FALSE(air.parameters().pending());
}

TEST(ParameterRequests, GoOneAfterTheOtherAndANewOneForgetsTheOldAnswer) {
  Air air;
  air.station.request_parameter("EST_FILTER", 1.0f);
  air.run(0, 1);
  air.answer("EST_FILTER", 1.0f);
  air.station.request_parameter("EST_START_TILT", 2.0f);
  EXPECT_EQ(air.parameters().last_result(), -1);
  EXPECT_TRUE(std::isnan(air.parameters().last_value()));
  air.answer("EST_START_TILT", 0.0f);  // of an earlier list: nothing was asked yet
  EXPECT_TRUE(air.parameters().pending());
  air.station.request_parameter("CTL_FEEDFWD", 0.0f);
  air.run(1, 10);
  ASSERT_EQ(air.sent.size(), 2u);
  air.answer("EST_START_TILT", 2.0f);
  air.run(10, 20);
  ASSERT_EQ(air.sent.size(), 3u);
  EXPECT_EQ(io::param_name(io::unpack<io::ParamSet>(air.sent[2])->param_id), "CTL_FEEDFWD");
}

}  // namespace
}  // namespace whirl::flight
