// Fuzzes the reading of plan files: Lua, and what a plan declares.
#include "harness/fuzz/input_file.hpp"
#include "harness/plan/plan_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A budget that an endless loop uses up in milliseconds.
  const auto file = whirl::plan::PlanFile::load(whirl::fuzz::path_of(data, size),
                                                {.instructions = 100'000, .memory_B = 16u << 20});
  if (!file) std::ignore = file.error().message();
  return 0;
}
