// A set-point made flyable: its limits, and where it ends.
#include "firmware/control/reference.hpp"

#include <gtest/gtest.h>

#include "base/near.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

TEST(Reference, ReachesAHeightWithinItsSpeedAndWithoutOvershoot) {
  Reference reference;
  reference.start(Vector3::Zero(), 0.0f);
  float fastest = 0.0f, hardest = 0.0f, highest = 0.0f;
  for (int i = 0; i < 400; ++i) {
    reference.step({0, 0, -3.0f}, 0.0f, 0.025f);
    fastest = std::max(fastest, -reference.v_W_mps().z());
    hardest = std::max(hardest, std::abs(reference.a_W_mps2().z()));
    highest = std::max(highest, -reference.p_W_m().z());
  }
  EXPECT_LT(fastest, 0.51f);
  EXPECT_GT(fastest, 0.45f);
  EXPECT_LE(hardest, 0.801f);
  EXPECT_LT(highest, 3.005f);
  EXPECT_TRUE(near(reference.p_W_m().z(), -3.0, stated(0.01, "1 cm, 8 s behind the ramp")));
}

TEST(Reference, TurnsTheShortWayAtALimitedRate) {
  Reference reference;
  reference.start(Vector3::Zero(), 3.0f);
  for (int i = 0; i < 4; ++i) reference.step(Vector3::Zero(), -3.0f, 0.025f);
  EXPECT_TRUE(near(reference.yaw_rad(), 3.06,
                   stated(1e-3, "2 % of the way")));  // 0.1 s at 0.6 rad/s, on towards pi
}

}  // namespace
}  // namespace fw
