// Virtual time is the core's, however QEMU goes about its code: that it throws away what it has translated
// and translates it anew, or leaves its loop after every block, moves nothing by a nanosecond.
#include "harness/tests/real.hpp"

namespace {

using whirl::real::kSecond;
using whirl::real::Outcome;

class Translation : public whirl::real::Real {
 protected:
  // The digest of a second of the flight image in a QEMU with this option.
  nlohmann::json digest(const std::string& option) const {
    const std::string emulator = folder_.file("qemu-system-arm"), path = std::getenv("PATH");
    write("qemu-system-arm",
          "#!/bin/sh\nPATH=" + path + "\nexec qemu-system-arm \"$@\" " + option + "\n");
    EXPECT_EQ(chmod(emulator.c_str(), 0755), 0);
    setenv("PATH", (folder_.file("") + ":" + path).c_str(), 1);
    const Outcome outcome = run("flight", kSecond);
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return outcome.run["digest"];
  }
};

// The image's translated code fills a buffer of 1 MiB a hundred times in a second (by a breakpoint on
// tb_flush); the buffer that QEMU takes by itself is never full.
TEST_F(Translation, ThrownAwayByAFullBufferChangesNoTime) {
  EXPECT_EQ(digest("-accel tcg,tb-size=1"), digest(""));
}

TEST_F(Translation, BlocksThatAreNotChainedChangeNoTime) {
  EXPECT_EQ(digest("-d nochain"), digest(""));
}

}  // namespace
