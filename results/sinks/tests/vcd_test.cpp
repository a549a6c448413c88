// wires.vcd, read by others: libsigrok with our decoders, and sigrok-cli with its own.
#include <gtest/gtest.h>

#include <cstdio>

#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"
#include "io_bridges/copper/decoding.hpp"
#include "io_bridges/copper/wire_drawing.hpp"
#include "io_bridges/sigrok/capture.hpp"
#include "results/messages/message_file.hpp"
#include "results/sinks/replay.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class Wires : public testing::Test {
 protected:
  Wires() {
    NodeHead& node = head_.nodes.emplace_back();
    node.devices = {"imu", "card", "esc1", "radio", "receiver", "stand"};
    node.buses = {"spi1", "spi1", "i2c3", "usart2", "PA8", "can2"};
    node.pins = {"led"};
    node.bauds_Hz = {{2, 57600.0}};
    node.throttles = {1};
  }

  // START, STOP and the byte times of 400 kHz; `times` since the start.
  void i2c(std::int64_t start, std::int64_t stop, std::uint8_t address, bool read, bool acked,
           std::vector<std::uint8_t> bytes, std::vector<std::uint32_t> times) {
    io::BusTransaction head;
    head.start_ns = start;
    head.address = address;
    head.read = read ? 1 : 0;
    head.acked = acked ? 1 : 0;
    head.length = static_cast<std::uint32_t>(bytes.size());
    io::add_transaction(io::Kind::i2c_transaction, 3, stop, head, bytes, times, batch_);
  }
  void spi(std::int64_t start, std::int64_t stop, std::uint16_t device,
           std::vector<std::uint8_t> pairs, std::vector<std::uint32_t> times) {
    io::BusTransaction head;
    head.start_ns = start;
    head.address = device;
    head.length = static_cast<std::uint32_t>(times.size());
    io::add_transaction(io::Kind::spi_transaction, 1, stop, head, pairs, times, batch_);
  }
  // What a millisecond of a board may bring; told in the order of ends, as a run does.
  void fill() {
    batch_.add(io::Kind::pin_edge, 0, 0, io::PinEdge{0, {}});
    batch_.add(io::Kind::data_ready, 0, 1 * kMs - 20'000, nullptr, 0);
    spi(1 * kMs, 1 * kMs + 14'000, 0, {0xF5, 0x00, 0x00, 0x68, 0xFF, 0x0F}, {3'000, 3'762, 4'524});
    batch_.add(io::Kind::pin_edge, 0, 1 * kMs + 50'000, io::PinEdge{1, {}});
    i2c(1 * kMs, 1 * kMs + 94'000, 0x29, false, true, {0x0F, 0xA0, 0x3C}, {45'000, 67'500, 90'000});
    spi(2 * kMs, 2 * kMs + 60'000, 1, {0x40, 0xFF, 0x95, 0x01}, {20'000, 40'000});
    i2c(2 * kMs, 2 * kMs + 30'000, 0x2A, true, false, {}, {});
    i2c(3 * kMs, 3 * kMs + 50'000, 0x76, false, true, {0x00}, {45'000});
    i2c(3 * kMs + 50'000, 3 * kMs + 120'000, 0x76, true, true, {0x12, 0x34}, {45'000, 67'500});
    const std::uint8_t text[] = {'o', 'k', '\n'};
    batch_.add(io::Kind::uart_received, 2, 4 * kMs, text, 3);
    batch_.add(io::Kind::uart_delivered, 2, 4 * kMs, text, 2);
    batch_.add(io::Kind::pulse_train, 1, 2 * kMs, io::PulseTrain{1'500'000, 4 * kMs, 0, 0});
  }
  // A frame of 1 Mbit/s; its end is that of its last bit.
  void can(std::int64_t start, const io::CanMessage& frame) {
    io::CanRecord record;
    record.start_ns = start;
    record.frame = frame;
    const std::int64_t bits = static_cast<std::int64_t>(copper::can_bits(frame).size()) + 10;
    record.busy_ns = static_cast<std::uint32_t>((bits + 3) * 1000);
    batch_.add(io::Kind::can_transfer, 2, start + bits * 1000, record);
  }
  std::string drawn() {
    fill();
    can(5 * kMs, {.id = 0x123, .flags = 0, .length = 2, .pad = {}, .data = {0x00, 0xFF}});
    can(6 * kMs, {.id = 0x1004060A, .flags = 1, .length = 4, .pad = {}, .data = {0, 0, 0, 0xC0}});
    MessageWriter out(folder_.file("messages.whirl"), head_);
    for (int i = 0; i <= 10; ++i) {
      out.add_row(i * kMs, {});
      if (i == 4) out.add(batch_);
    }
    EXPECT_TRUE(out.finish());
    const auto done = replay(folder_.file("messages.whirl"), folder_.path(), {kVcd});
    EXPECT_TRUE(done && done.value().lost.empty());
    return folder_.file("wires.vcd");
  }
  static std::string sigrok_cli(const std::string& path, const std::string& decoder) {
    const std::string line = "sigrok-cli -I vcd:downsample=10 -i " + path + " " + decoder + " 2>&1";
    std::FILE* pipe = popen(line.c_str(), "r");
    std::string text;
    char piece[4096];
    for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) text.append(piece, n);
    EXPECT_EQ(pclose(pipe), 0) << line;
    return text;
  }

  RunHead head_{"p", 1, kMs, {}, {}};
  io::Batch batch_;
  ScratchFolder folder_;
};

