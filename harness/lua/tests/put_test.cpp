#include <gtest/gtest.h>

#include "base/near.hpp"
#include "harness/lua/table.hpp"

namespace whirl::lua {
namespace {

Table motor() {
  return read_text("return { motor = { kv = 950, list = { { a = 1 }, { a = 2 } } } }", "m").value();
}

TEST(Put, AValueTakesThePlaceOfTheFiles) {
  Table t = motor();
  ASSERT_TRUE(t.put("motor.kv", "1e3").ok());
  ASSERT_TRUE(t.put("motor.resistance", "90 mohm").ok());
  ASSERT_TRUE(t.put("motor.list.2.a", "7").ok());
  ASSERT_TRUE(t.put("swap", "true").ok());
  EXPECT_EQ(t.table("motor").number("kv"), 1000.0);
  EXPECT_TRUE(near(t.table("motor").quantity("resistance", Dimension::resistance), 0.09,
                   stated(1e-12, "round-off")));
  EXPECT_EQ(t.table("motor").tables("list")[1].integer("a"), 7);
  EXPECT_TRUE(t.flag_or("swap", false));
  ASSERT_TRUE(t.put("address", "0x2A").ok());
  EXPECT_EQ(t.integer("address"), 42);
  std::ignore = t.table("motor").tables("list")[0].integer("a");
  EXPECT_TRUE(t.finish().ok());
}

TEST(Put, AKeyThatNobodyReadsIsRefusedAsInTheFile) {
  Table t = motor();
  ASSERT_TRUE(t.put("motor.resistanec", "90 mohm").ok());
  std::ignore = t.table("motor").number("kv");
  for (const Table& entry : t.table("motor").tables("list")) std::ignore = entry.integer("a");
  EXPECT_NE(t.finish().error().message().find("motor.resistanec"), std::string::npos);
}

TEST(Put, APathToNothingIsRefused) {
  Table t = motor();
  for (const char* path :
       {"motor.list.3.a", "motor.list.0.a", "motor.kv.unit", "motor..kv", ".", "motor.kv."}) {
    EXPECT_FALSE(t.put(path, "1").ok()) << path;
  }
}

}  // namespace
}  // namespace whirl::lua
