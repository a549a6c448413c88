#include "firmware/link/parameter_link.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "firmware/link/telemetry.hpp"
#include "firmware/tests/vehicle_model.hpp"

namespace fw {
namespace {

using mavlink::Message;

struct Value {
  std::string name;
  float value;
  unsigned count, index, type, component;
};

constexpr int kLong = static_cast<int>(10 * kParameterCount + 100);  // slots for a whole list

// The vehicle's end of the radio: what goes up, and the PARAM_VALUEs that come down.
struct Radio {
  Flight flight;
  Telemetry telemetry{flight};
  mavlink::Parser parser;
  std::size_t bytes = 0, frames = 0;

  void send(Message message) { telemetry.receive(message.frame(255, 190, 0)); }
  std::vector<Value> listen(int slots = 200) {
    std::vector<Value> values;
    for (int i = 0; i < slots; ++i) {
      const auto frame = telemetry.next(1000, {}, {});
      bytes += frame.size();
      for (const std::uint8_t byte : frame) {
        if (!parser.push(byte)) continue;
        ++frames;
        if (parser.frame().id == mavlink::kParamValue) values.push_back(value_of(parser.frame()));
      }
    }
    return values;
  }
  static Value value_of(const mavlink::Frame& f) {
    const auto name = f.get<std::array<char, 16>>(8);
    return {{name.data(), strnlen(name.data(), 16)},
            f.get<float>(0),
            f.get<std::uint16_t>(4),
            f.get<std::uint16_t>(6),
            f.get<std::uint8_t>(24),
            f.component};
  }
};

void put_name(Message& message, std::size_t offset, const std::string& name) {
  for (std::size_t i = 0; i < name.size() && i < 16; ++i) message.put(offset + i, name[i]);
}

Message list(std::uint8_t system = 1, std::uint8_t component = 1) {
  return Message(mavlink::kParamRequestList, 2).put(0, system).put(1, component);
}
Message read(const std::string& name, std::int16_t index = -1, std::uint8_t system = 1) {
  Message m(mavlink::kParamRequestRead, 20);
  m.put(0, index).put(2, system).put<std::uint8_t>(3, 1);
  put_name(m, 4, name);
  return m;
}
Message set(const std::string& name, float value, std::uint8_t type = 9, std::uint8_t system = 1) {
  Message m(mavlink::kParamSet, 23);
  m.put(0, value).put(4, system).put<std::uint8_t>(5, 1).put(22, type);
  put_name(m, 6, name);
  return m;
}

TEST(ParameterLink, AListTellsEachOnceInOrderWithIndexAndCount) {
  Radio radio;
  radio.send(list());
  const auto values = radio.listen(kLong);
  ASSERT_EQ(values.size(), kParameterCount);
  for (unsigned i = 0; i < kParameterCount; ++i) {
    EXPECT_EQ(values[i].name, kParameterTable[i].name);
    EXPECT_EQ(values[i].value, kParameterTable[i].start);
    EXPECT_EQ(values[i].index, i);
    EXPECT_EQ(values[i].count, kParameterCount);
    EXPECT_EQ(values[i].type, 9u);  // MAV_PARAM_TYPE_REAL32
    EXPECT_EQ(values[i].component, 1u);
  }
}

TEST(ParameterLink, ReadsByNameAndByIndex) {
  Radio radio;
  radio.send(read("EST_START_SCALE"));
  auto values = radio.listen();
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(values[0].index, 1u);
  radio.send(read("", 0));
  values = radio.listen();
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(values[0].name, "EST_FILTER");
}

TEST(ParameterLink, SetsAndAnswersWithTheNewValue) {
  Radio radio;
  radio.send(set("EST_START_SCALE", 1.25f));
  const auto values = radio.listen();
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(values[0].name, "EST_START_SCALE");
  EXPECT_EQ(values[0].value, 1.25f);
  EXPECT_EQ(radio.flight.parameters().get(Parameter::est_start_scale), 1.25f);
}

TEST(ParameterLink, WhatIsRefusedIsAnsweredWithTheOldValue) {
  for (const Message& refused :
       {set("EST_START_SCALE", 1.75f), set("EST_START_SCALE", std::nanf("")),
        set("EST_START_SCALE", -1.0f), set("EST_START_SCALE", 1.25f, 6)}) {  // 6: INT32
    Radio radio;
    radio.send(refused);
    const auto values = radio.listen();
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].value, 1.0f);
  }
}