TEST_F(Wires, OurDecodersReadTheSameMessagesThroughLibsigrok) {
  const std::string path = drawn();
  copper::Decoding decoding({head_.nodes[0].devices, head_.nodes[0].pins, head_.nodes[0].bauds_Hz});
  const auto read = sigrok::read_capture(path, 1e9, {}, decoding);
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_FALSE(decoding.error());
  const io::Batch seen = decoding.in_order();
  io::Reader is(seen.bytes());
  std::string serial;
  int transfers = 0;
  for (io::Reader want(batch_.bytes()); want.next();) {
    const bool transfer = want.header().kind == io::Kind::i2c_transaction ||
                          want.header().kind == io::Kind::spi_transaction;
    if (!transfer) continue;
    do {
      ASSERT_TRUE(is.next());
    } while (is.header().kind != want.header().kind ||
             is.header().t_ns != want.header().t_ns);  // to the nanosecond
    const copper::Transfer a = copper::transfer_of(want), b = copper::transfer_of(is);
    EXPECT_EQ(b.start_ns, a.start_ns);
    EXPECT_EQ(b.address, a.address);
    EXPECT_EQ(b.read, a.read);
    EXPECT_EQ(b.acked, a.acked);
    EXPECT_EQ(b.bytes, a.bytes);
    ++transfers;
    is = io::Reader(seen.bytes());
  }
  EXPECT_EQ(transfers, 6);
  for (io::Reader r(seen.bytes()); r.next();) {
    EXPECT_NE(r.header().kind, io::Kind::bus_unread);
    if (r.header().kind == io::Kind::uart_received) serial += static_cast<char>(r.payload()[0]);
  }
  EXPECT_EQ(serial, "ok\n");
}

TEST_F(Wires, SigroksOwnDecodersReadTheSameBytes) {
  const std::string path = drawn();
  EXPECT_EQ(
      sigrok_cli(path,
                 "-P i2c:scl=i2c3_scl:sda=i2c3_sda -A "
                 "i2c=address-read:address-write:data-read:data-write:nack:stop:repeat-start"),
      "i2c-1: Write\ni2c-1: Address write: 29\ni2c-1: Data write: 0F\ni2c-1: Data write: A0\n"
      "i2c-1: Data write: 3C\ni2c-1: Stop\n"
      "i2c-1: Read\ni2c-1: Address read: 2A\ni2c-1: NACK\ni2c-1: Stop\n"
      "i2c-1: Write\ni2c-1: Address write: 76\ni2c-1: Data write: 00\n"
      "i2c-1: Start repeat\ni2c-1: Read\ni2c-1: Address read: 76\n"
      "i2c-1: Data read: 12\ni2c-1: Data read: 34\ni2c-1: NACK\ni2c-1: Stop\n");
  EXPECT_EQ(sigrok_cli(path, "-P spi:clk=spi1_sck:mosi=spi1_mosi:cs=spi1_cs_imu -A spi=mosi-data"),
            "spi-1: F5\nspi-1: 00\nspi-1: FF\n");
  EXPECT_EQ(sigrok_cli(path, "-P spi:clk=spi1_sck:miso=spi1_miso:cs=spi1_cs_card -A spi=miso-data"),
            "spi-1: FF\nspi-1: 01\n");
  EXPECT_EQ(sigrok_cli(path, "-P uart:rx=usart2_tx:baudrate=57600:format=hex -A uart=rx-data"),
            "uart-1: 6F\nuart-1: 6B\nuart-1: 0A\n");
  EXPECT_EQ(sigrok_cli(path, "-P uart:rx=usart2_rx:baudrate=57600:format=hex -A uart=rx-data"),
            "uart-1: 6F\nuart-1: 6B\n");
  EXPECT_EQ(
      sigrok_cli(
          path, "-P can:can_rx=can2:nominal_bitrate=1000000 -A can=id:ext-id:full-id:data:warning"),
      "can-1: Identifier: 291 (0x123)\n");
  EXPECT_NE(sigrok_cli(path, "-P pwm:data=pulses_1 -A pwm=duty-cycle").find("37.5"),
            std::string::npos);
}

TEST_F(Wires, TheFileSaysWhatIsDerivedAndKeepsTheOrderOfTime) {
  const std::string text = read_whole_file(drawn()).value();
  EXPECT_NE(text.find("DERIVED: all edges within a byte"), std::string::npos);
  EXPECT_NE(text.find("$timescale 1 ns $end"), std::string::npos);
  EXPECT_NE(text.find("pin_led"), std::string::npos);
  EXPECT_NE(text.find("0 edges came too late"), std::string::npos);
  std::int64_t last = -1;
  for (std::size_t at = text.find("\n#"); at != std::string::npos; at = text.find("\n#", at + 1)) {
    const std::int64_t t = std::stoll(text.substr(at + 2, 20));
    EXPECT_GT(t, last);
    last = t;
  }
}

}  // namespace
}  // namespace whirl::results
