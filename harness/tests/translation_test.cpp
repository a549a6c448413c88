// Virtual time is the core's, however QEMU goes about its code: that it leaves its loop after every block moves
// nothing by a nanosecond. Where it throws away what it has translated, for want of room, that is not promised
// for long flights, and said.
#include "harness/tests/real.hpp"

namespace {

using whirl::real::kSecond;
using whirl::real::Outcome;

class Translation : public whirl::real::Real {
 protected:
  // A second of the flight image in a QEMU with this option.
  nlohmann::json flown(const std::string& option) const {
    const std::string emulator = folder_.file("qemu-system-arm"), path = std::getenv("PATH");
    write("qemu-system-arm",
          "#!/bin/sh\nPATH=" + path + "\nexec qemu-system-arm \"$@\" " + option + "\n");
    EXPECT_EQ(chmod(emulator.c_str(), 0755), 0);
    setenv("PATH", (folder_.file("") + ":" + path).c_str(), 1);
    const Outcome outcome = run("flight", kSecond);
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return outcome.run;
  }
};

constexpr const char* kFull = "QEMU's buffer for translated code was full";

// 1 MiB is full a hundred times in that second; what QEMU takes by itself, never.
TEST_F(Translation, ABufferThatIsFullIsAFinding) {
  EXPECT_NE(whirl::text_of(flown("-accel tcg,tb-size=1")["findings"]).find(kFull),
            std::string::npos);
  EXPECT_EQ(whirl::text_of(flown("")["findings"]).find(kFull), std::string::npos);
}

TEST_F(Translation, BlocksThatAreNotChainedChangeNoTime) {
  EXPECT_EQ(flown("-d nochain")["digest"], flown("")["digest"]);
}

}  // namespace