TEST(ParameterLink, UnknownNamesAndIndicesAndOthersRequestsGetNoAnswer) {
  Radio radio;
  radio.send(read("EST_FILTERS"));
  radio.send(read("_HASH_CHECK"));
  radio.send(read("EST_FILTER", static_cast<std::int16_t>(kParameterCount)));
  radio.send(read("EST_FILTER", -2));
  radio.send(set("NOBODY", 1.0f));
  radio.send(read("EST_FILTER", -1, 2));
  radio.send(set("EST_FILTER", 1.0f, 9, 2));
  radio.send(list(2));
  radio.send(list(1, 50));
  EXPECT_TRUE(radio.listen().empty());
  EXPECT_EQ(radio.flight.parameters().changes(), 0u);
}

TEST(ParameterLink, RequestsToEverybodyAreOurs) {
  Radio radio;
  radio.send(list(0, 0));
  EXPECT_EQ(radio.listen(kLong).size(), kParameterCount);
}

TEST(ParameterLink, WhileArmedOnlyWhatTheTableAllows) {
  Radio radio;
  test::VehicleModel vehicle({});
  vehicle.run(radio.flight, 3.0);
  ASSERT_EQ(radio.flight.arm(), Reason::none);
  radio.send(set("EST_FILTER", 0.0f));
  radio.send(set("CTL_FEEDFWD", 0.0f));
  EXPECT_EQ(radio.listen().size(), 2u);
  EXPECT_EQ(radio.flight.parameters().get(Parameter::est_filter), 1.0f);
  EXPECT_EQ(radio.flight.parameters().get(Parameter::ctl_feedforward), 0.0f);
}

TEST(ParameterLink, OneThatIsAskedForGoesBeforeAList) {
  Radio radio;
  radio.send(list());
  radio.send(read("CTL_FEEDFWD"));
  const auto values = radio.listen(kLong);
  ASSERT_EQ(values.size(), kParameterCount + 1);
  EXPECT_EQ(values[0].name, "CTL_FEEDFWD");
  EXPECT_EQ(values[1].name, "EST_FILTER");
}

// A list that is asked for again and again: the other messages keep their rates, and the radio of
// 5760 B/s, of which poses and targets take 2410 B/s, still has room.
TEST(ParameterLink, TelemetryKeepsItsRatesWhileAListIsSent) {
  Radio radio, quiet;
  test::VehicleModel vehicle({});
  vehicle.run(radio.flight, 3.0);
  test::VehicleModel other({});
  other.run(quiet.flight, 3.0);
  std::size_t values = 0;
  for (int i = 0; i < 100; ++i) {
    radio.send(list());
    values += radio.listen(20).size();
  }
  quiet.listen(2000);
  EXPECT_EQ(radio.frames - values, quiet.frames);
  EXPECT_EQ(values, 200u);
  EXPECT_LT(radio.bytes / 10, 5760u - 2410u);
}

TEST(ParameterLink, SaysOnceThatFlashDidNotTakeThem) {
  Flight flight;
  Telemetry telemetry(flight);
  Health health;
  health.parameters_unsaved = true;
  int texts = 0;
  mavlink::Parser parser;
  for (int slot = 0; slot < 1000; ++slot) {
    for (const std::uint8_t byte : telemetry.next(1000, {}, health)) {
      if (!parser.push(byte) || parser.frame().id != mavlink::kStatustext) continue;
      const auto text = parser.frame().get<std::array<char, 14>>(1);
      texts += std::string(text.data(), text.size()) == "parameters not" ? 1 : 0;
    }
  }
  EXPECT_EQ(texts, 1);
}

}  // namespace
}  // namespace fw
