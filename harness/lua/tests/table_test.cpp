#include "harness/lua/table.hpp"

#include "base/near.hpp"

namespace whirl::lua {
namespace {

Table read_good(const std::string& text) {
  auto table = read_text(text, "quad.lua");
  EXPECT_TRUE(table.ok()) << (table.ok() ? "" : table.error().message());
  return table.value();
}

std::string complaint(const Table& table) {
  const auto good = table.finish();
  return good ? "none" : good.error().message();
}

TEST(DataFile, QuantitiesAreReadInSI) {
  const Table t = read_good(R"(return { mass = "900 g", frame = { arm = "25 cm" }, poles = 14,
                                        name = "hp", rotors = { { spin = "ccw" }, { spin = "cw" } },
                                        twist = { "12 deg", "6 deg" }, delay = "2 ms" })");
  EXPECT_TRUE(near(t.quantity("mass", Dimension::mass), 0.9, round_off(2, 0.9)));
  EXPECT_TRUE(near(t.table("frame").quantity("arm", Dimension::length), 0.25, round_off(2, 0.25)));
  EXPECT_EQ(t.integer("poles"), 14);
  EXPECT_EQ(t.text("name"), "hp");
  EXPECT_EQ(t.tables("rotors").at(1).text("spin"), "cw");
  EXPECT_EQ(t.tables("rotors").at(0).text("spin"), "ccw");
  EXPECT_EQ(t.quantities("twist", Dimension::angle).size(), 2u);
  EXPECT_EQ(t.duration_ns("delay"), 2'000'000);
  EXPECT_EQ(complaint(t), "none");
}

TEST(DataFile, NegativeMassIsRefusedWithItsLine) {
  const Table t = read_good("return {\n  mass = \"-1 kg\",\n}");
  t.quantity("mass", Dimension::mass, above(0.0));
  EXPECT_EQ(complaint(t), "quad.lua:2: mass: '-1 kg' must be positive");
}

TEST(DataFile, WrongDimensionNamesTheKeyAndTheUnitsThatWouldDo) {
  const Table t = read_good("return { frame = { arm = \"3 s\" } }");
  t.table("frame").quantity("arm", Dimension::length);
  EXPECT_EQ(complaint(t),
            "quad.lua:1: frame.arm: '3 s' is a time, not a length (a length is written with mm cm "
            "m km in)");
}

TEST(DataFile, BareNumberIsNoQuantity) {
  const Table t = read_good("return { mass = 0.9 }");
  t.quantity("mass", Dimension::mass);
  EXPECT_NE(complaint(t).find("is a bare number, not a mass"), std::string::npos);
}

TEST(DataFile, UnknownKeysAreErrorsAtAnyDepth) {
  const Table top = read_good("return { masss = \"1 kg\" }");
  EXPECT_EQ(complaint(top), "quad.lua:1: unknown key 'masss'");
  const Table deep = read_good("return { list = { { a = 1, b = 2 } } }");
  deep.tables("list").at(0).integer("a");
  EXPECT_EQ(complaint(deep), "quad.lua:1: unknown key 'list[1].b' (known here: a)");
}

TEST(DataFile, AnItemThatNobodyReadsIsRefusedToo) {
  const Table t = read_good("return { air = { '35 degC', height = '2 m' }, tags = { 'a', 'b' } }");
  EXPECT_EQ(t.texts("tags").size(), 2u);
  t.table("air").quantity("height", Dimension::length);
  EXPECT_EQ(complaint(t), "quad.lua:1: unknown key 'air[1]' (known here: height)");
}

TEST(DataFile, AnUnknownKeyIsRefusedWithThoseThatAreRead) {
  const Table t = read_good("return { mass = \"1 kg\", inner = { armm = 1, far = 2 } }");
  t.quantity("mass", Dimension::mass);
  const Table inner = t.table("inner");
  inner.integer_or("far", 0);
  inner.integer_or("arm", 0);
  EXPECT_EQ(complaint(t), "quad.lua:1: unknown key 'inner.armm' (known here: arm, far)");
}

TEST(DataFile, TheFirstComplaintIsTheOneTold) {
  const Table t = read_good("return { }");
  t.text("first");
  t.text("second");
  EXPECT_NE(complaint(t).find("first: is missing"), std::string::npos);
}

TEST(DataFile, WhatIsNoDataIsRefused) {
  EXPECT_FALSE(read_text("return { f = function() end }", "x").ok());
  EXPECT_FALSE(read_text("local t = {} t.t = t return t", "x").ok());
  EXPECT_FALSE(read_text("return 5", "x").ok());
  EXPECT_FALSE(read_text("return { [3] = 1, [9] = 2 }", "x").ok());
  EXPECT_FALSE(read_file("/nonexistent/quad.lua").ok());
}

TEST(DataFile, SharedTablesAreCountedEachTimeAndBounded) {
  const auto wide = read_text("local x = {} for i = 1, 30 do x = { x, x } end return x", "x");
  EXPECT_NE(wide.error().message().find("more than 100000 values"), std::string::npos);
  const auto heavy =
      read_text("local s, t = ('x'):rep(1e6), {} for i = 1, 1000 do t[i] = s end return t", "x");
  EXPECT_NE(heavy.error().message().find("16 MiB"), std::string::npos);
  EXPECT_TRUE(read_text("local a = { 1, 2 } return { a, a, a }", "x").ok());
}

TEST(DataFile, BytesThatAreNoTextAreNoData) {
  for (const char* bytes : {"a\\0b", "\\xFF", "\\27[2J"}) {
    EXPECT_EQ(read_text(std::string("return { name = '") + bytes + "' }", "x").error().message(),
              "x: name holds control characters, or is no UTF-8");
  }
  EXPECT_FALSE(read_text("return { ['a\\0b'] = 1 }", "x").ok());
}

TEST(DataFile, NotANumberFitsNoRange) {
  EXPECT_FALSE(kAny.holds(std::nan("")));
  const Table t = read_good("return { x = 0/0 }");
  t.number("x");
  EXPECT_NE(complaint(t), "none");
}

}  // namespace
}  // namespace whirl::lua
