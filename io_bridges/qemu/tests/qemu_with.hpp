// As long as it lives, whoever starts QEMU gives it an option more.
#pragma once
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "base/scratch_folder.hpp"

namespace whirl::board_test {

// Full, with the code of the flight image or of much_code.c, again and again.
inline constexpr const char* kSmall_buffer = "-accel tcg,tb-size=1";

class QemuWith {
 public:
  explicit QemuWith(const std::string& option) : path_(std::getenv("PATH")) {
    const std::string emulator = folder_.file("qemu-system-arm");
    std::ofstream(emulator) << "#!/bin/sh\nPATH=" << path_ << "\nexec qemu-system-arm \"$@\" "
                            << option << "\n";
    EXPECT_EQ(chmod(emulator.c_str(), 0755), 0);
    setenv("PATH", (folder_.file("") + ":" + path_).c_str(), 1);
  }
  ~QemuWith() { setenv("PATH", path_.c_str(), 1); }
  QemuWith(const QemuWith&) = delete;
  QemuWith& operator=(const QemuWith&) = delete;

 private:
  const ScratchFolder folder_;
  const std::string path_;
};

}  // namespace whirl::board_test
