#include "harness/cli/doctor.hpp"

#include <cstdio>
#include <filesystem>

#include "harness/cli/first_line.hpp"
#include "harness/target/virtual_board.hpp"

namespace whirl::cli {
namespace {

class Examination {
 public:
  void line(bool good, const std::string& what, const std::string& found, const std::string& cure) {
    std::printf("%-8s %-22s %s\n", good ? "ok" : "MISSING", what.c_str(),
                good ? found.c_str() : cure.c_str());
    missing_ += good ? 0 : 1;
  }
  void tool(const std::string& name, const std::string& package) {
    const std::string found = first_line(name + " --version");
    line(!found.empty(), name, found, "apt-get install " + package);
  }
  void file(const std::string& what, const std::string& path, const std::string& cure) {
    line(std::filesystem::exists(path), what, path, cure);
  }
  int missing() const { return missing_; }

 private:
  int missing_ = 0;
};

}  // namespace

int doctor_command(const std::string& root) {
  Examination e;
  const auto qemu = probe_qemu();
  e.line(qemu.ok(), "qemu-system-arm", qemu ? qemu.value() : "",
         qemu ? "" : qemu.error().message());
  e.file("board plug-in", default_plugin(), "./whirl builds it; or: cmake --build --preset host");
  e.file("flight image", root + "/build/firmware/flight.elf",
         "./whirl builds it; or: cmake --build --preset firmware");
  e.tool("arm-none-eabi-g++", "gcc-arm-none-eabi libnewlib-arm-none-eabi");
  e.tool("gdb-multiarch", "gdb-multiarch   (only for whirl run --gdb)");
  e.tool("cmake", "cmake");
  e.tool("ninja", "ninja-build");
  e.tool("clang-format-14", "clang-format-14   (only for whirl test and lint)");
  e.tool("clang-tidy-14", "clang-tidy-14   (only for whirl lint)");
  e.line(std::filesystem::exists("/dev/shm"), "/dev/shm", "shared memory for the board",
         "mount a tmpfs at /dev/shm");
  std::printf(e.missing() == 0 ? "all there\n" : "%d missing\n", e.missing());
  return e.missing() == 0 ? 0 : 2;
}

}  // namespace whirl::cli
