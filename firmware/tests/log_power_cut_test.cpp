// The card's supply cut at 200 random instants of a session: opening, logging, closing.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <sstream>

#include "base/random.hpp"
#include "firmware/tests/log_rig.hpp"

namespace fw {
namespace {

constexpr int kCuts = 200;
constexpr int kSession_ms = 2600, kClose_ms = 2400;
// A flush is due each second; the one under way may wait for a stall of the card.
constexpr double kSafe_after_ms = 1000.0 + 260.0;

struct Cut {
  LogState state = LogState::no_card;
  std::uint32_t safe_records = 0;  // appended so long before it that they must be there
  std::uint32_t files = 0;
};

Cut run_session(LogRig& rig, double cut_ms) {
  rig.rig.add(io::FaultKind::memory_removed, cut_ms, -1.0);
  std::deque<std::pair<double, std::uint32_t>> appended;
  for (int ms = 0; ms < kSession_ms && rig.rig.now_ms() < cut_ms - 1.0; ++ms) {
    if (ms == kClose_ms) rig.log.close();
    rig.step_ms();
    appended.emplace_back(rig.rig.now_ms(), rig.appended);
  }
  Cut cut{rig.log.state(), 0, rig.log.files()};
  for (int i = 0; i < 200 && rig.rig.now_ms() < cut_ms + 0.5; ++i) {
    if (rig.rig.now_ms() < cut_ms) cut.state = rig.log.state();
    rig.quarter_ms();
  }
  for (const auto& [at_ms, count] : appended) {
    if (at_ms <= cut_ms - kSafe_after_ms) cut.safe_records = count;
  }
  return cut;
}

// When a session without a cut opens, logs and closes.
struct Times {
  double opening_ms = 0.0, logging_ms = 0.0, closing_ms = 0.0, closed_ms = 0.0;
};
Times times_of(const TestFolder& folder) {
  LogRig rig(folder, "base.img", CardRig::quick());
  Times t;
  rig.until(LogState::opening, kSession_ms);
  t.opening_ms = rig.rig.now_ms();
  rig.until(LogState::logging, kSession_ms);
  t.logging_ms = rig.rig.now_ms();
  while (rig.rig.now_ms() < kClose_ms) rig.step_ms();
  rig.log.close();
  t.closing_ms = rig.rig.now_ms();
  rig.until(LogState::closed, kSession_ms);
  t.closed_ms = rig.rig.now_ms();
  return t;
}

// What fsck.fat may say in that state; each is a line's beginning of its own words.
bool may_say(LogState state, const std::string& line) {
  static const char* const kAlways[] = {"fsck.fat", "Leaving filesystem unchanged",
                                        "Free cluster summary uninitialized"};
  static const char* const kFats[] = {"FATs differ but appear to be intact", "  Using first FAT",
                                      "Reclaimed"};
  static const char* const kSize[] = {"/LOG00001.ULG", "  File size is", "  Truncating"};
  const auto begins = [&line](const auto& words) {
    return std::any_of(std::begin(words), std::end(words),
                       [&line](const char* word) { return line.starts_with(word); });
  };
  if (line.empty() || begins(kAlways) || line.starts_with(testing::TempDir())) return true;
  if (state != LogState::logging && begins(kFats)) return true;
  return state == LogState::closing && begins(kSize);
}

TEST(LogPowerCut, LosesAtMostASecondAndHurtsNothingElse) {
  TestFolder folder;
  make_volume(folder, "base.img");
  whirl::RandomStream random(1, "log_power_cut");
  const Times t = times_of(folder);
  std::map<LogState, int> seen, clean, longer;
  for (int i = 0; i < kCuts; ++i) {
    // Half of them in the short times of opening and closing.
    const double u = random.uniform();
    const double cut_ms = i % 4 == 0   ? t.opening_ms + (t.logging_ms - t.opening_ms) * u
                          : i % 4 == 1 ? t.closing_ms + (t.closed_ms - t.closing_ms) * u
                                       : t.opening_ms + (t.closed_ms - t.opening_ms) * u;
    io::SdCard::Params params = CardRig::quick();
    params.seed = static_cast<std::uint64_t>(i) + 1;
    params.stall_every = 300.0;
    LogRig rig(folder, "base.img", params);
    const Cut cut = run_session(rig, cut_ms);
    ++seen[cut.state];

    const ToolSaid checked = run_tool("fsck.fat -n " + rig.image_path);
    longer[cut.state] += checked.words.find("File size is") != std::string::npos ? 1 : 0;
    clean[cut.state] += checked.code == 0 ? 1 : 0;
    if (cut.state == LogState::logging) {
      EXPECT_EQ(checked.code, 0) << cut_ms << "\n" << checked.words;
    }
    std::istringstream lines(checked.words);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_TRUE(may_say(cut.state, line)) << cut_ms << ": " << line << "\n" << checked.words;
    }
    const std::string out = folder.file("out");
    std::filesystem::remove(out);
    ASSERT_EQ(run_tool("mcopy -n -i " + rig.image_path + " ::OTHER.TXT " + out).code, 0) << cut_ms;
    EXPECT_EQ(bytes_of(out), std::string(100'000, 'o'));
    if (cut.safe_records == 0) continue;
    std::filesystem::remove(out);
    ASSERT_EQ(run_tool("mcopy -n -i " + rig.image_path + " ::LOG00001.ULG " + out).code, 0);
    EXPECT_GE(records_in(bytes_of(out)), cut.safe_records) << cut_ms;
  }
  for (const auto& [state, count] : seen) {
    std::printf("cut in state %d: %d, clean for fsck.fat %d, chain longer than size %d\n",
                static_cast<int>(state), count, clean[state], longer[state]);
  }
  EXPECT_GE(seen[LogState::opening], 20);
  EXPECT_GE(seen[LogState::logging], 60);
  EXPECT_GE(seen[LogState::closing], 10);
}

}  // namespace
}  // namespace fw
