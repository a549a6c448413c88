#include "harness/flight/parameter_requests.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "harness/flight/tests/station_air.hpp"

namespace whirl::flight {
namespace {

struct ParameterAir : Air {
  void answer(const std::string& name, float value) {
    io::ParamValue message;
    message.param_id = io::to_param_id(name);
    message.param_value = value;
    vehicle_says(message, 0);
  }
  const ParameterRequests& parameters() const { return station.parameters(); }
};

TEST(ParameterRequests, AValueIsSentEvery300msUntilItsNameAnswers) {
  ParameterAir air;
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
  ParameterAir air;
  air.station.request_parameter("EST_FILTER", 5.0f);
  air.run(0, 1);
  air.answer("EST_FILTER", 1.0f);
  EXPECT_EQ(air.parameters().last_result(), 2);
  EXPECT_EQ(air.parameters().last_value(), 1.0);
}

TEST(ParameterRequests, WithoutAValueItIsAskedForByName) {
  ParameterAir air;
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
  ParameterAir air;
  air.station.request_parameter("NOBODY", 1.0f);
  air.run(0, 6000);
  EXPECT_EQ(air.parameters().last_result(), -1);
  air.run(6000, 6100);
  EXPECT_EQ(air.sent.size(), 20u);
  EXPECT_EQ(air.parameters().last_result(), -2);
  EXPECT_FALSE(air.parameters().pending());
}

TEST(ParameterRequests, GoOneAfterTheOtherAndANewOneForgetsTheOldAnswer) {
  ParameterAir air;
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
