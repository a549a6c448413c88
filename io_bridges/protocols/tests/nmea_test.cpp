// Sentences as flight controllers send them and as u-blox's protocol description prints them.
#include "io_bridges/protocols/nmea.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

constexpr const char* kPubx = "PUBX,41,1,0023,0001,115200,0";

std::vector<std::string> bodies(const std::string& text) {
  std::vector<std::string> got;
  NmeaParser parser([&got](std::string_view body) { got.emplace_back(body); });
  for (const char c : text) parser.add(static_cast<std::uint8_t>(c));
  return got;
}

TEST(Nmea, ArduPilotsSentenceForTheBaudRate) {
  EXPECT_EQ(nmea_sentence(kPubx), "$PUBX,41,1,0023,0001,115200,0*1C\r\n");
  EXPECT_EQ(bodies("$PUBX,41,1,0023,0001,115200,0*1C\r\n"), std::vector<std::string>{kPubx});
}

TEST(Nmea, WrongChecksumsCutAndOverlongSentencesAreDropped) {
  EXPECT_TRUE(bodies("$PUBX,41,1,0023,0001,115200,0*1D\r\n").empty());
  EXPECT_TRUE(bodies("$PUBX,41,1,0023,0001,115200,0\r\n").empty());
  EXPECT_TRUE(bodies("$" + std::string(90, 'A') + "*00\r\n").empty());
  EXPECT_EQ(bodies("$PUBX,41$PUBX,41,1,0023,0001,115200,0*1C\n").size(), 1u);
}

TEST(Nmea, EmptyFieldsStayFields) {
  EXPECT_EQ(nmea_fields("GPGGA,,,"), (std::vector<std::string>{"GPGGA", "", "", ""}));
}

}  // namespace
}  // namespace whirl::io
