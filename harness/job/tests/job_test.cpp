#include "harness/job/job.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(Job, CrossesAProcessBoundaryWhole) {
  const Job sent{
      "a b.lua", "hover \xC3\xA4", UINT64_MAX, {{"vehicle.motor.resistance", "1 ohm"}}, "out", true,
      true,      "calibrations/x"};
  const auto got = read_job(job_text(sent));
  ASSERT_TRUE(got.ok()) << got.error().message();
  EXPECT_EQ(job_text(got.value()), job_text(sent));
  EXPECT_EQ(got.value().seed, UINT64_MAX);
  EXPECT_EQ(got.value().settings.at(0).value, "1 ohm");
  EXPECT_FALSE(read_job(job_text({"f", "p", std::nullopt, {}, "", false, false, ""})).value().seed);
}

TEST(Job, AReportCrossesBackWhole) {
  const auto got = read_job_report(job_report_text({1, "runs/x", "FAIL x\n", "{\"a\": 1}\n"}));
  ASSERT_TRUE(got.ok());
  EXPECT_EQ(got.value().exit_code, 1);
  EXPECT_EQ(got.value().folder, "runs/x");
  EXPECT_EQ(got.value().outcome, "FAIL x\n");
  EXPECT_EQ(got.value().run, "{\"a\": 1}\n");
}

TEST(Job, WhatIsNoneIsAnError) {
  for (const char* text : {"", "{}", "[]", "{\"file\": 1}", "{\"file\": \"a\""}) {
    EXPECT_FALSE(read_job(text).ok()) << text;
    EXPECT_FALSE(read_job_report(text).ok()) << text;
  }
}

}  // namespace
}  // namespace whirl
