// An SPI bus between two boards: a master's bus that is clocked by hand leads, a slave that notes what it is given follows.
#include "io_bridges/qemu/board/spi_wire.hpp"

#include "io_bridges/devices/spi_bus.hpp"
#include "io_bridges/qemu/board/tests/two_boards.hpp"

namespace whirl::board {
namespace {

constexpr Nanoseconds kLatency_ns = 100'000;
constexpr std::uint32_t kSck_Hz = 1'000'000;
constexpr Nanoseconds kByte_ns = 8'000;

class NotingSlave final : public io::SpiSlave {
 public:
  Nanoseconds shift_out(Nanoseconds now) override {
    out_ns.push_back(now);
    return 5;
  }
  std::uint8_t sampled(std::uint8_t mosi, int bits, Nanoseconds now) override {
    EXPECT_EQ(bits, 8);
    in_ns.push_back(now);
    seen.push_back(mosi);
    return static_cast<std::uint8_t>(mosi + 1);
  }
  int mode() const override { return set_to; }
  int set_to = 3;
  std::vector<Nanoseconds> out_ns, in_ns;
  std::vector<std::uint8_t> seen;
};

class FarSlave : public TwoBoards<WiredBoard> {
 protected:
  FarSlave()
      : leader_(
            here_.ends.lead(end()).value()->port<LeaderSpi>(0, "imu", &seen_ready_, kLatency_ns)) {
    bus_.add(leader_, select_);
    there_.ends.follow(end(), true)
        .value()
        ->port<FollowerSpi>(0, "spi1", slave_, far_select_, &ready_);
    far_select_.watch([this](bool level, Nanoseconds now) { selects_.emplace_back(now, level); });
    seen_ready_.watch([this](bool level, Nanoseconds now) { seen_.emplace_back(now, level); });
    driver_ = select_.add_driver();
    ready_driver_ = ready_.add_driver();
  }
  // A transfer of bytes behind one another, from `start` on; in `mode`.
  void transfer(Nanoseconds start, std::vector<std::uint8_t> bytes, int mode = 3) {
    at(start - 500, [this] { select_.drive(driver_, io::Drive::low, here_.events.now()); });
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const Nanoseconds from = start + static_cast<Nanoseconds>(i) * kByte_ns;
      at(from, [this, mode, b = bytes[i]] { bus_.begin(b, kSck_Hz, mode, here_.events.now()); });
      at(from + kByte_ns, [this, mode, b = bytes[i]] {
        got_.push_back(bus_.transfer(b, kSck_Hz, mode, here_.events.now()));
      });
    }
    at(start + static_cast<Nanoseconds>(bytes.size()) * kByte_ns + 500,
       [this] { select_.drive(driver_, io::Drive::high, here_.events.now()); });
  }
  void at(Nanoseconds when, std::function<void()> what) {
    plans_.push_back(std::make_unique<io::Event>(here_.events, std::move(what)));
    plans_.back()->at(when);
  }
  using Edges = std::vector<std::pair<Nanoseconds, bool>>;

  io::SpiBus bus_{"spi1"};
  io::Wire select_{"cs"}, far_select_{"PA15"}, ready_{"PC4", false}, seen_ready_{"int", false};
  NotingSlave slave_;
  LeaderSpi& leader_;
  int driver_ = 0, ready_driver_ = 0;
  std::vector<std::unique_ptr<io::Event>> plans_;
  std::vector<std::uint8_t> got_;
  Edges selects_, seen_;
};

TEST_F(FarSlave, EachByteGoesOutAtItsFirstClockAndIsTakenHalfAPeriodBeforeItsEnd) {
  transfer(100'000, {0xF5, 0x10});
  run(1);
  EXPECT_EQ(slave_.out_ns, (std::vector<Nanoseconds>{100'000, 108'000}));
  EXPECT_EQ(slave_.in_ns, (std::vector<Nanoseconds>{107'500, 115'500}));
  EXPECT_EQ(slave_.seen, (std::vector<std::uint8_t>{0xF5, 0x10}));
  EXPECT_EQ(got_, (std::vector<std::uint8_t>{0xF6, 0x11}));
  EXPECT_EQ(selects_, (Edges{{99'500, false}, {116'500, true}}));
}

TEST_F(FarSlave, AByteAcrossABoundaryIsOneByte) {
  transfer(996'000, {0x42});
  run(2);
  EXPECT_EQ(slave_.out_ns, (std::vector<Nanoseconds>{996'000}));
  EXPECT_EQ(slave_.in_ns, (std::vector<Nanoseconds>{1'003'500}));
  EXPECT_EQ(got_, (std::vector<std::uint8_t>{0x43}));
}

// Also where it changes between two marks, at one, and just before a boundary.
TEST_F(FarSlave, ItsLineIsSeenByTheStatedLatencyLater) {
  const std::vector<Nanoseconds> changes = {120'000, 150'000, 150'001, 199'999, 999'999, 1'000'000};
  std::vector<std::unique_ptr<io::Event>> edges;
  bool level = false;
  Edges expected;
  for (const Nanoseconds when : changes) {
    level = !level;
    expected.emplace_back(when + kLatency_ns, level);
    edges.push_back(std::make_unique<io::Event>(there_.events, [this, level] {
      ready_.drive(ready_driver_, level ? io::Drive::high : io::Drive::low, there_.events.now());
    }));
    edges.back()->at(when);
  }
  run(2);
  EXPECT_EQ(seen_, expected);
}

TEST_F(FarSlave, AnotherModeThanTheSlavesIsTold) {
  slave_.set_to = 1;
  transfer(100'000, {0xF5});
  run(1);
  EXPECT_TRUE(slave_.seen.empty());
  EXPECT_EQ(got_, (std::vector<std::uint8_t>{0xFF}));
  ASSERT_EQ(there_.findings.size(), 1u);
  EXPECT_EQ(there_.findings[0].what, "is clocked in mode 3 and set to mode 1");
}

TEST_F(FarSlave, CphaZeroIsTold) {
  slave_.set_to = 0;
  transfer(100'000, {0xF5}, 0);
  run(1);
  ASSERT_EQ(there_.findings.size(), 1u);
  EXPECT_NE(there_.findings[0].what.find("CPHA 0 is not carried"), std::string::npos);
}

TEST_F(FarSlave, AFrameOf16BitsIsTold) {
  at(100'000, [this] { select_.drive(driver_, io::Drive::low, here_.events.now()); });
  at(200'000, [this] { got_.push_back(bus_.transfer(1, kSck_Hz, 3, here_.events.now())); });
  run(1);
  EXPECT_EQ(got_, (std::vector<std::uint8_t>{0xFF}));
  ASSERT_EQ(here_.findings.size(), 1u);
  EXPECT_NE(here_.findings[0].what.find("16 bits"), std::string::npos);
}

}  // namespace
}  // namespace whirl::board
