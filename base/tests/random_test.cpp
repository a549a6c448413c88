#include "base/random.hpp"

#include <cmath>

#include "base/near.hpp"

namespace whirl {
namespace {

// Known answers published with the Random123 library (kat_vectors, philox4x32 10).
TEST(Philox, ReproducesThePublishedKnownAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, StreamsOfOneSeedDifferAndRepeat) {
  RandomStream gyro(7, "gyro"), again(7, "gyro"), accel(7, "accel");
  int equal_to_accel = 0;
  for (int i = 0; i < 100; ++i) {
    const auto bits = gyro.bits();
    EXPECT_EQ(bits, again.bits());
    equal_to_accel += bits == accel.bits();
  }
  EXPECT_LT(equal_to_accel, 2);
}

TEST(RandomStream, NormalHasMeanZeroVarianceOneAndKurtosisThree) {
  constexpr int kDraws = 200'000;
  RandomStream stream(1, "normal");
  double sum = 0, sum2 = 0, sum4 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = stream.normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
  }
  const double sigma = 1.0 / std::sqrt(kDraws);
  EXPECT_TRUE(near(sum / kDraws, 0.0, stated(5 * sigma, "5 sigma of the mean")));
  EXPECT_TRUE(near(sum2 / kDraws, 1.0, stated(5 * sigma * std::sqrt(2.0), "5 sigma")));
  EXPECT_TRUE(near(sum4 / kDraws, 3.0, stated(5 * sigma * std::sqrt(96.0), "5 sigma")));
}

}  // namespace
}  // namespace whirl
