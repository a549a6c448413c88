// The image's division against the host's, bit by bit.
#include "firmware/esc/core/float_division.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

namespace fw::esc {
namespace {

void expect_like_the_host(std::uint32_t a, std::uint32_t b) {
  const float exact = std::bit_cast<float>(a) / std::bit_cast<float>(b);
  const Quotient q = quotient(a, b);
  const bool normal = std::isnormal(std::bit_cast<float>(a)) &&
                      std::isnormal(std::bit_cast<float>(b)) && std::isnormal(exact);
  if (!q.valid) {
    // It may leave the edge of the range to the library, nothing else.
    EXPECT_TRUE(!normal || std::fabs(exact) < 2.4e-38f || std::fabs(exact) > 1.7e38f)
        << std::hex << a << " / " << b;
    return;
  }
  EXPECT_EQ(q.bits, std::bit_cast<std::uint32_t>(exact)) << std::hex << a << " / " << b;
}

TEST(FloatDivision, AnyBitsGiveWhatTheHostGives) {
  std::mt19937 random(7);
  for (int i = 0; i < 3'000'000; ++i) {
    expect_like_the_host(static_cast<std::uint32_t>(random()),
                         static_cast<std::uint32_t>(random()));
  }
}

TEST(FloatDivision, FractionsAtTheirEndsAndHalvesRoundAsTheyShould) {
  const std::uint32_t fractions[] = {0,        1,        2,        3,        0x3FFFFF,
                                     0x400000, 0x400001, 0x7FFFFD, 0x7FFFFE, 0x7FFFFF};
  for (const std::uint32_t a : fractions) {
    for (const std::uint32_t b : fractions) {
      for (const std::uint32_t exponent : {0u, 1u, 2u, 126u, 127u, 128u, 253u, 254u, 255u}) {
        expect_like_the_host(exponent << 23 | a, 127u << 23 | b);
        expect_like_the_host(0x80000000u | 127u << 23 | a, exponent << 23 | b);
      }
    }
  }
}

}  // namespace
}  // namespace fw::esc
