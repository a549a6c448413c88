// Virtual time is the core's, however QEMU goes about its code: that it leaves its loop after every block, or
// throws away what it has translated for want of room, moves nothing by a nanosecond.
#include "harness/tests/real.hpp"
#include "io_bridges/qemu/tests/qemu_with.hpp"

namespace {

using whirl::board_test::QemuWith;
using whirl::real::kSecond;
using whirl::real::Outcome;

class Translation : public whirl::real::Real {
 protected:
  // A second of the flight image.
  nlohmann::json flown() const {
    const Outcome outcome = run("flight", kSecond);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return outcome.run;
  }
  nlohmann::json flown_with(const std::string& option) const {
    const QemuWith other(option);
    return flown();
  }
};

// Findings are part of the digest.
TEST_F(Translation, ASmallBufferChangesNoTimeAndIsNoFinding) {
  EXPECT_EQ(flown_with(whirl::board_test::kSmall_buffer)["digest"], flown()["digest"]);
}

TEST_F(Translation, BlocksThatAreNotChainedChangeNoTime) {
  EXPECT_EQ(flown_with("-d nochain")["digest"], flown()["digest"]);
}

}  // namespace
