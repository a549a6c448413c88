// Fuzzes the history: any file in its place is rows or one error, before and after a run is added.
#include "results/history.hpp"

#include <fstream>

#include "base/scratch_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace whirl;
  static const ScratchFolder folder("/dev/shm");
  static const std::string file = folder.file("history.sqlite");
  constexpr std::chrono::milliseconds kNone{0};
  std::filesystem::remove(file + "-journal");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  std::ignore = results::recall(file, "", "", 3, kNone).ok();
  results::Report report;
  report.plan = "hover";
  report.expectations.resize(1);
  std::ignore = results::remember(file, report, kNone).ok();
  std::ignore = results::recall(file, "hover", "", 1, kNone).ok();
  return 0;
}
