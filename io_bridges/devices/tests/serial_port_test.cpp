// At 115200 baud a character of ten bits takes 86.805 us.
#include "io_bridges/devices/serial_port.hpp"

#include <gtest/gtest.h>

#include <string>

namespace whirl::io {
namespace {

struct Desk {
  EventQueue queue;
  std::vector<Finding> findings;
  std::vector<std::pair<Nanoseconds, std::string>> heard;
  SerialPort port{
      queue, "console", {.baud = 115200.0}, [this](const Finding& f) { findings.push_back(f); }};

  Desk() {
    port.on_message([this](std::span<const std::uint8_t> bytes, Nanoseconds t) {
      heard.emplace_back(t, std::string(bytes.begin(), bytes.end()));
    });
  }
  void say(const std::string& text, double baud = 115200.0) {
    for (const char c : text) {
      queue.run_until(queue.now() + 86'805);
      port.receive({static_cast<std::uint8_t>(c), false, false, false}, {baud, 8, 'N', 1.0},
                   queue.now());
    }
  }
};

TEST(SerialPort, HandsOverLinesAndWhatAPauseEnds) {
  Desk desk;
  desk.say("one\ntwo");
  ASSERT_EQ(desk.heard.size(), 1u);
  EXPECT_EQ(desk.heard[0].second, "one\n");
  EXPECT_EQ(desk.heard[0].first, 4 * 86'805);
  desk.queue.run_until(desk.queue.now() + 900'000);
  ASSERT_EQ(desk.heard.size(), 2u);
  EXPECT_EQ(desk.heard[1].second, "two");
  EXPECT_EQ(desk.heard[1].first, 7 * 86'805);
  EXPECT_TRUE(desk.findings.empty());
}

TEST(SerialPort, SendsOneCharacterPerCharacterTime) {
  Desk desk;
  std::vector<Nanoseconds> arrived;
  desk.port.join([&](const UartByte&, const UartFormat&) { arrived.push_back(desk.queue.now()); });
  const std::uint8_t bytes[] = {1, 2, 3};
  desk.port.send_bytes(bytes, 1'000'000);
  desk.queue.run_until(2'000'000);
  EXPECT_EQ(arrived, (std::vector<Nanoseconds>{1'086'805, 1'173'610, 1'260'415}));
}

TEST(SerialPort, TellsAForeignBaudRateOnce) {
  Desk desk;
  desk.say("ab\n", 9600.0);
  EXPECT_EQ(desk.findings.size(), 1u);
}

}  // namespace
}  // namespace whirl::io
