// The image's comparisons against the host's.
#include "firmware/esc/core/float_order.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace fw::esc {
namespace {

void expect_like_the_host(std::uint32_t a, std::uint32_t b) {
  const float x = std::bit_cast<float>(a), y = std::bit_cast<float>(b);
  EXPECT_EQ(is_less(a, b), x < y) << std::hex << a << " " << b;
  EXPECT_EQ(is_at_most(a, b), x <= y) << std::hex << a << " " << b;
}

TEST(FloatOrder, IsTheHostsForAnyBits) {
  const std::uint32_t edges[] = {0,          0x80000000, 1,          0x80000001,
                                 0x7F800000, 0xFF800000, 0x7F800001, 0xFFC00000,
                                 0x7FFFFFFF, 0xFFFFFFFF, 0x3F800000, 0xBF800000};
  for (const std::uint32_t a : edges) {
    for (const std::uint32_t b : edges) expect_like_the_host(a, b);
  }
  std::mt19937 random(5);
  for (int i = 0; i < 1'000'000; ++i) {
    const auto a = static_cast<std::uint32_t>(random()), b = static_cast<std::uint32_t>(random());
    expect_like_the_host(a, b);
    expect_like_the_host(a, a + (b & 3) - 1);
  }
}

}  // namespace
}  // namespace fw::esc
