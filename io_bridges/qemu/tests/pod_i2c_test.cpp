// The parts that the pod plays on I2C, asked by masters on its three blocks: the data sheets' examples, and
// what the flight image asks its own sensors and ESCs from reset on. The host's frames come on USART1.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/near.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/board_text.hpp"
#include "io_bridges/protocols/dronecan/pod_link.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::board_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::int64_t kMs = 1'000'000;

struct Transaction {  // on a bus: a write, or a read and what it gave
  std::int64_t t_ns = 0;
  int bus = 0;
  std::uint8_t address = 0;
  bool read = false;
  Bytes bytes;
  Bytes older = {};  // what may come in its place
};

struct HostFrame {
  std::int64_t t_ns = 0;
  Bytes bytes;
};

struct I2cRun {
  std::vector<Transaction> seen;        // on buses with targets of ours
  std::vector<std::int64_t> placed_ns;  // data of the magnetometer, device 2 of the flight board
  std::map<std::uint32_t, Bytes> replies;
  std::map<std::uint32_t, std::int64_t> stopped_ns;  // of each
  std::vector<std::uint32_t> nacked;
  std::int64_t longest_stretch_ns = 0;
  std::vector<io::PodSetpoint> setpoints;
  std::string findings, error;
};

void keep(const io::Reader& message, I2cRun& run, io::PodLinkReader& link) {
  const io::Header& head = message.header();
  if (head.kind == io::Kind::finding) {
    run.findings += std::string(message.payload().begin(), message.payload().end()) + "\n";
  }
  if (head.kind == io::Kind::cpu_fault) run.error += "the core faulted\n";
  if (head.kind == io::Kind::uart_received && head.port == 1) {
    for (const std::uint8_t byte : message.payload()) link.add(byte);
  }
  if (head.kind == io::Kind::data_ready && head.port == 2) run.placed_ns.push_back(head.t_ns);
  if (head.kind == io::Kind::i2c_transaction) {
    const auto t = message.as<io::BusTransaction>();
    const auto bytes = message.transferred();
    run.seen.push_back({t.start_ns, head.port, static_cast<std::uint8_t>(t.address), t.read != 0,
                        Bytes(bytes.begin(), bytes.end())});
  }
  if (head.kind == io::Kind::i2c_reply) {
    const auto reply = message.as<io::I2cReplyHead>();
    const auto tail = message.tail_after(sizeof(io::I2cReplyHead));
    run.replies[reply.number] = Bytes(tail.begin(), tail.end());
    run.stopped_ns[reply.number] = head.t_ns;
    if (reply.acked == 0) run.nacked.push_back(reply.number);
    run.longest_stretch_ns = std::max(run.longest_stretch_ns, reply.stretched_ns);
  }
}

// Orders are numbered by their place in `asked`.
I2cRun run_board(const std::string& image, const std::string& hse_Hz, const std::string& devices,
                 const std::vector<Transaction>& asked, std::vector<HostFrame> frames,
                 int milliseconds) {
  VirtualBoardOptions options;
  const auto start =
      read_board_text(R"({"board":"pod","mcu":"stm32f405rg","hse_Hz":)" + hse_Hz + R"(,"image":")" +
                      WHIRL_FIRMWARE + "/" + image + R"(.elf","devices":[)" + devices + "]}");
  EXPECT_TRUE(start) << devices;
  I2cRun run;
  if (!start) return run;
  options.board = start.value();
  VirtualBoard board(options);
  if (const auto started = board.start(); !started) {
    run.error = started.error().message();
    return run;
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const HostFrame& a, const HostFrame& b) { return a.t_ns < b.t_ns; });
  io::PodLinkReader link([](const io::PodStatus&) {});
  link.on_setpoint([&](const io::PodSetpoint& setpoint) { run.setpoints.push_back(setpoint); });
  std::size_t order = 0, frame = 0;
  io::Batch happened;
  for (int k = 1; k <= milliseconds; ++k) {
    io::Batch sensed;
    const std::int64_t now_ns = (k - 1) * kMs;
    for (; frame < frames.size() && frames[frame].t_ns < now_ns + kMs; ++frame) {
      sensed.add(io::Kind::uart_frame, 1, frames[frame].t_ns, frames[frame].bytes.data(),
                 static_cast<std::uint32_t>(frames[frame].bytes.size()));
    }
    for (; order < asked.size() && asked[order].t_ns < now_ns + kMs; ++order) {
      const Transaction& t = asked[order];
      io::I2cOrder head;
      head.address = t.address;
      head.read = static_cast<std::uint16_t>(t.read ? t.bytes.size() : 0);
      head.number = static_cast<std::uint32_t>(order);
      const Bytes none;
      const Bytes& out = t.read ? none : t.bytes;
      sensed.add(io::Kind::i2c_order, static_cast<std::uint16_t>(t.bus), t.t_ns, head, out.data(),
                 static_cast<std::uint32_t>(out.size()));
    }
    board.run(k * kMs, sensed);
    const auto state = board.arrive(happened);
    for (io::Reader r(happened.bytes()); r.next();) keep(r, run, link);
    if (!state) run.error += state.error().message();
    if (!state || state.value() != TargetState::running) break;
  }
  board.stop(happened);
  return run;
}

