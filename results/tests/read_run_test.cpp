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

}  // namespace
}  // namespace whirl::results
