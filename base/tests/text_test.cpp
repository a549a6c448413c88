#include "base/text.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(Text, WhatIsWellFormedStaysAsItIs) {
  for (const char* good :
       {"", "plain", "tab\tline\nreturn\r", "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x9A\x81",
        "\xED\x9F\xBF\xEE\x80\x80\xEF\xBF\xBD", "back\\slash"}) {
    EXPECT_EQ(legal_text(good), good);
  }
}

// The sequences of Unicode 15, section 3.9, that are ill-formed.
TEST(Text, WhatIsNoUtf8IsShownByteByByte) {
  EXPECT_EQ(legal_text("a\x80z"), "a\\x80z");
  EXPECT_EQ(legal_text("\xC0\xAF"), "\\xC0\\xAF");                    // overlong
  EXPECT_EQ(legal_text("\xE0\x80\x80"), "\\xE0\\x80\\x80");           // overlong
  EXPECT_EQ(legal_text("\xED\xA0\x80"), "\\xED\\xA0\\x80");           // surrogate
  EXPECT_EQ(legal_text("\xF4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80");  // beyond U+10FFFF
  EXPECT_EQ(legal_text("\xE2\x82"), "\\xE2\\x82");                    // cut off
  EXPECT_EQ(legal_text("\xE2\x82z"), "\\xE2\\x82z");
  EXPECT_EQ(legal_text(std::string_view("a\0b", 3)), "a\\x00b");
}

TEST(Text, WhatXmlDoesNotKnowIsShown) {
  EXPECT_EQ(legal_text("\x1B[2J"), "\\x1B[2J");
  EXPECT_EQ(legal_text("\xEF\xBF\xBE"), "\\xEF\\xBF\\xBE");  // U+FFFE
}

TEST(Text, ALineForATerminalHasNoControlCharacter) {
  EXPECT_EQ(printable_line("ok\nPASS \x1B[1m\r\x7F"), "ok\\x0APASS \\x1B[1m\\x0D\\x7F");
  EXPECT_EQ(printable_line("\xC2\x9B"
                           "31m"),
            "\\xC2\\x9B"
            "31m");                                              // CSI in eight bits
  EXPECT_EQ(printable_line("\xE2\x80\xAE"), "\\xE2\\x80\\xAE");  // right-to-left override
  EXPECT_EQ(printable_line("\xC3\xA4 \xE2\x82\xAC"), "\xC3\xA4 \xE2\x82\xAC");
}

}  // namespace
}  // namespace whirl
