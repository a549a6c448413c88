// The flight image's own board, its ESCs once as devices on its bus and once beyond wires, behind which a hand
// gives the same bytes and holds the clock as long: all that crosses is the same to the nanosecond. So where flights
// of real ESC images differ from those with the device in the times of their STARTs, they differ by what these
// images answer, and by when they let go of the clock: a STM32's slave holds it from its address on until its
// interrupt has read that.
#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <set>
#include <thread>

#include "harness/catalogue/board_file.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/devices/faults.hpp"
#include "io_bridges/link/wire.hpp"

namespace whirl::board_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using io::WireAct;
using io::WireAnswer;

constexpr std::int64_t kMs = 1'000'000;
constexpr int kMilliseconds = 300;
constexpr std::size_t kEscs = 4;
constexpr std::uint16_t kEscBus = 3;

// One board's run: what it told, and of that the ESCs' bus.
struct Told {
  std::string error;
  // Every message but the statistics, which know the wires, and what a fault did. Those of one nanosecond are in
  // no order: whether a device tells of its set-point before its bus does of the transaction is nobody's time.
  std::multiset<std::pair<std::int64_t, Bytes>> all;
  std::vector<std::int64_t> starts_ns;  // on the ESCs' bus
  std::map<int, Bytes> read;            // of each address, one after the other

  void keep(const io::Batch& batch) {
    for (io::Reader r(batch.bytes()); r.next();) {
      const io::Kind kind = r.header().kind;
      if (kind == io::Kind::statistics || kind == io::Kind::fault_applied) continue;
      const auto* head = reinterpret_cast<const std::uint8_t*>(&r.header());
      Bytes message(head, head + sizeof(io::Header));
      message.insert(message.end(), r.payload().begin(), r.payload().end());
      all.emplace(r.header().t_ns, std::move(message));
      if (kind != io::Kind::i2c_transaction || r.header().port != kEscBus) continue;
      const auto t = r.as<io::BusTransaction>();
      starts_ns.push_back(t.start_ns);
      const auto bytes = r.transferred();
      if (t.read != 0) read[t.address].insert(read[t.address].end(), bytes.begin(), bytes.end());
    }
  }
};

// Plays one ESC at the far end of a wire: acknowledges, gives these bytes, holds the clock after its address.
class FarHand {
 public:
  FarHand(const io::BoardWire& wire, Bytes bytes, std::int64_t hold_ns)
      : wire_(std::move(io::BoardWire::attach(dup(wire.fd())).value())),
        bytes_(std::move(bytes)),
        hold_ns_(hold_ns),
        thread_([this] { play(); }) {}
  ~FarHand() {
    wire_.close();
    thread_.join();
  }
  FarHand(const FarHand&) = delete;
  FarHand& operator=(const FarHand&) = delete;

 private:
  void play() {
    while (const io::WireMessage* front = wire_.front()) {
      const io::WireMessage message = *front;
      wire_.pop();
      const bool address = message.act == WireAct::address;
      const bool acked = message.act == WireAct::acked && message.flag != 0;
      if (!address && !acked && message.act != WireAct::write) continue;
      WireAnswer answer{.t_ns = message.t_ns + (address ? hold_ns_ : 0), .ack = 1};
      answer.has_byte = acked || (address && message.flag != 0);
      if (answer.has_byte && given_ < bytes_.size()) answer.byte = bytes_[given_++];
      wire_.answer(answer);
    }
  }

  io::BoardWire wire_;
  Bytes bytes_;
  std::int64_t hold_ns_;
  std::size_t given_ = 0;
  std::thread thread_;
};

std::uint8_t address_of(std::size_t esc) {
  return static_cast<std::uint8_t>(0x29 + esc);
}

// A device's bytes differ from read to read, as those of a motor do.
io::EscState state_of(std::size_t esc, int k) {
  return {0.1 * (k % 7), 100.0 * static_cast<double>(esc) + k, 0, {}};
}

