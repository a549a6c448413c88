// Who is at fault decides: verdicts, exit codes and the words of the reason.
#include "results/verdict.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/result.hpp"
#include "results/tests/sample.hpp"

namespace whirl::results {
namespace {

TEST(Verdicts, PrecedenceIsInternalBadInputFailedInconclusivePass) {
  const int order[] = {0, 3, 1, 2, 4};
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      EXPECT_EQ(worse_exit_code(order[i], order[k]), order[std::max(i, k)]);
    }
  }
  for (int unknown : {139, 5, -1}) {  // is nobody's pass
    EXPECT_EQ(worse_exit_code(0, unknown), 4) << unknown;
    EXPECT_EQ(worse_exit_code(unknown, 0), 4) << unknown;
  }
}

// The table of verdict.hpp, typed again.
TEST(Verdicts, WhoIsAtFaultDecidesVerdictAndExitCode) {
  struct Row {
    Blame blame;
    Verdict verdict;
    int code;
  };
  const Row kTable[] = {{Blame::firmware, Verdict::fail, 1},
                        {Blame::user, Verdict::error, 2},
                        {Blame::host, Verdict::inconclusive, 3},
                        {Blame::not_shown, Verdict::inconclusive, 3},
                        {Blame::harness, Verdict::error, 4}};
  for (const Row& row : kTable) {
    Report r = sample();
    r.expectations.pop_back();
    r.reasons = {{row.blame, "why"}};
    conclude(r);
    EXPECT_EQ(r.verdict, row.verdict) << name(row.blame);
    EXPECT_EQ(exit_code(r), row.code) << name(row.blame);
    EXPECT_EQ(r.reason, "why");
  }
}

TEST(Verdicts, WhatWasSeenOfTheFirmwareStaysWhateverFollows) {
  for (Blame later : {Blame::user, Blame::host, Blame::not_shown, Blame::harness}) {
    for (bool before : {false, true}) {
      Report r = sample();
      r.expectations.pop_back();
      r.reasons = {{Blame::firmware, "HardFault"}};
      r.reasons.insert(before ? r.reasons.begin() : r.reasons.end(), Reason{later, "also"});
      conclude(r);
      EXPECT_EQ(exit_code(r), 1) << name(later);
      EXPECT_EQ(r.reason, "HardFault");
    }
    Report r = sample();  // has a failed expectation
    r.reasons = {{later, "also"}};
    conclude(r);
    EXPECT_EQ(exit_code(r), 1) << name(later);
  }
}

TEST(Verdicts, OfLesserReasonsTheFirstStaysAndWhatWasNotShownGivesWay) {
  const Blame kCauses[] = {Blame::user, Blame::host, Blame::harness};
  for (Blame first : kCauses) {
    for (Blame second : kCauses) {
      Report r = sample();
      r.expectations.pop_back();
      r.reasons = {{Blame::not_shown, "0"}, {first, "1"}, {second, "2"}};
      conclude(r);
      EXPECT_EQ(r.reason, "1");
      EXPECT_EQ(r.blame, first);
    }
  }
}

TEST(Verdicts, AnExpectationThatWasNotShownIsNoPass) {
  Report r = sample();
  r.expectations.pop_back();
  r.expectations[0].verdict = Verdict::inconclusive;
  conclude(r);
  EXPECT_EQ(exit_code(r), 3);
}

TEST(Verdicts, WhatIsNotJudgedHasNoneUnlessSomethingIsAtFault) {
  Report r = sample();  // has a failed expectation
  r.judged = false;
  conclude(r);
  EXPECT_EQ(r.verdict, Verdict::none);
  EXPECT_EQ(exit_code(r), 0);
  EXPECT_EQ(r.reason, "");
  r.expectations.clear();
  conclude(r);
  EXPECT_EQ(r.verdict, Verdict::none);
  r.reasons = {{Blame::firmware, "HardFault"}};
  conclude(r);
  EXPECT_EQ(exit_code(r), 1);
}

TEST(Verdicts, NothingExpectedIsBadInput) {
  Report r;
  conclude(r);
  EXPECT_EQ(exit_code(r), 2);
}

TEST(Verdicts, AFailureSaysWhatWasMeasuredAndWhatWasWanted) {
  const auto reason = [](auto change) {
    Report r = sample();
    r.expectations.erase(r.expectations.begin());
    Expectation& e = r.expectations[0];
    e.name = "tilt";
    e.measured = 7.5;
    e.note = "";
    change(r, e);
    conclude(r);
    return r.reason;
  };
  const auto none = [](Report&, Expectation&) {};
  EXPECT_EQ(reason(none), "tilt: 7.5 cm, wanted at most 5 cm");
  EXPECT_EQ(reason([](Report&, Expectation& e) { e.unit = ""; }), "tilt: 7.5, wanted at most 5");
  EXPECT_EQ(reason([](Report&, Expectation& e) {
              e.low = 1.25;
              e.how = "within";
            }),
            "tilt: 7.5 cm, wanted within 1.25 .. 5 cm");
  EXPECT_EQ(reason([](Report&, Expectation& e) {
              e.low = e.high;
              e.high.reset();
              e.how = "at least";
            }),
            "tilt: 7.5 cm, wanted at least 5 cm");
  EXPECT_EQ(reason([](Report&, Expectation& e) {
              e.high.reset();
              e.how = "holds";
            }),
            "tilt: 7.5 cm, wanted holds");
  EXPECT_EQ(reason([](Report&, Expectation& e) { e.measured = std::nan(""); }),
            "tilt: nothing to measure");
  EXPECT_EQ(reason([](Report&, Expectation& e) {
              e.measured = std::nan("");
              e.note = "never came true";
            }),
            "tilt: never came true");
  EXPECT_EQ(reason([](Report&, Expectation& e) {
              e.verdict = Verdict::inconclusive;
              e.note = "only 1 ms of 2 ms";
            }),
            "tilt: only 1 ms of 2 ms");
  EXPECT_EQ(reason([](Report& r, Expectation& e) { r.expectations.push_back(e); }),
            "tilt: 7.5 cm, wanted at most 5 cm (and 1 more)");
  EXPECT_EQ(reason([](Report& r, Expectation& e) {
              r.expectations.insert(r.expectations.end(), 3, e);
              r.expectations.back().verdict = Verdict::pass;
            }),
            "tilt: 7.5 cm, wanted at most 5 cm (and 2 more)");
}

TEST(Verdicts, APassHasNoReason) {
  Report r = sample();
  r.expectations.pop_back();
  r.reason = "of an earlier conclusion";
  conclude(r);
  EXPECT_EQ(r.verdict, Verdict::pass);
  EXPECT_EQ(r.reason, "");
  EXPECT_EQ(exit_code(r), 0);
}

TEST(Verdicts, AnErrorIsBlamedByItsKindAndKeepsItsWords) {
  EXPECT_EQ(blame_of({ErrorKind::bad_input, "p.lua:1", "what", ""}), Blame::user);
  EXPECT_EQ(blame_of({ErrorKind::host, "", "what", ""}), Blame::host);
  EXPECT_EQ(blame_of({ErrorKind::internal, "", "what", ""}), Blame::harness);
  const Reason reason = reason_of({ErrorKind::host, "disk", "is full", ""}, "in the second run: ");
  EXPECT_EQ(reason.blame, Blame::host);
  EXPECT_EQ(reason.what, "in the second run: disk: is full");
}

}  // namespace
}  // namespace whirl::results
