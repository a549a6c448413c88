// The flight image's own driver at the end of a GPS's line on the bench, through copper that the test makes of a
// pseudo-terminal: each character is read as a UART reads it at its own rate, the driver's there, the adapter's here.
#include <gtest/gtest.h>

#include <deque>

#include "firmware/drivers/ublox_gps.hpp"
#include "harness/target/bench/gps_line.hpp"
#include "io_bridges/devices/uart_sampling.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Two ends of a wire, each with its rate; a character takes its time.
class Copper {
 public:
  explicit Copper(io::PseudoTerminal& line) : line_(line) {}

  // ---- The driver's UART
  void set_baud(std::uint32_t baud) { baud_ = baud; }
  fw::Status send(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes)
      out_.push_back({byte, static_cast<double>(baud_), now_ns_});
    return fw::Status::ok;
  }

  // What is over by now, to either side.
  template <typename Push>
  void run(std::int64_t now_ns, const Push& push) {
    std::array<std::uint8_t, 1024> piece;
    const std::size_t size = line_.read(piece);
    for (std::size_t i = 0; i < size; ++i) in_.push_back({piece[i], line_.baud(), now_ns_});
    now_ns_ = now_ns;
    pass(
        out_, out_free_ns_, [this] { return line_.baud(); },
        [this](std::uint8_t byte) {
          line_.write({&byte, 1});
        });
    pass(
        in_, in_free_ns_, [this] { return static_cast<double>(baud_); }, push);
  }
  int unread() const { return unread_; }  // stop bits that were missing

 private:
  struct Character {
    std::uint8_t byte;
    double baud;  // of its sender
    std::int64_t begun_ns;
  };
  template <typename Rate, typename Push>
  void pass(std::deque<Character>& way, std::int64_t& free_ns, const Rate& rate, const Push& push) {
    for (; !way.empty(); way.pop_front()) {
      const Character& c = way.front();
      const std::int64_t over_ns =
          std::max(free_ns, c.begun_ns) + static_cast<std::int64_t>(10e9 / c.baud);
      if (over_ns > now_ns_) return;
      free_ns = over_ns;
      const auto sample = io::sample_uart({.value = c.byte}, {.baud = c.baud}, 8, rate());
      if (sample.stop_missing) {
        ++unread_;
      } else {
        push(static_cast<std::uint8_t>(sample.bits));
      }
    }
  }

  io::PseudoTerminal& line_;
  std::uint32_t baud_ = 0;
  std::deque<Character> out_, in_;
  std::int64_t now_ns_ = 0, out_free_ns_ = 0, in_free_ns_ = 0;
  int unread_ = 0;
};

struct Rig {
  explicit Rig(const char* type) {
    BoardDescription board;
    board.name = "flying";
    board.devices.push_back({.name = "gps", .type = type, .bus = "usart6"});
    board.devices.back().set("params.first_fix", 2.0);
    link.emplace(LinePartOptions{{"gps", far.path(), 6}, board, rack::device_types()});
    link->keep_time(
        {[](std::int64_t host_ns) { return host_ns; }, [](std::int64_t t_ns) { return t_ns; }});
    EXPECT_TRUE(link->open().ok());
  }
  bool run_until(double seconds, const std::function<bool()>& done) {
    for (const auto end_ns = now_ns + static_cast<std::int64_t>(seconds * 1e9); now_ns < end_ns;) {
      now_ns += kMs;
      EXPECT_TRUE(link->serve(now_ns, arrivals).ok());
      const auto now_us = static_cast<std::uint32_t>(now_ns / 1000);
      wire.run(now_ns, [&](std::uint8_t byte) { driver.push(byte, now_us); });
      if (now_ns % (5 * kMs) == 0) driver.tick(now_us);
      if (done()) return true;
    }
    return false;
  }
  bool has_fix() {
    fw::GpsFix fix;
    return driver.take(fix) && fix.usable();
  }
  void spoil(io::FaultKind kind) {
    io::FaultCommand fault;
    fault.number = 1;
    fault.kind = static_cast<std::uint32_t>(kind);
    fault.start_ns = now_ns;
    fault.end_ns = now_ns + kMs;
    fault.bus = 6;
    io::Batch batch;
    batch.add(io::Kind::fault, 1, now_ns, fault);
    io::Reader order(batch.bytes());
    ASSERT_TRUE(order.next());
    link->take(order, 0);
  }

  std::int64_t now_ns = 0;
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  std::optional<GpsLine> link;
  Copper wire{far};
  fw::UbloxGps<Copper> driver{wire};
  Arrivals arrivals;
};

// It looks at 57600 baud first, where a receiver at 9600 understands nothing.
TEST(GpsDriverOnTheBench, FindsTheReceiversRateSetsItsOwnAndHasAFix) {
  for (const char* type : {"ublox_6", "ublox_m8"}) {
    Rig rig(type);
    ASSERT_TRUE(rig.run_until(10.0, [&] { return rig.has_fix(); })) << type;
    EXPECT_TRUE(rig.driver.running());
    EXPECT_EQ(rig.driver.takes_pvt(), std::string(type) == "ublox_m8");
    EXPECT_EQ(rig.far.baud(), 57600.0);
    EXPECT_EQ(rig.driver.searches(), 1u);  // beside the first, which was in vain
    EXPECT_GT(rig.wire.unread(), 0);
  }
}

TEST(GpsDriverOnTheBench, FindsItAgainWhenItHasLostItsSupply) {
  Rig rig("ublox_6");
  ASSERT_TRUE(rig.run_until(10.0, [&] { return rig.has_fix(); }));
  rig.spoil(io::FaultKind::gnss_brown_out);
  ASSERT_TRUE(rig.run_until(1.0, [&] { return rig.far.baud() == 9600.0; }));
  ASSERT_TRUE(rig.run_until(10.0, [&] { return rig.far.baud() == 57600.0 && rig.has_fix(); }));
  EXPECT_GE(rig.driver.searches(), 2u);
}

}  // namespace
}  // namespace whirl::bench
