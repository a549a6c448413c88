// Two boards' buses joined by a wire: a master that is driven by hand leads, a slave of a part follows.
#include "io_bridges/qemu/board/i2c_wire.hpp"

#include "io_bridges/qemu/board/tests/two_boards.hpp"

namespace whirl::board {
namespace {

constexpr Nanoseconds kByte_ns = 22'500;
constexpr std::uint8_t kAddress = 0x2A;

// A slave that holds the clock for a while after each byte that it gets or gives.
class SlowSlave : public io::I2cTarget {
 public:
  SlowSlave(io::EventQueue& events, io::I2cBus& bus, Nanoseconds hold_ns)
      : bus_(bus), hold_ns_(hold_ns), release_(events, [this, &events] {
          ready_ = static_cast<std::uint8_t>(next_++);
          bus_.scl().drive(handle_, io::Drive::none, events.now());
        }) {
    handle_ = bus.scl().add_driver();
    bus.add(*this);
  }
  bool answers(std::uint8_t a) const override { return a == address; }
  bool start(std::uint8_t, bool, Nanoseconds now) override {
    return hold(now), note('A', now), true;
  }
  bool write(std::uint8_t byte, Nanoseconds now) override {
    note('w', now);
    hold(now);
    return byte != 0xEE;
  }
  std::uint8_t read(Nanoseconds) override { return ready_; }
  void acked(bool ack, Nanoseconds now) override {
    note(ack ? 'a' : 'n', now);
    if (ack) hold(now);
  }
  void stop(Nanoseconds now) override {
    note('P', now);
    release_.cancel();
    bus_.scl().drive(handle_, io::Drive::none, now);
  }
  std::uint8_t address = kAddress;
  std::string log;
  std::vector<Nanoseconds> at;

 private:
  void note(char what, Nanoseconds now) {
    log += what;
    at.push_back(now);
  }
  void hold(Nanoseconds now) {
    if (hold_ns_ == 0) {
      ready_ = static_cast<std::uint8_t>(next_++);
      return;
    }
    bus_.scl().drive(handle_, io::Drive::low, now);
    release_.at(now + hold_ns_);
  }
  io::I2cBus& bus_;
  Nanoseconds hold_ns_;
  io::Event release_;
  int handle_ = 0, next_ = 0x40;
  std::uint8_t ready_ = 0xFF;
};

struct Side : WiredBoard {
  io::I2cBus bus{"i2c"};
};

// What a master does, byte by byte, as soon as the clock is free.
class Master {
 public:
  explicit Master(Side& side) : side_(side), next_(side.events, [this] { step(); }) {
    side.bus.scl().watch([this](bool level, Nanoseconds now) {
      if (!level || !waits_) return;
      waits_ = false;
      go_on(now, true);
    });
  }
  void at(Nanoseconds start, bool read, std::vector<std::uint8_t> bytes, Nanoseconds give_up = 0) {
    read_ = read, bytes_ = std::move(bytes), give_up_ = give_up, place_ = -2;
    next_.at(start);
  }
  std::vector<std::uint8_t> got;
  std::vector<Nanoseconds> rose_at;
  Nanoseconds stopped_at = 0;
  std::string acks;

