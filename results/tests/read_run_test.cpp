#include "results/read_run.hpp"

#include <gtest/gtest.h>

#include "results/folder.hpp"
#include "results/tests/sample.hpp"

namespace whirl::results {
namespace {

// What a parent makes of a child's run.json are the same cases as the child's own.
TEST(ReadRun, GivesTheSameTestcases) {
  Report r = sample();
  r.plan = "hover";  // legal texts: run.json escapes what is none
  r.expectations[1].name = "tilt";
  Expectation within = r.expectations[0];
  within.how = "within";
  within.low = 1.0;
  Expectation equal = within;
  equal.how = "equal";
  equal.low = equal.high;
  Expectation at_least = r.expectations[0];
  at_least.how = "at least";
  std::swap(at_least.low, at_least.high);
  r.expectations.insert(r.expectations.end(), {within, equal, at_least});
  r.cpu_faults.push_back({"HardFault", "f at 0x0", "r0 0", "f", 1.5});
  r.versions = {{"image", "flight.elf fnv1a64:1"}};
  r.reasons.push_back({Blame::not_shown, "why"});
  conclude(r);
  const auto read = read_run(run_json(r));
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(junit_xml({&read.value()}), junit_xml({&r}));
  EXPECT_EQ(read.value().versions, r.versions);
  EXPECT_EQ(exit_code(read.value()), exit_code(r));
  EXPECT_EQ(read.value().reasons.size(), r.reasons.size());
}

TEST(ReadRun, RefusesWhatIsNone) {
  for (const char* text : {"", "{}", "[1]", "{\"plan\": 3}"}) EXPECT_FALSE(read_run(text).ok());
  EXPECT_EQ(read_run("{\"plan\": ").error().what, "is no object of JSON");
  std::string wrong = run_json(sample());
  wrong.replace(wrong.find("\"fail\""), 6, "\"fine\"");
  EXPECT_FALSE(read_run(wrong).ok());
}

TEST(ReadRun, AValueOfAnotherTypeIsNamedWithItsKey) {
  const std::string good = run_json(sample());
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const auto read = read_run(text);
    EXPECT_FALSE(read.ok()) << to;
    return read.ok() ? std::string() : read.error().what;
  };
  EXPECT_EQ(refused("\"seed\":", "\"seed\": \"x\", \"was\":"),
            "seed is of type string, and a whole number is wanted");
  EXPECT_EQ(refused("\"measured\":", "\"measured\": true, \"was\":"),
            "expectations[0].measured is of type boolean, and a number is wanted");
  EXPECT_EQ(refused("\"limits_SI\":", "\"limits_SI\": [1, {}], \"was\":"),
            "expectations[0].limits_SI[1] is of type object, and a number is wanted");
  EXPECT_EQ(refused("\"expectations\":", "\"expectations\": 3, \"was\":"),
            "expectations is of type number, and a list is wanted");
  EXPECT_EQ(refused("\"expectations\":", "\"expectations\": [3], \"was\":"),
            "expectations[0] is of type number");
  EXPECT_EQ(refused("\"versions\":", "\"versions\": {\"image\": 1}, \"was\":"),
            "versions.image is of type number, and a text is wanted");
  EXPECT_EQ(refused("\"digest\":", "\"was\":"), "digest is missing");
}

}  // namespace
}  // namespace whirl::results
