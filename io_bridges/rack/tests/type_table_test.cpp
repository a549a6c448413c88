// The README of the test plans holds the very table that `whirl devices` prints.
#include "io_bridges/rack/type_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

TEST(TypeTable, TheReadmeHasItWordForWord) {
  std::ifstream in(WHIRL_SOURCE_FOLDER "/test_plans/README.md");
  const std::string readme{std::istreambuf_iterator<char>(in), {}};
  const std::string begin = "<!-- whirl devices -->\n", end = "<!-- end of whirl devices -->\n";
  const std::size_t from = readme.find(begin), to = readme.find(end);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  EXPECT_EQ(readme.substr(from + begin.size(), to - from - begin.size()),
            type_table(device_types()))
      << "put what `whirl devices` prints between the two marks";
}

TEST(TypeTable, NamesEveryTypeAndKey) {
  const std::string table = type_table(device_types());
  for (const DeviceType& type : device_types()) {
    EXPECT_NE(table.find("| **" + type.name + "** "), std::string::npos) << type.name;
    for (const DeviceKey& key : type.keys) {
      EXPECT_NE(table.find("| `" + key.path + "` "), std::string::npos) << key.path;
    }
  }
}

TEST(TypeTable, ARowHasUnitRangeDefaultAndWhatItIs) {
  const std::regex row(R"(\| `params.rate` +\| kHz +\| 1..400 +\| 400 kHz +\| of SCL \|)");
  EXPECT_TRUE(std::regex_search(type_table(device_types()), row));
}

}  // namespace
}  // namespace whirl::rack
