// The bridges through hidapi and the kernel's hidraw, their chips played by uhid; and the kernel's own driver at the
// same chip. Only inside the guest.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io_bridges/devices/esc_i2c.hpp"
#include "io_bridges/hid/emulated/uhid_device.hpp"
#include "io_bridges/hid/hid_device.hpp"
#include "io_bridges/hid/plugged_bridge.hpp"
#include "io_bridges/hid/tests/bridge_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

template <typename Condition>
bool within(milliseconds limit, Condition condition) {
  for (const auto until = std::chrono::steady_clock::now() + limit;
       std::chrono::steady_clock::now() < until;) {
    if (condition()) return true;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return condition();
}

// hid-generic leaves the CP2112 to this driver, loaded or not (HID_QUIRK_HAVE_SPECIAL_DRIVER), which leaves hidraw to us.
constexpr const char* kCp2112_driver = "modprobe hid_cp2112";

// A bench's chip on uhid, served by a thread of its own: what is behind it is read only when the thread has ended.
class Plug {
 public:
  explicit Plug(BridgeBench& bench) : bench_(bench) {}
  ~Plug() { pull(); }
  bool put_in() {
    auto made = UhidDevice::create(bench_.queue, *bench_.chip);
    if (!made) return false;
    device_ = std::move(made.value());
    ends_ = false;
    server_ = std::thread([this] {
      while (!ends_) device_->serve(2'000'000);
    });
    return within(milliseconds(5000), [] { return !list_hid().empty(); });
  }
  void pull() {
    ends_ = true;
    if (server_.joinable()) server_.join();
    device_.reset();
  }

 private:
  BridgeBench& bench_;
  std::unique_ptr<UhidDevice> device_;
  std::atomic<bool> ends_ = false;
  std::thread server_;
};

std::string said_by(const std::string& command, int* status = nullptr) {
  std::string said;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 512> text{};
  while (fgets(text.data(), text.size(), pipe) != nullptr) said += text.data();
  const int ended = pclose(pipe);
  if (status != nullptr) *status = ended;
  return said;
}

void print_latencies(const char* what, std::vector<std::int64_t> ns) {
  std::sort(ns.begin(), ns.end());
  const auto us = [&](double share) {
    return static_cast<double>(
               ns[static_cast<std::size_t>(share * static_cast<double>(ns.size() - 1))]) /
           1e3;
  };
  std::printf(
      "figure: %s: %zu transfers, us: min %.0f, median %.0f, 90 %% %.0f, 99 %% %.0f, 99.9 %% %.0f, "
      "max %.0f\n",
      what, ns.size(), us(0), us(0.5), us(0.9), us(0.99), us(0.999), us(1));
  std::string histogram;
  for (std::size_t i = 0, edge_us = 64; i < ns.size(); edge_us *= 2) {
    const auto end =
        std::upper_bound(ns.begin(), ns.end(), static_cast<std::int64_t>(edge_us) * 1000);
    const auto count = static_cast<std::size_t>(end - ns.begin()) - i;
    if (count > 0) histogram += " <" + std::to_string(edge_us) + ": " + std::to_string(count);
    i += count;
  }
  std::printf("figure: %s: histogram, us:%s\n", what, histogram.c_str());
}

class OnHidraw : public ::testing::TestWithParam<BridgeKind> {
 protected:
  OnHidraw() : bench(GetParam()), plug(bench) {}
  void SetUp() override {
    if (GetParam() == BridgeKind::cp2112) {
      ASSERT_EQ(said_by(kCp2112_driver), "");
    }
    ASSERT_TRUE(within(milliseconds(5000), [] { return list_hid().empty(); }))
        << "an older device is still there";
    ASSERT_TRUE(plug.put_in());
  }
  Result<std::unique_ptr<I2cBridge>> open(const std::string& serial = "A1") {
    return open_i2c_bridge(GetParam(), serial, {});
  }

  BridgeBench bench;
  Plug plug;
};
INSTANTIATE_TEST_SUITE_P(Kinds, OnHidraw,
                         ::testing::Values(BridgeKind::mcp2221a, BridgeKind::cp2112),
                         [](const auto& of) {
                           return of.param == BridgeKind::mcp2221a ? "Mcp2221" : "Cp2112";
                         });

// Together 100 000: set-points by number, each read back in the next status.
TEST_P(OnHidraw, FiftyThousandTransfersAndNoneLost) {
  EscI2c esc(0x29);
  bench.bus.add(esc);
  esc.on_setpoint([&](const EscI2c::Write& write) { esc.set_status({0.0, double(write.v), 0}); });
  auto bridge = open();
  ASSERT_TRUE(bridge.ok()) << bridge.error().message();
  constexpr int kPairs = 25'000;
  std::vector<std::int64_t> latencies;
  for (int i = 0; i < kPairs; ++i) {
    const auto v = static_cast<std::uint16_t>(i * 7 % (kEscMaxSetpoint + 1));
    const I2cTransfer write = bridge.value()->write(0x29, pack_setpoint(0x29, v));
    ASSERT_TRUE(write.ok()) << i << ": " << write.error("write").message();
    const I2cTransfer read = bridge.value()->read(0x29, 6);
    ASSERT_TRUE(read.ok()) << i << ": " << read.error("read").message();
    const auto status = unpack_status(0x29, read.bytes);
    ASSERT_TRUE(status.has_value()) << i;
    ASSERT_EQ(status->speed_rpm, double(v)) << i;
    latencies.push_back(write.end_ns - write.begin_ns);
    latencies.push_back(read.end_ns - read.begin_ns);
  }
  plug.pull();
  EXPECT_EQ(esc.writes(), std::uint64_t{kPairs});
  EXPECT_EQ(esc.rejected(), 0u);
  print_latencies(GetParam() == BridgeKind::mcp2221a ? "MCP2221A" : "CP2112", std::move(latencies));
}

// The ESC's own rates: set-points at 50 Hz, its status at 20 Hz; its watchdog is 0.5 s.
TEST_P(OnHidraw, AnEscIsCommandedAt50HzAndReadAt20Hz) {
  EscI2c esc(0x29);
  bench.bus.add(esc);
  std::int64_t last_ns = -1, longest_ns = 0;
  esc.on_setpoint([&](const EscI2c::Write& write) {
    if (last_ns >= 0) longest_ns = std::max(longest_ns, write.stop_ns - last_ns);
    last_ns = write.stop_ns;
  });
  auto bridge = open();
  ASSERT_TRUE(bridge.ok()) << bridge.error().message();
  const std::int64_t begin_ns = now_ns();
  int writes = 0, reads = 0;
  for (int slot = 0; slot < 300;
       ++slot) {  // of 10 ms: writes in the even ones, reads in each fifth odd one
    while (now_ns() < begin_ns + slot * 10'000'000LL)
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    if (slot % 2 == 0) {
      ASSERT_TRUE(bridge.value()->write(0x29, pack_setpoint(0x29, slot < 60 ? 0 : 500)).ok());
      ++writes;
    }
    if (slot % 5 == 1) {
      const I2cTransfer read = bridge.value()->read(0x29, 6);
      ASSERT_TRUE(read.ok() && unpack_status(0x29, read.bytes).has_value());
      ++reads;
    }
  }
  plug.pull();
  EXPECT_EQ(writes, 150);
  EXPECT_EQ(reads, 60);
  EXPECT_EQ(esc.rejected(), 0u);
  EXPECT_LT(longest_ns, 500'000'000);
  std::printf("figure: ESC at 50 Hz through hidapi: the longest gap between set-points %.1f ms\n",
              double(longest_ns) / 1e6);
}

TEST_P(OnHidraw, UnplugInTheMiddleLosesThatTransferOnlyAndReplugWorks) {
  PluggedBridge bridge([&] { return open(); }, now_ns, 20'000'000);
  int good = 0, cut = 0, again = 0;
  std::thread hand;
  for (int i = 0; i < 100'000 && again < 200; ++i) {
    const I2cTransfer transfer =
        bridge.transfer(0x50, Bytes{0x10, static_cast<std::uint8_t>(i)}, 0);
    if (transfer.ok()) {
      ++(cut == 0 ? good : again);
      if (good == 200 && cut == 0 && !hand.joinable()) hand = std::thread([&] { plug.pull(); });
      continue;
    }
    ASSERT_EQ(transfer.outcome, I2cOutcome::unplugged) << transfer.error("bridge").message();
    ASSERT_EQ(again, 0);
    if (cut++ > 0) continue;
    EXPECT_FALSE(transfer.error("bridge").message().empty());
    hand.join();
    ASSERT_TRUE(plug.put_in());
  }
  if (hand.joinable()) hand.join();
  EXPECT_GE(good, 200);
  EXPECT_GE(cut, 1);
  EXPECT_EQ(again, 200);
  EXPECT_EQ(bridge.times_opened(), 2u);
}

TEST_P(OnHidraw, BusyAnotherSerialNumberAndAnotherKindAreRefusedInOneLine) {
  auto first = open();
  ASSERT_TRUE(first.ok()) << first.error().message();
  const auto says = [](const Result<std::unique_ptr<I2cBridge>>& got, const char* words) {
    return !got && got.error().kind == ErrorKind::bad_input &&
           got.error().message().find(words) != std::string::npos;
  };
  EXPECT_TRUE(says(open(), "is busy: another whirl uses it"));
  EXPECT_TRUE(says(open("B2"), "there are: A1"));
  const bool is_mcp = GetParam() == BridgeKind::mcp2221a;
  EXPECT_TRUE(says(open_i2c_bridge(is_mcp ? BridgeKind::cp2112 : BridgeKind::mcp2221a, "A1", {}),
                   "the device of this serial number is a"));
}

TEST_P(OnHidraw, WithoutPermissionTheUdevRuleIsTold) {
  std::fflush(stdout);  // or the child would say it again
  const pid_t child = fork();
  if (child == 0) {
    if (setgid(65534) != 0 || setuid(65534) != 0) _exit(2);  // nobody
    const auto refused = open();
    const bool right =
        !refused && refused.error().message().find("no permission") != std::string::npos &&
        refused.error().message().find(R"(KERNEL=="hidraw*", KERNELS=="*:)") != std::string::npos;
    if (!refused) std::printf("figure: %s\n", refused.error().message().c_str());
    std::fflush(stdout);
    _exit(right ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(KernelDriver, ReadsWhatOurMasterReadsBehindTheCp2112) {
  BridgeBench bench(BridgeKind::cp2112);
  Plug plug(bench);
  for (std::size_t i = 0; i < 256; ++i)
    bench.registers.content[i] = static_cast<std::uint8_t>(i * 7 + 3);
  EscI2c esc(0x29);
  bench.bus.add(esc);
  int status = -1;
  ASSERT_EQ(said_by(kCp2112_driver, &status), "");
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(plug.put_in());
  ASSERT_TRUE(within(milliseconds(10'000), [] { return access("/dev/i2c-0", R_OK) == 0; }))
      << "hid_cp2112 has not bound";

  const std::string scan = said_by("i2cdetect -y -r 0");
  EXPECT_NE(scan.find(" 29 "), std::string::npos) << scan;
  EXPECT_NE(scan.find("50: 50 -- "), std::string::npos) << scan;
  EXPECT_EQ(said_by("i2cget -y 0 0x50 0x11"), "0x7a\n");
  EXPECT_EQ(said_by("i2cset -y 0 0x50 0x20 0x5a", &status), "");
  const std::string kernels = said_by("i2ctransfer -y 0 w1@0x50 0x1e r4");
  EXPECT_EQ(kernels, "0xd5 0xdc 0x5a 0xea\n");
  said_by("i2cget -y 0 0x51 0x00", &status);
  EXPECT_NE(status, 0);

  auto bridge = open_i2c_bridge(BridgeKind::cp2112, "A1", {});
  ASSERT_TRUE(bridge.ok()) << bridge.error().message();
  EXPECT_EQ(bridge.value()->transfer(0x50, Bytes{0x1e}, 4).bytes, (Bytes{0xd5, 0xdc, 0x5a, 0xea}));
  const auto found = bridge.value()->scan();
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(found.value(), (Bytes{0x29, 0x50}));
}

}  // namespace
}  // namespace whirl::io
