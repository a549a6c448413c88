#include "base/json_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace whirl {
namespace {

TEST(JsonText, WhatWasWrittenIsRead) {
  const nlohmann::json value = {{"b", {1, 2.5, "\xC3\xA4"}}, {"a", nullptr}};
  EXPECT_EQ(parse_json(text_of(value)), value);
  EXPECT_EQ(text_of(value), "{\"a\":null,\"b\":[1,2.5,\"\xC3\xA4\"]}");
  EXPECT_EQ(text_of(nlohmann::json{{"a", 1}}, 1), "{\n \"a\": 1\n}");
}

TEST(JsonText, AnOrderedValueKeepsItsOrder) {
  EXPECT_EQ(text_of(parse_ordered_json("{\"b\": 1, \"a\": 2}")), "{\"b\":1,\"a\":2}");
}

TEST(JsonText, BadTextIsDiscarded) {
  EXPECT_TRUE(parse_json("{\"a\": ").is_discarded());
  EXPECT_TRUE(parse_ordered_json("").is_discarded());
}

TEST(JsonText, WhatIsNoUtf8IsRefusedOrReplaced) {
  const nlohmann::json value = "a\xFF";
  EXPECT_THROW(text_of(value), nlohmann::json::exception);
  EXPECT_EQ(text_of(value, -1, NoUtf8::replace), "\"a\xEF\xBF\xBD\"");
}

}  // namespace
}  // namespace whirl
