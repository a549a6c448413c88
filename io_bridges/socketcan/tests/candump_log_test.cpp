// Lines as can-utils' own log has them (candump -l).
#include "io_bridges/socketcan/candump_log.hpp"

#include <gtest/gtest.h>

namespace whirl::io {
namespace {

TEST(CandumpLog, ALineIsAsCandumpWritesIt) {
  const CanFrame status{.id = 0x1801552A,
                        .extended = true,
                        .length = 8,
                        .data = {4, 3, 2, 1, 0x58, 0xCD, 0xAB, 0xC5}};
  EXPECT_EQ(candump_line(1'732'512'345'000'125'000, "can0", status),
            "(1732512345.000125) can0 1801552A#0403020158CDABC5");
  EXPECT_EQ(candump_line(5'000'000, "vcan1", {.id = 0x12, .length = 1, .data = {0xFF}}),
            "(0000000000.005000) vcan1 012#FF");
  EXPECT_EQ(candump_line(0, "can0", {.id = 0x7FF, .remote = true, .length = 4}),
            "(0000000000.000000) can0 7FF#R4");
}

TEST(CandumpLog, ALineComesBack) {
  const CanFrame frames[] = {
      {.id = 0x1FFFFFFF, .extended = true, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 0xFE}},
      {.id = 0, .length = 0},
      {.id = 0x7FF, .remote = true, .length = 8},
      {.id = 0x7FF, .extended = true, .length = 2, .data = {0xAB, 0}}};
  for (const CanFrame& frame : frames) {
    const auto line = parse_candump_line(candump_line(1'234'567'000, "vcan0", frame) + "\n");
    ASSERT_TRUE(line);
    EXPECT_EQ(line->t_ns, 1'234'567'000);
    EXPECT_EQ(line->interface, "vcan0");
    EXPECT_EQ(line->frame, frame);
  }
}

TEST(CandumpLog, WhatIsNoLineIsRefused) {
  for (const char* line :
       {"", "# comment", "(1.000001) can0", "(1.1) can0 123#00", "(1.000001) can0 12#00",
        "(1.000001) can0 FFF#00", "(1.000001) can0 123#0", "(1.000001) can0 123#00112233445566778",
        "(1.000001) can0 123#R9", "(1.000001) can0 123#0G", "(x.000001) can0 123#00",
        "(1.000001) can0 3FFFFFFF#00", "1.000001 can0 123#00"}) {
    EXPECT_FALSE(parse_candump_line(line)) << line;
  }
}

}  // namespace
}  // namespace whirl::io
