// plan_oracle [--seed FIRST] [--count N] [--show SEED]: random plans with known outcome through the
// judging. Each one that it judges wrongly is made as small as leaving out clauses makes it, and
// printed with its seed. Exit code 1 if there is any.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/scratch_folder.hpp"
#include "harness/tests/oracle/judged.hpp"

namespace whirl::oracle {
namespace {

constexpr int kShown = 20;

std::string wrong_with(std::uint64_t seed, unsigned mask, const std::string& file) {
  const Scenario scenario = make_scenario(seed, mask);
  return complaint(right_outcome(scenario), run_scenario(scenario, file));
}

unsigned shrunk(std::uint64_t seed, const std::string& file) {
  unsigned mask = (1u << (kClauses + 2)) - 1;
  for (int bit = 0; bit < kClauses + 2; ++bit) {
    const unsigned less = mask & ~(1u << bit);
    if (!wrong_with(seed, less, file).empty()) mask = less;
  }
  return mask;
}

void show(std::uint64_t seed, unsigned mask, const std::string& file) {
  const Scenario scenario = make_scenario(seed, mask);
  std::printf("seed %llu, clauses %02x, ending %d at %d ms\n%s%s\n",
              static_cast<unsigned long long>(seed), mask, static_cast<int>(scenario.ending),
              scenario.ending_ms, plan_text(scenario).c_str(),
              wrong_with(seed, mask, file).c_str());
}

int run(std::uint64_t first, std::uint64_t count) {
  const ScratchFolder folder;
  const std::string file = folder.file("plan.lua");
  std::uint64_t wrong = 0;
  long codes[5] = {};
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const Scenario scenario = make_scenario(seed);
    const results::Report report = run_scenario(scenario, file);
    ++codes[results::exit_code(report)];
    if (complaint(right_outcome(scenario), report).empty()) continue;
    if (++wrong <= kShown) show(seed, shrunk(seed, file), file);
  }
  std::printf(
      "%llu plans from seed %llu: %llu judged wrongly (exit codes: %ld x 0, %ld x 1, %ld x 2, %ld "
      "x 3, %ld x 4)\n",
      static_cast<unsigned long long>(count), static_cast<unsigned long long>(first),
      static_cast<unsigned long long>(wrong), codes[0], codes[1], codes[2], codes[3], codes[4]);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace whirl::oracle

int main(int argc, char** argv) {
  std::uint64_t seed = 1, count = 10'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i];
    const std::uint64_t value = std::strtoull(argv[i + 1], nullptr, 10);
    if (key == "--seed") seed = value;
    if (key == "--count") count = value;
    if (key == "--show") {
      const whirl::ScratchFolder folder;
      whirl::oracle::show(value, ~0u, folder.file("plan.lua"));
      return 0;
    }
  }
  return whirl::oracle::run(seed, count);
}
