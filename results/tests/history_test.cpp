#include "results/history.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <fstream>

#include "base/scratch_folder.hpp"

namespace whirl::results {
namespace {

Report run() {
  Report r;
  r.plan = "hover";
  Expectation height;
  height.name = "height";
  height.verdict = Verdict::pass;
  height.measured = 3.0;
  height.margin = 2.0;
  height.unit = "cm";
  Expectation tilt = height;
  tilt.name = "tilt";
  tilt.measured = std::nan("");
  r.expectations = {height, tilt};
  return r;
}

TEST(History, GivesTheLastRunsOldestFirst) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  for (int i = 0; i < 5; ++i) {
    Report r = run();
    r.seed = static_cast<std::uint64_t>(i);
    r.expectations[0].margin = i;
    ASSERT_TRUE(remember(file, r).ok());
  }
  const auto rows = recall(file, run().plan, "height", 3);
  ASSERT_TRUE(rows.ok());
  ASSERT_EQ(rows.value().size(), 3u);
  EXPECT_EQ(rows.value().front().margin, 2.0);
  EXPECT_EQ(rows.value().back().margin, 4.0);
  const auto unmeasured = recall(file, "", "tilt", 1);
  EXPECT_TRUE(std::isnan(unmeasured.value().at(0).measured));
  EXPECT_FALSE(recall(folder.file("none.sqlite"), "", "", 1).ok());
}

void run_sql(const std::string& file, const char* sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
}

TEST(History, ADamagedFileSaysSoInsteadOfNothing) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  Report r = run();
  r.expectations[0].name = std::string(6000, 'n');
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(remember(file, r).ok());
  std::fstream pages(file, std::ios::in | std::ios::out | std::ios::binary);
  for (const long at : {4096 + 8, 3 * 4096, 5 * 4096}) {
    pages.seekp(at);
    pages << std::string(2000, '\xFF');
  }
  pages.close();
  const auto rows = recall(file, "", "", 10);
  ASSERT_FALSE(rows.ok());
  EXPECT_EQ(rows.error().kind, ErrorKind::host);
  EXPECT_NE(rows.error().message().find("history.sqlite: "), std::string::npos);
  EXPECT_EQ(rows.error().message().find("not an error"), std::string::npos);
}

TEST(History, ANewerSchemaIsLeftAloneAndNamed) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  run_sql(file, "CREATE TABLE run(other TEXT); PRAGMA user_version = 3");
  for (const Error& error : {remember(file, run()).error(), recall(file, "", "", 1).error()}) {
    EXPECT_EQ(error.what, "was written by a newer whirl (schema 3, this one knows 2)");
  }
}

TEST(History, AFileFromBeforeSchemasHadNumbersIsTakenOn) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  ASSERT_TRUE(remember(file, run()).ok());
  run_sql(file, "PRAGMA user_version = 0");
  ASSERT_TRUE(remember(file, run()).ok());
  EXPECT_EQ(recall(file, "", "height", 5).value().size(), 2u);
}

// As schema 1 had it: without the inputs.
TEST(History, AFileOfTheFirstSchemaGetsItsInputs) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  ASSERT_TRUE(remember(file, run()).ok());
  run_sql(file, "ALTER TABLE run DROP COLUMN inputs; PRAGMA user_version = 1");
  Report r = run();
  r.versions = {{"qemu", "7.2"}, {"image", "a.elf 1"}, {"plan", "p.lua 2"}, {"vehicle", "v.lua 3"}};
  ASSERT_TRUE(remember(file, r).ok());
  const auto rows = recall(file, "", "height", 5);
  ASSERT_TRUE(rows.ok()) << rows.error().message();
  ASSERT_EQ(rows.value().size(), 2u);
  EXPECT_EQ(rows.value()[0].inputs, "");
  EXPECT_EQ(rows.value()[1].inputs, "a.elf 1, p.lua 2, v.lua 3");
}

TEST(History, AFileWithOtherColumnsNamesTheFault) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  run_sql(file, "CREATE TABLE run(id INTEGER PRIMARY KEY, other TEXT)");
  const Error error = remember(file, run()).error();
  EXPECT_NE(error.what.find("plan"), std::string::npos) << error.what;
}

TEST(History, ALockedFileIsGivenUpAfterThePatience) {
  using std::chrono::milliseconds;
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  ASSERT_TRUE(remember(file, run()).ok());
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_EQ(remember(file, run(), milliseconds(20)).error().what, "is locked by another process");
  EXPECT_EQ(recall(file, "", "", 1, milliseconds(20)).error().what, "is locked by another process");
  sqlite3_close(other);
  EXPECT_EQ(recall(file, "", "height", 5).value().size(), 1u);
}

TEST(History, NoSqlOfTheFileItselfIsRun) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  ASSERT_TRUE(remember(file, run()).ok());
  run_sql(file, "CREATE TRIGGER forget AFTER INSERT ON expectation BEGIN DELETE FROM run; END");
  ASSERT_TRUE(remember(file, run()).ok());
  EXPECT_EQ(recall(file, "", "height", 5).value().size(), 2u);
}

TEST(History, TextsMayHoldAnyByte) {
  const ScratchFolder folder;
  const std::string file = folder.file("history.sqlite");
  Report r = run();
  r.plan = std::string("a\0b", 3);
  ASSERT_TRUE(remember(file, r).ok());
  const auto rows = recall(file, r.plan, "height", 1);
  ASSERT_EQ(rows.value().size(), 1u);
  EXPECT_EQ(rows.value()[0].plan, r.plan);
}

}  // namespace
}  // namespace whirl::results