I2cRun ask_pod(const std::vector<Transaction>& asked, const std::vector<HostFrame>& frames,
               int milliseconds) {
  std::string devices = R"({"name":"host","type":"serial","bus":"usart1","baud":3000000})";
  for (const char* bus : {"i2c1", "i2c2", "i2c3"}) {
    devices +=
        std::string(R"(,{"name":"m)") + bus + R"(","type":"i2c_master","bus":")" + bus + "\"}";
  }
  return run_board("pod", "8000000", devices, asked, frames, milliseconds);
}

// Every write acknowledged, every read what it is to be. Returns how many bytes were compared.
std::size_t expect_alike(const std::vector<Transaction>& asked, const I2cRun& run) {
  EXPECT_EQ(run.error, "");
  EXPECT_EQ(run.findings, "");
  EXPECT_EQ(run.nacked.size(), 0u);
  std::size_t bytes = 0;
  int differ = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto reply = run.replies.find(static_cast<std::uint32_t>(i));
    if (reply == run.replies.end()) {
      ADD_FAILURE() << "no reply to " << i << " of " << asked.size();
      break;
    }
    if (!asked[i].read) continue;
    bytes += asked[i].bytes.size();
    const bool alike = reply->second == asked[i].bytes;
    if (alike || (!asked[i].older.empty() && reply->second == asked[i].older)) continue;
    if (++differ > 5) continue;
    ADD_FAILURE() << "read " << i << " of 0x" << std::hex << int{asked[i].address} << ": "
                  << ::testing::PrintToString(reply->second) << " for "
                  << ::testing::PrintToString(asked[i].bytes);
  }
  EXPECT_EQ(differ, 0);
  return bytes;
}

