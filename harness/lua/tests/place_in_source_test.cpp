// The line of a key, in files as people write them.
#include "harness/lua/place_in_source.hpp"

#include <gtest/gtest.h>

#include "harness/lua/table.hpp"

namespace whirl::lua {
namespace {

constexpr const char* kFile = R"(-- return { board = "not here" }
local function level(volts) return { name = "v", volts = volts } end
--[[ board =
]]
return { board = "b",
  devices = {
    { name = "a = {", type = "x", params = { rate = 1,
        deep = { rate = 2 } } },
    { name = 'b',
      type = "y" },
    level "1 V",
  }, ["mcu"] = "m";
  text = [[ {
  ]], last = f({ 1, 2 }, 3), after = 4
})";

int line(std::string_view path) {
  const SourcePlace place = place_in_source(kFile, path);
  return place.exact ? place.line : -place.line;
}

TEST(PlaceInSource, AKeyHasTheLineOnWhichItStands) {
  EXPECT_EQ(line("board"), 5);
  EXPECT_EQ(line("devices[1].type"), 7);
  EXPECT_EQ(line("devices[1].params.rate"), 7);
  EXPECT_EQ(line("devices[1].params.deep.rate"), 8);
  EXPECT_EQ(line("devices[2].name"), 9);
  EXPECT_EQ(line("devices[2].type"), 10);
  EXPECT_EQ(line("mcu"), 12);
  EXPECT_EQ(line("last"), 14);
  EXPECT_EQ(line("after"), 14);
}

TEST(PlaceInSource, WhatIsNotSpelledOutHasTheLineOfWhatHoldsIt) {
  EXPECT_EQ(line("devices[2].bus"), -9);
  EXPECT_EQ(line("devices[3].volts"), -11);
  EXPECT_EQ(line("nothing"), 0);
  EXPECT_EQ(place_in_source("return t", "a").line, 0);
  EXPECT_EQ(place_in_source("return {", "a").line, 0);
  EXPECT_EQ(place_in_source("return { a = '\\", "a").line, 1);
}

TEST(PlaceInSource, ATablesComplaintHasTheLineThoughTheKeyStandsTwice) {
  const auto file = read_text("return {\n a = { x = 1 },\n b = { x = 'no' } }", "f.lua");
  ASSERT_TRUE(file);
  std::ignore = file.value().table("a").number("x");
  std::ignore = file.value().table("b").number("x");
  const auto good = file.value().finish();
  ASSERT_FALSE(good);
  EXPECT_EQ(good.error().place, "f.lua:3: b.x");
}

}  // namespace
}  // namespace whirl::lua