io::FaultCommand held(std::size_t esc, std::int64_t hold_ns) {
  io::FaultCommand fault;
  fault.number = static_cast<std::uint32_t>(esc);
  fault.kind = static_cast<std::uint32_t>(io::FaultKind::i2c_late);
  fault.end_ns = io::kNever;
  fault.bus = kEscBus;
  fault.address = address_of(esc);
  fault.value = 1e-9 * static_cast<double>(hold_ns);
  return fault;
}

// hold_ns: of the devices, by a fault of the bus.
Told run_flight(std::vector<WireEnd> wires, std::int64_t hold_ns) {
  Told told;
  const auto board = read_board(std::string(WHIRL_ROOT) + "/test_plans/boards/px4fmu_v1.lua");
  if (!board) return told.error = board.error().message(), told;
  VirtualBoardOptions options;
  options.board = {board.value(),
                   {.image = WHIRL_FIRMWARE "/flight.elf", .wires = std::move(wires)}};
  VirtualBoard target(options);
  if (const auto started = target.start(); !started) {
    return told.error = started.error().message(), told;
  }
  io::Batch happened;
  for (int k = 0; k < kMilliseconds; ++k) {
    io::Batch sensed;
    for (std::size_t esc = 0; esc < kEscs; ++esc) {
      sensed.add(io::Kind::esc_state, static_cast<std::uint16_t>(esc + 1), k * kMs,
                 state_of(esc, k));
      if (k == 0 && hold_ns != 0) sensed.add(io::Kind::fault, 0, 0, held(esc, hold_ns), "hold", 4);
    }
    target.run((k + 1) * kMs, sensed);
    const auto state = target.arrive(happened);
    told.keep(happened);
    if (!state) return told.error = state.error().message(), told;
  }
  target.stop(happened);
  told.keep(happened);
  return told;
}

Told run_with_hands(const std::map<int, Bytes>& read, std::int64_t hold_ns) {
  std::vector<io::BoardWire> wires;
  std::vector<std::unique_ptr<FarHand>> hands;
  std::vector<WireEnd> ends;
  for (std::size_t esc = 0; esc < kEscs; ++esc) {
    wires.push_back(std::move(io::BoardWire::create(1 + kEscs).value()));
    ends.push_back({.device = "esc" + std::to_string(esc + 1), .fd = wires.back().fd()});
    hands.push_back(std::make_unique<FarHand>(wires.back(), read.at(address_of(esc)), hold_ns));
  }
  return run_flight(ends, 0);
}

// A slave's first byte is held from its address on. What is shorter than the master's own interrupt then takes
// moves nothing.
constexpr std::int64_t kHidden_ns = 800, kSeen_ns = 5'000, kLong_ns = 40'000;

class FarSlave : public ::testing::TestWithParam<std::int64_t> {};
INSTANTIATE_TEST_SUITE_P(Holds, FarSlave,
                         ::testing::Values(0, 244, kHidden_ns, kSeen_ns, kLong_ns));

TEST_P(FarSlave, AllIsAsWithADeviceOnTheBusThatHoldsTheClockAsLong) {
  const Told device = run_flight({}, GetParam());
  ASSERT_EQ(device.error, "");
  ASSERT_GT(device.starts_ns.size(), 80U);
  ASSERT_EQ(device.read.size(), kEscs);
  const Told hand = run_with_hands(device.read, GetParam());
  ASSERT_EQ(hand.error, "");
  EXPECT_EQ(hand.starts_ns, device.starts_ns);
  EXPECT_TRUE(hand.all == device.all);
}

// The image starts its pause between two transactions when the first one's STOP is out, by a timer of 84 MHz: so
// a longer hold moves the STARTs behind it, by some of that timer's ticks or by whole ones of its 1 us.
TEST(Flight, StartsLaterBehindAHoldThatItHasToWaitFor) {
  const Told plain = run_flight({}, 0);
  ASSERT_EQ(plain.error, "");
  EXPECT_EQ(run_flight({}, kHidden_ns).starts_ns, plain.starts_ns);
  EXPECT_NE(run_flight({}, kSeen_ns).starts_ns, plain.starts_ns);
}

}  // namespace
}  // namespace whirl::board_test
