#include "harness/plan/source_calls.hpp"

#include <gtest/gtest.h>

namespace whirl::plan {
namespace {

std::string names(std::string_view source, int first = 1, int last = 1000) {
  std::string all;
  for (const SourceCall& call : source_calls(source, first, last)) {
    all += call.name + "@" + std::to_string(call.line) + " ";
  }
  return all;
}

TEST(SourceCalls, AreFoundInEveryWayToWriteThem) {
  EXPECT_EQ(names("t:a()\n t : b { }\n t:c 'x' t:d \"y\"\nt:e [[z]] t\n:\nf\n(1)"),
            "a@1 b@2 c@3 d@3 e@4 f@5 ");
}

TEST(SourceCalls, AreNoneInCommentsAndTexts) {
  EXPECT_EQ(names("-- t:a()\nx = 't:b()' .. \"\\\"t:c()\" --[[ t:d()\n t:e() ]] t:f()\n"
                  "y = [==[ t:g() ]] ]==] t:h() ::label:: goto label"),
            "f@3 h@4 ");
  EXPECT_EQ(names("local m = t.budget local n = t:x"), "");
}

TEST(SourceCalls, AreThoseOfTheGivenLines) {
  EXPECT_EQ(names("t:a()\nt:b()\nt:c()\n", 2, 2), "b@2 ");
  EXPECT_EQ(names("", 1, 1), "");
  EXPECT_EQ(names("t:", 1, 1), "");
  EXPECT_EQ(names("'open", 1, 1), "");
  EXPECT_EQ(names("[[open", 1, 1), "");
}

}  // namespace
}  // namespace whirl::plan
