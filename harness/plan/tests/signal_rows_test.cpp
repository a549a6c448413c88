#include "harness/plan/signal_rows.hpp"

#include <gtest/gtest.h>

namespace whirl::plan {
namespace {

// Two signals: the number of the row, and its negative.
class Rows : public testing::Test {
 protected:
  void run_to(int rows) {
    for (; count_ < rows; ++count_) {
      const double row[] = {static_cast<double>(count_), -static_cast<double>(count_)};
      rows_.append(row);
    }
  }
  SignalRows rows_{{{"a", "", ""}, {"b", "", ""}}, 1'000'000};
  int count_ = 0;
};

TEST_F(Rows, TheLatestIsThere) {
  run_to(1);
  EXPECT_EQ(rows_.last(0), 0.0);
  run_to(1234);
  EXPECT_EQ(rows_.last(0), 1233.0);
  EXPECT_EQ(rows_.last(1), -1233.0);
}

TEST_F(Rows, ARecordHas200msBeforeItsCommandAndEndsWhereItIsClosed) {
  run_to(1001);
  const std::size_t number = rows_.open_record({1});
  run_to(1011);
  rows_.close_record(number);
  run_to(2000);
  const metrics::Record record = rows_.record(number, 1);
  EXPECT_EQ(record.command, 200u);
  ASSERT_EQ(record.values.size(), 211u);
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    EXPECT_EQ(record.values[i], -800.0 - static_cast<double>(i));
  }
}

TEST_F(Rows, AgesStayWithTheirValues) {
  for (; count_ < 300; ++count_) {
    const double row[] = {1.0, 2.0};
    const std::int64_t ages_ns[] = {0, count_ * 10};
    rows_.append(row, ages_ns);
    if (count_ == 290) rows_.open_record({0, 1});
  }
  const metrics::Record record = rows_.record(0, 1);
  ASSERT_EQ(record.ages_ns.size(), record.values.size());
  EXPECT_EQ(record.ages_ns[0], (290 - static_cast<int>(record.command)) * 10);
  EXPECT_EQ(record.ages_ns.back(), 2990);
  EXPECT_EQ(rows_.record(0, 0).ages_ns.back(), 0);
}

TEST_F(Rows, OfAModelNothingHasAnAge) {
  run_to(300);
  EXPECT_TRUE(rows_.record(rows_.open_record({0}), 0).ages_ns.empty());
}

TEST_F(Rows, ARecordAtTheBeginningHasWhatThereIs) {
  run_to(51);
  const std::size_t first = rows_.open_record({0, 1});
  run_to(201);
  const std::size_t second = rows_.open_record({0});
  EXPECT_EQ(rows_.record(first, 1).command, 50u);
  EXPECT_EQ(rows_.record(first, 1).values.size(), 201u);
  EXPECT_EQ(rows_.record(first, 1).values[3], -3.0);
  EXPECT_EQ(rows_.record(second, 0).command, 200u);
  EXPECT_EQ(rows_.record(second, 0).values.front(), 0.0);
}

}  // namespace
}  // namespace whirl::plan
