// libsigrok's own parts, with what needs no hardware: files, and its demo device.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "io_bridges/sigrok/capture.hpp"
#include "io_bridges/sigrok/sample_reader.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/lsan_interface.h>
#define WHIRL_LEAKS_OF_OTHERS const __lsan::ScopedDisabler others
#endif
#endif
#ifndef WHIRL_LEAKS_OF_OTHERS
#define WHIRL_LEAKS_OF_OTHERS
#endif

namespace whirl::sigrok {
namespace {

class Kept final : public copper::EdgeSink {
 public:
  void begin(const std::vector<std::string>& names, double rate) override {
    channels = names;
    rate_Hz = rate;
  }
  void on_edge(const copper::Edge& edge) override { edges.push_back(edge); }
  void advance_to(std::int64_t t_ns) override { end_ns = t_ns; }

  std::vector<std::int64_t> times_of(std::uint16_t wire) const {
    std::vector<std::int64_t> times;
    for (const copper::Edge& e : edges) {
      if (e.wire == wire) times.push_back(e.t_ns);
    }
    return times;
  }

  std::vector<std::string> channels;
  double rate_Hz = 0.0;
  std::vector<copper::Edge> edges;
  std::atomic<std::int64_t> end_ns = 0;
};

TEST(SampleReader, OnlyChangesOfWantedWiresAreEdges) {
  Kept kept;
  SampleReader reader({9, 0}, 1e6, kept);
  const std::uint8_t samples[] = {0x00, 0x00, 0x02, 0x00, 0x01, 0x00, 0x01, 0x02, 0x01, 0x02};
  reader.add(samples, 2);
  EXPECT_EQ(kept.times_of(0), (std::vector<std::int64_t>{0, 3000}));  // bit 9, first as it was
  EXPECT_EQ(kept.times_of(1), (std::vector<std::int64_t>{0, 2000}));
  EXPECT_EQ(kept.end_ns, 5000);
}

constexpr const char* kVcd =
    "$timescale 1 ns $end\n$scope module board $end\n$var wire 1 ! i2c3_scl $end\n$var wire 1 \" "
    "i2c3_sda $end\n"
    "$upscope $end\n$enddefinitions "
    "$end\n#0\n$dumpvars\n1!\n1\"\n$end\n#1000\n0\"\n#2000\n0!\n#2500\n1\"\n#3000\n1!\n"
    "#9000\n";

TEST(Capture, AVcdKeepsItsNamesAndTimesToTheRateThatIsAskedFor) {
  const ScratchFolder folder;
  const std::string path = folder.file("x.vcd");
  ASSERT_TRUE(write_text(path, kVcd));
  for (const double rate : {1e9, 10e6}) {
    Kept kept;
    const auto read = read_capture(path, rate, {}, kept);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(kept.channels, (std::vector<std::string>{"i2c3_scl", "i2c3_sda"}));
    EXPECT_EQ(kept.rate_Hz, rate);
    EXPECT_EQ(kept.times_of(0), (std::vector<std::int64_t>{0, 2000, 3000}));
    EXPECT_EQ(kept.times_of(1), (std::vector<std::int64_t>{0, 1000, 2500}));
  }
}

TEST(Capture, SigroksOwnSessionGivesTheSameEdges) {
  const ScratchFolder folder;
  const std::string vcd = folder.file("x.vcd"), session = folder.file("x.sr");
  ASSERT_TRUE(write_text(vcd, kVcd));
  const std::string convert = "sigrok-cli -I vcd:downsample=100 -i " + vcd + " -o " + session;
  ASSERT_EQ(std::system(convert.c_str()), 0) << convert;
  Kept kept;
  WHIRL_LEAKS_OF_OTHERS;  // libsigrok 0.5.2 keeps a session file's virtual device for ever
  const auto read = read_capture(session, 1.0, {{"i2c3_scl", "i2c1_scl"}}, kept);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(kept.channels, (std::vector<std::string>{"i2c1_scl", "i2c3_sda"}));
  EXPECT_EQ(kept.times_of(0), (std::vector<std::int64_t>{0, 2000, 3000}));
  EXPECT_EQ(kept.times_of(1), (std::vector<std::int64_t>{0, 1000, 2500}));
}

TEST(Capture, WhatIsNoneIsRefusedInOneLine) {
  const ScratchFolder folder;
  Kept kept;
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>{"empty.vcd", ""},
        {"words.txt", "these are words\n"},
        {"cut.vcd", std::string(kVcd).substr(0, 60)},
        {"no_scale.vcd", "$var wire 1 ! a $end\n$enddefinitions $end\n#0\n1!\n"},
        {"no.sr", "PK\x03\x04 no archive"}}) {
    const std::string path = folder.file(name);
    ASSERT_TRUE(write_text(path, text));
    const auto read = read_capture(path, 1e9, {}, kept);
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().kind, ErrorKind::bad_input) << name;
    EXPECT_EQ(read.error().message().find('\n'), std::string::npos) << read.error().message();
  }
  EXPECT_FALSE(read_capture(folder.file("nothing"), 1e9, {}, kept));
}

DeviceOptions demo() {
  return {
      .driver = "demo", .connection = "", .model = "", .rate_Hz = 1e6, .names = {{"D0", "marker"}}};
}

TEST(Device, TheDemoDeviceSamplesUntilItIsStopped) {
  auto device = Device::open(demo());
  ASSERT_TRUE(device) << device.error().message();
  Kept kept;
  std::optional<Result<Done>> ran;
  std::thread sampling([&] { ran = device.value()->run(kept); });
  for (int i = 0; i < 2000 && kept.end_ns < 50'000'000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  device.value()->stop();
  sampling.join();
  ASSERT_TRUE(*ran) << ran->error().message();
  EXPECT_EQ(kept.channels, std::vector<std::string>{"marker"});
  EXPECT_EQ(kept.rate_Hz, 1e6);
  EXPECT_GT(kept.edges.size(), 10u);  // its pattern spells "sigrok"
  EXPECT_NE(device.value()->version().find("libsigrok 0."), std::string::npos);
}

TEST(Device, EachThingThatIsMissingIsOneLine) {
  DeviceOptions options = demo();
  options.driver = "of_nobody";
  EXPECT_NE(Device::open(options).error().message().find("no driver 'of_nobody'"),
            std::string::npos);
  options = demo();
  options.model = "Logic Pro";
  EXPECT_NE(Device::open(options).error().message().find("is not 'Logic Pro' but"),
            std::string::npos);
  options = demo();
  options.names = {{"CH17", "marker"}};
  EXPECT_NE(Device::open(options).error().message().find("has no channel 'CH17' (it has D0, D1"),
            std::string::npos);
  options = demo();
  options.driver = "fx2lafw";  // on a machine that has none
  const auto absent = Device::open(options);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().kind, ErrorKind::bad_input);
}

TEST(Device, WhatLibusbSaysBecomesACause) {
  EXPECT_NE(no_device("fx2lafw", "Failed to open device: LIBUSB_ERROR_ACCESS.")
                .message()
                .find("may not be opened"),
            std::string::npos);
  EXPECT_NE(
      no_device("fx2lafw", "Failed to open device: LIBUSB_ERROR_BUSY.").message().find("is busy"),
      std::string::npos);
  EXPECT_NE(no_device("fx2lafw", "").message().find("cannot be opened"), std::string::npos);
}

}  // namespace
}  // namespace whirl::sigrok