// MS5611 data sheet, worked example: its PROM, D1 and D2. HMC5883L data sheet: identity, table 2.
TEST(PodI2c, AnswersTheDataSheetsExamples) {
  const std::array<std::uint16_t, 8> prom{0, 40127, 36924, 23317, 23282, 33464, 28312, 0x1234};
  const std::vector<HostFrame> frames{{10 * kMs, io::pack_pod_prom(0, prom)},
                                      {11 * kMs, io::pack_pod_barometer(0, 0, 9085466)},
                                      {11 * kMs, io::pack_pod_barometer(1, 1, 8569150)},
                                      {110 * kMs, io::pack_pod_magnetometer(0, {-258, 2, 515})}};
  std::vector<Transaction> asked{{20 * kMs, 1, 0x76, false, {0x1E}}};
  for (std::uint8_t word = 0; word < 8; ++word) {
    asked.push_back(
        {(25 + word) * kMs, 1, 0x76, false, {static_cast<std::uint8_t>(0xA0 + 2 * word)}});
    const std::uint16_t value = prom[word];
    asked.push_back(
        {(25 + word) * kMs + 200'000,
         1,
         0x76,
         true,
         {static_cast<std::uint8_t>(value >> 8), static_cast<std::uint8_t>(value & 0xFF)}});
  }
  const std::vector<Transaction> rest{
      {40 * kMs, 1, 0x76, false, {0x48}},
      {50 * kMs, 1, 0x76, false, {0x00}},
      {51 * kMs, 1, 0x76, true, {0x8A, 0xA2, 0x1A}},
      {52 * kMs, 1, 0x76, false, {0x58}},
      {62 * kMs, 1, 0x76, false, {0x00}},
      {63 * kMs, 1, 0x76, true, {0x82, 0xC1, 0x3E}},
      {70 * kMs, 1, 0x1E, false, {0x0A}},
      {71 * kMs, 1, 0x1E, true, {'H', '4', '3'}},
      {72 * kMs, 1, 0x1E, false, {0x00, 0x70}},
      {73 * kMs, 1, 0x1E, false, {0x02, 0x00}},
      {74 * kMs, 1, 0x1E, false, {0x00}},
      {75 * kMs, 1, 0x1E, true, {0x70, 0x20}},
      {230 * kMs, 1, 0x1E, false, {0x03}},  // X Z Y, high byte first; the pointer goes back to X
      {231 * kMs, 1, 0x1E, true, {0xFE, 0xFE, 0x02, 0x03, 0x00, 0x02}},
      {232 * kMs, 1, 0x1E, true, {0xFE, 0xFE, 0x02, 0x03, 0x00, 0x02}},
      {233 * kMs, 1, 0x1E, false, {0x09}},
      {234 * kMs, 1, 0x1E, true, {0x01}},
  };
  asked.insert(asked.end(), rest.begin(), rest.end());
  const I2cRun run = ask_pod(asked, frames, 240);
  EXPECT_EQ(expect_alike(asked, run), 16u + 6 + 3 + 2 + 12 + 1);
  std::printf("longest stretch %lld ns\n", static_cast<long long>(run.longest_stretch_ns));
  EXPECT_LT(run.longest_stretch_ns, 22'500);  // of a byte at 400 kHz
}

// Four ESCs on two blocks: set-points in, told to the host; its status out; a wrong CRC is told in it.
TEST(PodI2c, FourEscsTakeSetpointsAndTellTheirStatus) {
  std::vector<HostFrame> frames;
  std::vector<Transaction> asked;
  for (int n = 0; n < 4; ++n) {
    const auto address = static_cast<std::uint8_t>(0x29 + n);
    const int bus = n < 2 ? 2 : 3;
    frames.push_back(
        {10 * kMs, io::pack_pod_esc(static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(n),
                                    static_cast<std::int16_t>(-100 * n),
                                    static_cast<std::uint16_t>(4000 + n), 3)});
    const auto setpoint = io::pack_setpoint(address, static_cast<std::uint16_t>(100 + n));
    asked.push_back({(20 + n) * kMs, bus, address, false, Bytes(setpoint.begin(), setpoint.end())});
    const auto status = io::pack_status(address, {-0.1 * n, 4000.0 + n, 3});
    asked.push_back({(30 + n) * kMs, bus, address, true, Bytes(status.begin(), status.end())});
  }
  Bytes damaged = asked[0].bytes;
  damaged[2] ^= 1;
  asked.push_back({40 * kMs, 2, 0x29, false, damaged});
  const auto rejected = io::pack_status(0x29, {0.0, 4000.0, 3 | io::EscFlag::kWriteRejected});
  asked.push_back({41 * kMs, 2, 0x29, true, Bytes(rejected.begin(), rejected.end())});
  std::stable_sort(asked.begin(), asked.end(),
                   [](const Transaction& a, const Transaction& b) { return a.t_ns < b.t_ns; });
  const I2cRun run = ask_pod(asked, frames, 50);
  expect_alike(asked, run);
  ASSERT_EQ(run.setpoints.size(), 5u);
  for (std::uint8_t n = 0; n < 4; ++n) {
    EXPECT_EQ(run.setpoints[n].esc, n);
    EXPECT_TRUE(run.setpoints[n].valid);
    EXPECT_EQ(run.setpoints[n].value, 100 + n);
  }
  EXPECT_FALSE(run.setpoints[4].valid);
}

// Whoever takes no byte before the next one has come holds SCL behind each of them.
TEST(PodI2c, TakesEachByteThatIsWrittenWhileTheNextOneComes) {
  const std::vector<Transaction> asked{{20 * kMs, 2, 0x29, false, Bytes(2)},
                                       {30 * kMs, 2, 0x29, false, Bytes(14)}};
  const I2cRun run = ask_pod(asked, {}, 40);
  ASSERT_EQ(run.error, "");
  ASSERT_EQ(run.stopped_ns.size(), 2u);
  const std::int64_t longer_ns = run.stopped_ns.at(1) - 10 * kMs - run.stopped_ns.at(0);
  EXPECT_TRUE(near(longer_ns, 12 * 9 * 2'500, stated(500, "ns: the pod's clock against SCL's")));
}

// What the flight image asks from reset on, 2 ms later; the host knows what its parts answered then.
constexpr std::int64_t kBehind_ns = 2 * kMs;

std::vector<Transaction> on_the_pods_blocks(const std::vector<Transaction>& flight) {
  std::vector<Transaction> asked = flight;
  for (Transaction& t : asked) {
    t.t_ns += kBehind_ns;
    t.bus = t.bus == 2 ? 1 : t.address <= 0x2A ? 2 : 3;
  }
  return asked;
}

// A frame of a magnetometer's counts is 40 us on the line; with reading it and the core's own grid.
constexpr std::int64_t kLink_ns = 150'000;

// The last of `times_ns`, put off, before t.
std::int64_t last_before(const std::vector<std::int64_t>& times_ns, std::int64_t t_ns) {
  const auto after = std::lower_bound(times_ns.begin(), times_ns.end(), t_ns - kBehind_ns);
  return after == times_ns.begin() ? 0 : *(after - 1) + kBehind_ns;
}

// A part's answer reaches the pod when it was measured: with the command of the conversion, as the
// magnetometer's data were placed, after the status before it was read.
// What was placed less than the link's delay before a read may come with the next one.
std::vector<HostFrame> frames_for(std::vector<Transaction>& asked,
                                  const std::vector<std::int64_t>& placed_ns) {
  std::vector<HostFrame> frames;
  std::array<std::uint16_t, 8> prom{};
  std::map<std::uint8_t, std::int64_t> told_ns;  // by address: when its last answer had been read
  std::int64_t converts_ns = 0, field_ns = -1;
  std::uint8_t quantity = 0, command = 0;
  Bytes field;
  for (Transaction& t : asked) {
    const auto half = [&](std::size_t at) {
      return static_cast<std::uint16_t>(t.bytes[at] << 8 | t.bytes[at + 1]);
    };
    if (!t.read) {
      command = t.bytes.empty() ? 0 : t.bytes[0];
      const bool convert =
          t.address == 0x76 && (command & 0xF0) >= 0x40 && (command & 0xF0) <= 0x50;
      if (convert) converts_ns = t.t_ns, quantity = (command & 0xF0) == 0x50 ? 1 : 0;
    } else if (t.address == 0x76 && t.bytes.size() == 2) {
      prom[command >> 1 & 7] = half(0);
    } else if (t.address == 0x76 && t.bytes.size() == 3) {
      const std::uint32_t counts = static_cast<std::uint32_t>(half(0)) << 8 | t.bytes[2];
      frames.push_back({converts_ns, io::pack_pod_barometer(0, quantity, counts)});
    } else if (t.address == 0x1E && t.bytes.size() == 6) {
      const auto axis = [&](std::size_t at) { return static_cast<std::int16_t>(half(at)); };
      const std::int64_t measured_ns = last_before(placed_ns, t.t_ns);
      if (t.t_ns - measured_ns < kLink_ns) t.older = field;
      field = t.bytes;
      if (std::exchange(field_ns, measured_ns) == measured_ns) continue;
      frames.push_back({measured_ns, io::pack_pod_magnetometer(0, {axis(0), axis(4), axis(2)})});
    } else if (t.bytes.size() == 6) {
      const auto little = [&](std::size_t at) {
        return static_cast<std::uint16_t>(t.bytes[at] | t.bytes[at + 1] << 8);
      };
      frames.push_back(
          {told_ns[t.address],
           io::pack_pod_esc(0, static_cast<std::uint8_t>(t.address - 0x29),
                            static_cast<std::int16_t>(little(0)), little(2), t.bytes[4])});
      told_ns[t.address] = t.t_ns + kMs;
    }
  }
  frames.push_back({5 * kMs, io::pack_pod_prom(0, prom)});
  for (HostFrame& frame : frames) frame.t_ns = std::max(frame.t_ns, 5 * kMs);
  return frames;
}

TEST(PodI2c, AnswersTheFlightImagesTrafficByteForByte) {
  std::string devices =
      R"({"name":"imu","type":"mpu6000","bus":"spi1","cs":"PB0","int":"PC3"},)"
      R"({"name":"baro","type":"ms5611","bus":"i2c2","address":118},)"
      R"({"name":"mag","type":"hmc5883l","bus":"i2c2","address":30,"drdy":"PB1","axes":["+y","-x","+z"]})";
  for (int n = 1; n <= 4; ++n) {
    const std::string motor = std::to_string(n);
    devices += R"(,{"name":"esc)" + motor + R"(","type":"esc_i2c","bus":"i2c3","address":)" +
               std::to_string(0x28 + n) + R"(,"motor":)" + motor + "}";
  }
  const I2cRun flight = run_board("flight", "24000000", devices, {}, {}, 1000);
  ASSERT_EQ(flight.error, "");
  auto asked = on_the_pods_blocks(flight.seen);
  const auto frames = frames_for(asked, flight.placed_ns);
  const I2cRun run = ask_pod(asked, frames, 1010);
  const auto may_be_older = std::count_if(asked.begin(), asked.end(),
                                          [](const Transaction& t) { return !t.older.empty(); });
  EXPECT_LT(may_be_older, 5);
  EXPECT_GT(expect_alike(asked, run), 500u);
  std::printf("%zu transactions, longest stretch %lld ns\n", asked.size(),
              static_cast<long long>(run.longest_stretch_ns));
  EXPECT_LT(run.longest_stretch_ns, 22'500);  // of a byte at 400 kHz
}

}  // namespace
}  // namespace whirl::board_test
