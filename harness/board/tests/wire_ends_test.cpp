// The ends of a wire between two boards: a port for each bus of the one that follows.
#include "harness/board/wire_ends.hpp"

#include <gtest/gtest.h>

namespace whirl {
namespace {

TEST(WireEnds, DevicesOnOneBusShareItsPort) {
  const WireEnds ends = wire_ends({{"imu", "spi1", "PA15", "PC4", 100'000},
                                   {"baro", "i2c1"},
                                   {"mag", "i2c1"},
                                   {"gps", "usart6", "", "", 168'403}},
                                  7);
  ASSERT_EQ(ends.leading.size(), 4u);
  const int ports[] = {0, 1, 1, 2};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(ends.leading[i].port, ports[i]);
    EXPECT_EQ(ends.leading[i].fd, 7);
    EXPECT_EQ(ends.leading[i].bus, "");
  }
  EXPECT_EQ(ends.leading[2].device, "mag");
  ASSERT_EQ(ends.following.size(), 3u);
  EXPECT_EQ(ends.following[0], (WireEnd{.bus = "spi1",
                                        .fd = 7,
                                        .port = 0,
                                        .shared = true,
                                        .select = "PA15",
                                        .ready = "PC4",
                                        .latency_ns = 100'000}));
  EXPECT_EQ(ends.following[2],
            (WireEnd{.bus = "usart6", .fd = 7, .port = 2, .shared = true, .latency_ns = 168'403}));
}

// Who follows on one bus alone may run ahead between its messages; on SPI never.
TEST(WireEnds, OneBusIsNotShared) {
  EXPECT_FALSE(wire_ends({{"esc1", "i2c2"}}, 3).following.at(0).shared);
  EXPECT_FALSE(wire_ends({{"gps", "usart6"}}, 3).following.at(0).shared);
  EXPECT_TRUE(wire_ends({{"imu", "spi1", "PA15"}}, 3).following.at(0).shared);
}

TEST(WireEnds, AUartsShortestCharacterIsTenBitsAtARateThatIsThreePercentOff) {
  EXPECT_EQ(shortest_character_ns(57'600.0), 168'403);
  EXPECT_EQ(shortest_character_ns(115'200.0), 84'201);
}

}  // namespace
}  // namespace whirl
