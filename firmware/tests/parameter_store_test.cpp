#include "firmware/config/parameter_store.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace fw {
namespace {

struct PowerCut {};

// Flash as a part has it: programming clears bits, an erase sets them. The supply may fail in the middle
// of any operation: some bits of the word have taken then, each word of an erase is as it was, blank or
// anything between.
class FakeFlash {
 public:
  static constexpr std::uint32_t kWords = 128;

  std::uint32_t read(unsigned sector, std::uint32_t word) const { return cells_[sector][word]; }
  Status program(unsigned sector, std::uint32_t word, std::uint32_t value) {
    const bool cut = --operations_left_ == 0;
    ++programmed_;
    std::uint32_t& cell = cells_[sector].at(word);
    EXPECT_EQ(cell, 0xFFFF'FFFFu) << "word " << word << " is in use";
    if (bad_word_ == static_cast<int>(word))
      return Status::ok;  // does not take, and nobody notices
    cell &= cut ? value | random_() : value;
    if (cut) throw PowerCut();
    return refuses_ ? Status::bad_data : Status::ok;
  }
  Status erase(unsigned sector) {
    ++erased_;
    const bool cut = --operations_left_ == 0;
    for (std::uint32_t& cell : cells_[sector]) {
      if (!cut || random_() % 2 == 0) cell = 0xFFFF'FFFF;
      if (cut && random_() % 4 == 0) cell |= random_();
    }
    if (cut) throw PowerCut();
    return Status::ok;
  }

  void cut_at(int operation, unsigned seed) {
    operations_left_ = operation;
    random_.seed(seed);
  }
  void flip(unsigned sector, std::uint32_t word, unsigned bit) {
    cells_[sector][word] ^= 1u << bit;
  }
  void fill(unsigned sector, std::uint32_t value) { cells_[sector].fill(value); }
  void set_bad_word(int word) { bad_word_ = word; }
  void set_refuses(bool refuses) { refuses_ = refuses; }
  int programmed() const { return programmed_; }
  int erased() const { return erased_; }

 private:
  std::array<std::array<std::uint32_t, kWords>, 2> cells_ = [] {
    std::array<std::array<std::uint32_t, kWords>, 2> cells;
    for (auto& sector : cells) sector.fill(0xFFFF'FFFF);
    return cells;
  }();
  std::mt19937 random_{1};
  int operations_left_ = 0, programmed_ = 0, erased_ = 0, bad_word_ = -1;
  bool refuses_ = false;
};

using Store = ParameterStore<FakeFlash>;

// Two parameters that always change together: a mix of two sets would show.
void set_pair(Parameters& parameters, int number) {
  parameters.set(Parameter::est_start_tilt_deg, static_cast<float>(number % 40));
  parameters.set(Parameter::est_start_scale, 0.5f + static_cast<float>(number % 40) / 40.0f);
}

// The number of the pair, -1: a mix.
int pair_of(const Parameters& parameters) {
  for (int number = 0; number < 40; ++number) {
    Parameters pair;
    set_pair(pair, number);
    const auto same = [&](Parameter p) { return pair.get(p) == parameters.get(p); };
    if (same(Parameter::est_start_tilt_deg) && same(Parameter::est_start_scale)) return number;
  }
  const bool untouched = parameters.get(Parameter::est_start_tilt_deg) == 0.0f &&
                         parameters.get(Parameter::est_start_scale) == 1.0f;
  return untouched ? 40 : -1;  // as the table starts them
}

struct Boot {
  Parameters parameters;
  Store store;

  explicit Boot(FakeFlash& flash) : store(flash) { store.load(parameters); }
  void run(unsigned ticks = 600) {
    for (unsigned i = 0; i < ticks; ++i) store.step(parameters);
  }
  void save(int number) {
    set_pair(parameters, number);
    run();
  }
};

int read_back(FakeFlash& flash) {
  return pair_of(Boot(flash).parameters);
}

TEST(ParameterStore, BlankFlashGivesTheTablesValuesAndIsNotTouched) {
  FakeFlash flash;
  Boot boot(flash);
  boot.run(2000);
  EXPECT_EQ(pair_of(boot.parameters), 40);
  EXPECT_EQ(flash.programmed(), 0);
  EXPECT_EQ(flash.erased(), 0);
}

TEST(ParameterStore, KeepsWhatWasSet) {
  FakeFlash flash;
  Boot(flash).save(3);
  EXPECT_EQ(read_back(flash), 3);
  Boot(flash).save(4);
  EXPECT_EQ(read_back(flash), 4);
}

TEST(ParameterStore, AParameterSetBackToItsStartIsKeptToo) {
  FakeFlash flash;
  Boot(flash).save(3);
  Boot boot(flash);
  boot.parameters.set(Parameter::est_start_tilt_deg, 0.0f);
  boot.parameters.set(Parameter::est_start_scale, 1.0f);
  boot.run();
  EXPECT_EQ(read_back(flash), 40);
}

TEST(ParameterStore, WritesAWordPerCallAndWaitsUntilNothingMoreChanges) {
  FakeFlash flash;
  Boot boot(flash);
  set_pair(boot.parameters, 1);
  boot.run(Store::kQuiet_calls - 1);
  set_pair(boot.parameters, 2);
  boot.run(Store::kQuiet_calls - 1);
  EXPECT_EQ(flash.programmed(), 0);
  for (int before = 0, call = 0; call < 10; ++call) {
    boot.store.step(boot.parameters);
    EXPECT_LE(flash.programmed() - before, 1);
    before = flash.programmed();
  }
  EXPECT_EQ(flash.programmed(), 8);  // three words of head, two entries, the CRC
  EXPECT_TRUE(boot.store.saved(boot.parameters));
  EXPECT_EQ(read_back(flash), 2);
}

TEST(ParameterStore, AChangeWhileItWritesIsForTheNextRecord) {
  FakeFlash flash;
  Boot boot(flash);
  set_pair(boot.parameters, 1);
  boot.run(Store::kQuiet_calls + 4);
  set_pair(boot.parameters, 2);
  boot.run(4);
  EXPECT_EQ(read_back(flash), 1);
  boot.run();
  EXPECT_EQ(read_back(flash), 2);
}

// Boots and saves pair after pair until the supply fails in operation number `cut`, which no matter
// where it was leaves the pair before or the one that was under way; and then goes on to work.
void expect_old_or_new(int cut, unsigned seed) {
  FakeFlash flash;
  Boot(flash).save(0);
  flash.cut_at(cut, seed);
  int old = 0, wanted = 0;
  try {
    for (wanted = 1;; ++wanted) {
      Boot boot(flash);
      ASSERT_EQ(pair_of(boot.parameters), old) << "cut " << cut;
      boot.save(wanted);
      old = wanted;
    }
  } catch (const PowerCut&) {
  }
  const int found = read_back(flash);
  EXPECT_TRUE(found == old || found == wanted)
      << "cut " << cut << ", seed " << seed << ": " << found << " instead of " << old << " or "
      << wanted;
  for (int later = 30; later < 40; ++later) {
    Boot(flash).save(later);
    EXPECT_EQ(read_back(flash), later) << "cut " << cut << ", seed " << seed;
  }
}

// 20 saves of 8 words go on from one sector of 128 words into the other: that, and the erase after it, are
// among them.
TEST(ParameterStore, APowerCutAtAnyMomentLeavesTheOldSetOrTheNewOne) {
  for (int cut = 1; cut <= 20 * 8 + 2; ++cut) {
    for (unsigned seed = 0; seed < 8; ++seed) expect_old_or_new(cut, seed);
  }
}

TEST(ParameterStore, AnEraseThatIsCutIsMadeAgain) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    FakeFlash flash;
    for (int i = 0; i < 17; ++i) Boot(flash).save(i);  // the last is in the second sector
    EXPECT_EQ(flash.erased(), 0);
    flash.cut_at(1, seed);
    EXPECT_THROW(Boot{flash}, PowerCut);
    EXPECT_EQ(read_back(flash), 16);
    EXPECT_EQ(Boot(flash).store.generation(), 17u);
    EXPECT_EQ(flash.read(0, 0), 0xFFFF'FFFFu);
  }
}

TEST(ParameterStore, OneStartHasRoomForASectorOfSavesAndThenSaysSo) {
  FakeFlash flash;
  Boot boot(flash);
  for (int i = 0; i < 32; ++i) {
    boot.save(i);
    EXPECT_FALSE(boot.store.gave_up(boot.parameters)) << i;
  }
  boot.save(32);
  EXPECT_TRUE(boot.store.gave_up(boot.parameters));
  EXPECT_EQ(flash.erased(), 0);
  EXPECT_EQ(read_back(flash), 31);
  Boot(flash).save(33);  // the start has made room
  EXPECT_EQ(read_back(flash), 33);
}

TEST(ParameterStore, CountsItsErases) {
  FakeFlash flash;
  for (int i = 0; i < 80; ++i) Boot(flash).save(i);
  EXPECT_EQ(flash.erased(), 4);
  EXPECT_EQ(Boot(flash).store.erases(), 4u);
  EXPECT_EQ(Boot(flash).store.generation(), 80u);
}

TEST(ParameterStore, ARottenBitGivesTheSetBefore) {
  for (std::uint32_t word = 8; word < 16; ++word) {
    for (unsigned bit = 0; bit < 32; ++bit) {
      FakeFlash flash;
      Boot(flash).save(1);
      Boot(flash).save(2);
      flash.flip(0, word, bit);
      EXPECT_EQ(read_back(flash), 1) << "word " << word << ", bit " << bit;
    }
  }
}

TEST(ParameterStore, AWordThatDoesNotTakeIsNoticedAndLeftBehind) {
  FakeFlash flash;
  flash.set_bad_word(5);
  Boot(flash).save(1);
  EXPECT_EQ(read_back(flash), 1);
  EXPECT_EQ(flash.programmed(), 6 + 8);
}

TEST(ParameterStore, FlashThatRefusesIsGivenUpUntilTheNextChange) {
  FakeFlash flash;
  Boot boot(flash);
  flash.set_refuses(true);
  boot.save(1);
  EXPECT_TRUE(boot.store.gave_up(boot.parameters));
  EXPECT_EQ(flash.programmed(), Store::kTries);
  flash.set_refuses(false);
  boot.save(2);
  EXPECT_FALSE(boot.store.gave_up(boot.parameters));
  EXPECT_EQ(read_back(flash), 2);
}

// Where an image that reached into the sectors was flashed before.
TEST(ParameterStore, SectorsFullOfSomethingElseAreMadeRoomIn) {
  for (const std::uint32_t junk : {0u, 0x5041'0002u, 0x5041'FFFFu, 0x4770'B510u}) {
    FakeFlash flash;
    flash.fill(0, junk);
    flash.fill(1, junk);
    Boot(flash).save(5);
    EXPECT_EQ(read_back(flash), 5) << std::hex << junk;
  }
}

}  // namespace
}  // namespace fw