 private:
  void step() {
    io::I2cBus& bus = side_.bus;
    const Nanoseconds now = side_.events.now();
    if (place_ == static_cast<int>(bytes_.size())) return stop();
    if (place_ >= 0 && waits_) return stop();  // it has waited long enough
    if (place_ == -2) {
      bus.start(now);
    } else if (place_ == -1) {
      acks += bus.address(kAddress, read_, now) ? 'a' : 'n';
      if (acks.back() == 'n') return stop();
    } else if (read_) {
      got.push_back(bus.fetch(now));
      bus.answer(place_ + 1 < static_cast<int>(bytes_.size()), now);
    } else {
      acks += bus.write(bytes_[static_cast<std::size_t>(place_)], now) ? 'a' : 'n';
    }
    ++place_;
    if (place_ == static_cast<int>(bytes_.size())) return finish();
    if (bus.scl().level()) return go_on(now, bus.released_ns() > now);
    waits_ = true;
    if (give_up_ != 0) next_.at(now + give_up_);
  }
  void go_on(Nanoseconds now, bool held) {
    const Nanoseconds from = std::max(now, side_.bus.released_ns());
    if (held) rose_at.push_back(from);
    next_.at(from + kByte_ns);
  }
  void finish() {
    const Nanoseconds now = side_.events.now();
    if (side_.bus.released_ns() > now && side_.bus.scl().level()) return go_on(now, true);
    if (side_.bus.scl().level()) return stop();
    waits_ = true;
    next_.in(give_up_ != 0 ? give_up_ : 10 * kGrain_ns);
  }
  void stop() {
    waits_ = false;
    stopped_at = side_.events.now();
    side_.bus.stop(stopped_at);
  }
  Side& side_;
  io::Event next_;
  bool read_ = false, waits_ = false;
  std::vector<std::uint8_t> bytes_;
  Nanoseconds give_up_ = 0;
  int place_ = -2;
};

class FarBus : public TwoBoards<Side> {
 protected:
  void join(Nanoseconds hold_ns) {
    slave_ = std::make_unique<SlowSlave>(there_.events, there_.bus, hold_ns);
    auto ear = std::make_unique<io::I2cBus>("ear");
    ear_ = ear.get();
    here_.ends.lead(end()).value()->port<LeaderI2c>(0, here_.bus).add(kAddress, std::move(ear));
    there_.ends.follow(end(), shared_).value()->port<FollowerI2c>(0, there_.bus);
  }
  Master master_{here_};
  io::I2cBus* ear_ = nullptr;
  std::unique_ptr<SlowSlave> slave_;
  bool shared_ = false;
};

TEST_F(FarBus, AWriteArrivesToTheNanosecondAndItsAcknowledgesComeBack) {
  join(0);
  master_.at(100'000, false, {1, 0xEE, 3});
  run(2);
  EXPECT_EQ(master_.acks, "aana");
  EXPECT_EQ(slave_->log, "AwwwP");
  EXPECT_EQ(slave_->at, (std::vector<Nanoseconds>{122'500, 145'000, 167'500, 190'000, 190'000}));
  EXPECT_EQ(master_.stopped_at, 190'000);
  EXPECT_FALSE(there_.bus.busy());
}

// The master's core may compute then, and stops for no event but its bus's own.
TEST_F(FarBus, AHoldWhoseEndIsKnownNeitherMovesTheMastersClockLineNorSetsAnEvent) {
  join(7'000);
  int edges = 0;
  here_.bus.scl().watch([&](bool, Nanoseconds) { ++edges; });
  master_.at(100'000, false, {1, 2});
  run(2);
  EXPECT_EQ(master_.rose_at, (std::vector<Nanoseconds>{129'500, 159'000, 188'500}));
  EXPECT_EQ(edges, 0);
}

TEST_F(FarBus, AReadHasTheBytesThatWereReadyWhenTheClockRose) {
  join(7'000);
  master_.at(100'000, true, {0, 0, 0});
  run(2);
  EXPECT_EQ(master_.got, (std::vector<std::uint8_t>{0x40, 0x41, 0x42}));
  EXPECT_EQ(slave_->log, "AaanP");
  EXPECT_EQ(master_.rose_at, (std::vector<Nanoseconds>{129'500, 159'000, 188'500}));
}

// A fault on the follower's end of the wire, as one on the leader's end would be.
class Stretches : public io::I2cFaults {
 public:
  explicit Stretches(Nanoseconds hold_ns) : hold_ns_(hold_ns) {}
  bool deaf(std::uint8_t, Nanoseconds) override { return false; }
  bool ack(std::uint8_t, int, Nanoseconds) override { return true; }
  std::uint8_t byte(std::uint8_t, int, std::uint8_t value, Nanoseconds) override { return value; }
  Nanoseconds stretch(std::uint8_t, Nanoseconds) override { return hold_ns_; }

 private:
  Nanoseconds hold_ns_;
};

TEST_F(FarBus, AHoldThatAFaultMakesAtEitherEndIsSeenAtBoth) {
  join(0);
  Stretches stretches(1'200'000);  // beyond a boundary
  master_.at(100'000, false, {1, 2});
  there_.bus.set_faults(&stretches);
  run(3);
  const std::vector<Nanoseconds> rose = master_.rose_at, heard = slave_->at;
  EXPECT_EQ(rose, (std::vector<Nanoseconds>{1'322'500}));
  there_.bus.set_faults(nullptr);
  here_.bus.set_faults(&stretches);
  master_.at(now_ns_ + 100'000, false, {1, 2});
  run(3);
  ASSERT_EQ(master_.rose_at.size(), 2u);
  EXPECT_EQ(master_.rose_at[1] - rose[0], 3'000'000);
  ASSERT_EQ(slave_->at.size(), 2 * heard.size());
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(slave_->at[heard.size() + i] - heard[i], 3'000'000) << i;
  }
}

// For it does not know what comes on its other buses.
TEST_F(FarBus,
       WithOtherBusesOnItsWireTheFollowerNeverRunsAheadAndTheEndOfAHoldIsSeenAtTheNextLook) {
  shared_ = true;
  join(6'300);
  master_.at(100'000, false, {1, 2});
  run(2);
  EXPECT_EQ(slave_->log, "AwwP");
  // 6.3 us are seen after 7; the next byte follows from there.
  EXPECT_EQ(master_.rose_at, (std::vector<Nanoseconds>{129'500, 159'000, 188'500}));
  EXPECT_EQ(slave_->at, (std::vector<Nanoseconds>{122'500, 152'000, 181'500, 211'000}));
  there_.ends.run_ends(now_ns_);
  EXPECT_TRUE(there_.findings.empty());
}

// 0.3 ms are six questions; the one at 0.85 ms is held across the boundary.
TEST_F(FarBus, ALongHoldEndsWhenTheSlaveLetsGoAlsoBeyondABoundary) {
  join(300'000);
  master_.at(827'500, false, {1, 2});
  run(4);
  EXPECT_EQ(master_.rose_at, (std::vector<Nanoseconds>{1'150'000, 1'472'500, 1'795'000}));
  EXPECT_TRUE(there_.findings.empty());
}

// The follower was at most kHeld_ns ahead when the STOP came.
TEST_F(FarBus, AMasterThatGivesUpIsHeardLateByTheCapAtMostAndThatIsTold) {
  join(600'000);
  master_.at(77'500, false, {1, 2}, 130'000);
  run(2);
  EXPECT_EQ(master_.stopped_at, 100'000 + 130'000);
  ASSERT_EQ(slave_->log, "AP");
  EXPECT_GT(slave_->at[1], master_.stopped_at);
  EXPECT_LE(slave_->at[1], master_.stopped_at + FollowerWire::kHeld_ns);
  there_.ends.run_ends(now_ns_);
  ASSERT_EQ(there_.findings.size(), 1u);
  EXPECT_NE(there_.findings[0].what.find("1 conditions came late"), std::string::npos)
      << there_.findings[0].what;
  EXPECT_TRUE(here_.bus.scl().level());
}

// BUSY of the other board's bus, and nothing in its log.
TEST_F(FarBus, WhatIsForOthersMakesTheFollowersBusBusyAndNothingElse) {
  join(0);
  int logged = 0;
  there_.bus.on_transaction([&](const io::I2cTransaction&) { ++logged; });
  io::Event others(here_.events, [this] { here_.bus.start(here_.events.now()); });
  io::Event address(here_.events, [this] { here_.bus.address(0x11, false, here_.events.now()); });
  others.at(500'000);
  address.at(522'500);
  run(1);
  EXPECT_TRUE(there_.bus.busy());
  io::Event stop(here_.events, [this] { here_.bus.stop(here_.events.now()); });
  stop.at(now_ns_ + 10'000);
  run(1);
  EXPECT_FALSE(there_.bus.busy());
  EXPECT_EQ(logged, 0);
  EXPECT_EQ(slave_->log, "");
}

// At the nanosecond at which the slave itself acts it does so first, every time.
TEST_F(FarBus, WhatComesActsAfterTheBoardsOwnOfThatNanosecond) {
  join(0);
  std::string order;
  io::Event own(there_.events, [&] { order += there_.bus.busy() ? "late" : "first"; });
  own.at(100'000);
  master_.at(100'000, false, {1});
  run(1);
  EXPECT_EQ(order, "first");
}

TEST_F(FarBus, AnAddressThatNobodyEverAnsweredIsTold) {
  join(0);
  here_.ends.run_ends(0);
  EXPECT_TRUE(here_.findings.empty());  // nor was it asked
  slave_->address = 0x2B;
  master_.at(100'000, false, {1});
  run(1);
  EXPECT_EQ(master_.acks, "n");
  here_.ends.run_ends(now_ns_);
  ASSERT_EQ(here_.findings.size(), 1u);
  EXPECT_NE(here_.findings[0].what.find("0x0000002a, asked 1 times"), std::string::npos)
      << here_.findings[0].what;
}

TEST_F(FarBus, AClosedWireEndsBothWhateverTheyWaitFor) {
  join(0);
  wire_.value().close();
  master_.at(100'000, false, {1});
  run(1);
  EXPECT_TRUE(here_.closed);
  EXPECT_TRUE(there_.closed);
}

}  // namespace
}  // namespace whirl::board
