#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "base/output_file.hpp"
#include "base/scratch_folder.hpp"
#include "base/whole_file.hpp"
#include "results/messages/message_file.hpp"
#include "results/sinks/curves.hpp"
#include "results/sinks/replay.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

namespace fs = std::filesystem;

std::string contents(const std::string& path) {
  return read_whole_file(path).value();
}

// A run of two boards, 1 ms per row, whose messages the test chooses.
class Sinks : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  void write(int rows, const io::Batch& batch) {
    MessageWriter out(file("messages.whirl"), head_);
    for (int i = 0; i < rows; ++i) {
      const double row[] = {i == spike_ ? 9.0 : 1.0};
      out.add_row(i * 1'000'000LL, row);
      if (i == 0) out.add(batch);
    }
    ASSERT_TRUE(out.finish());
  }
  Replayed through(const SinkType& type) {
    auto done = replay(file("messages.whirl"), folder_.path(), {type});
    EXPECT_TRUE(done) << done.error().message();
    return done.value();
  }

  RunHead head_{"p", 1, 1'000'000, {{"climb", "mps", "m/s"}}, {{"", {}, {}, {}}}};
  int spike_ = -1;

  ScratchFolder folder_;
};

TEST_F(Sinks, TruthColumnsCarryTheirUnits) {
  head_.columns.push_back({"armed", "", ""});
  MessageWriter out(file("messages.whirl"), head_);
  const double row[] = {-0.5, std::nan("")};
  out.add_row(2'500'000'000, row);
  ASSERT_TRUE(out.finish());
  const Replayed done = through(kTruth_csv);
  EXPECT_EQ(contents(file("truth.csv")), "t_s,climb_mps,armed\n2.5,-0.5,nan\n");
  EXPECT_EQ(done.rows, 1u);
  EXPECT_EQ(done.end_ns, 2'500'000'000);
  EXPECT_TRUE(done.whole);
}

TEST_F(Sinks, ALongRunKeepsEveryThirdRowInItsTruth) {
  spike_ = 449'997;  // a multiple of three
  write(450'001, {});
  through(kTruth_csv);
  const std::string csv = contents(file("truth.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 150'001);
  EXPECT_NE(csv.find("\n449.997,9\n"), std::string::npos);
}

TEST_F(Sinks, TheBusLogHasTimesAndBytes) {
  io::Batch batch;
  const std::uint8_t bytes[] = {0x0F, 0xA0};
  const std::uint32_t times[] = {22'500, 45'000};
  io::add_transaction(io::Kind::i2c_transaction, 3, 2'000'001, {1'000'001, 0x29, 0, 0, 5}, bytes,
                      times, batch);
  io::add_transaction(io::Kind::spi_transaction, 1, 3'000'000, {2'000'000, 0, 0, 1, 1},
                      std::span(bytes).first(1), {}, batch);
  write(1, batch);
  through(kBus_csv);
  EXPECT_EQ(contents(file("bus.csv")),
            "start_s,stop_s,bus,address,direction,acknowledged,length,bytes\n"
            "0.001000001,0.002000001,i2c3,0x29,write,0,5,0FA0\n"
            "0.002000000,0.003000000,spi1,0x00,both,1,1,0F\n");
}

io::Batch sent(std::initializer_list<std::string> chunks, std::uint8_t board = 0) {
  io::Batch batch;
  for (const std::string& chunk : chunks) {
    const io::Header header{5000, io::Kind::uart_received, board, 2,
                            static_cast<std::uint32_t>(chunk.size())};
    batch.add(header, {reinterpret_cast<const std::uint8_t*>(chunk.data()), chunk.size()});
  }
  return batch;
}

TEST_F(Sinks, TelemetryIsNamedByWhatItHolds) {
  const std::string us{0, 0, 0, 0, 0, 0, 0, 5};
  write(1, sent({"\xFD"
                 "frame",
                 "",
                 "\xFE"
                 "old"}));
  through(kTelemetry);
  EXPECT_EQ(contents(file("telemetry.tlog")), us +
                                                  "\xFD"
                                                  "frame" +
                                                  us +
                                                  "\xFE"
                                                  "old");
  EXPECT_FALSE(fs::exists(file("serial.txt")));
  fs::remove(file("telemetry.tlog"));
  write(1, sent({"\xFD"
                 "ready\r\n",
                 "ok"}));
  through(kTelemetry);
  EXPECT_EQ(contents(file("serial.txt")),
            "\xFD"
            "ready\r\nok");
  EXPECT_FALSE(fs::exists(file("telemetry.tlog")));
}

TEST_F(Sinks, EachBoardHasFilesOfItsOwn) {
  head_.nodes = {{"left", {}, {}, {}}, {"right", {}, {}, {}}};
  write(1, sent({"hello"}, 1));
  through(kTelemetry);
  EXPECT_EQ(contents(file("telemetry_left.tlog")), "");
  EXPECT_EQ(contents(file("serial_right.txt")), "hello");
}

TEST_F(Sinks, MessagesAreWrittenFieldByField) {
  io::Batch batch;
  batch.add(io::Kind::finding, 0, 1'500'000, "spi1\0a \"b\"", 10);
  batch.add(io::Header{2, static_cast<io::Kind>(200), 0, 7, 1}, std::vector<std::uint8_t>{0xAB});
  batch.add(io::Kind::pin_edge, 1, 3, io::PinEdge{1, {}});
  head_.nodes[0].pins = {"other", "led, red"};
  write(1, batch);
  through(kMessages_csv);
  EXPECT_EQ(contents(file("messages.csv")),
            "t_s,board,to_board,kind,port,of,fields\n"
            "0.001500000,,0,finding,0,,\"text=spi1 a \"\"b\"\"\"\n"
            "0.000000002,,0,unknown,7,,\"bytes=AB\"\n"
            "0.000000003,,0,pin_edge,1,\"led, red\",\"level=1\"\n");
}

// As `whirl export` does over the files of a run: what was there stays until what is new is whole.
TEST_F(Sinks, AFileThatIsLostLeavesTheOneBeforeIt) {
  write(3, sent({"hello"}));
  ASSERT_TRUE(write_text(file("truth.csv"), "of the run"));
  ASSERT_TRUE(write_text(file("telemetry.tlog"), "of somebody"));
  fs::create_directory(file("truth.csv.part"));  // in the way
  const auto done = replay(file("messages.whirl"), folder_.path(), {kTruth_csv, kTelemetry});
  ASSERT_TRUE(done);
  ASSERT_EQ(done.value().lost.size(), 1u);
  EXPECT_EQ(done.value().lost[0].what, "cannot be written: Is a directory");
  EXPECT_EQ(contents(file("truth.csv")), "of the run");
  EXPECT_EQ(contents(file("telemetry.tlog")), "of somebody");
  EXPECT_EQ(contents(file("serial.txt")), "hello");
  EXPECT_FALSE(fs::exists(file("serial.txt.part")));
}

TEST_F(Sinks, ARunOfTwoHundredThousandRowsIsKeptWhole) {
  write(200'000, {});
  through(kTruth_csv);
  const std::string csv = contents(file("truth.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 200'001);
}

TEST_F(Sinks, WhatCannotBeWrittenIsSaidAndTheOthersAreThere) {
  write(3, sent({"hello"}));
  fs::create_directory(file("truth.csv"));  // in the way
  const auto done = replay(file("messages.whirl"), fs::path(file("x")).parent_path().string(),
                           {kTruth_csv, kTelemetry});
  ASSERT_TRUE(done);
  ASSERT_EQ(done.value().lost.size(), 1u);
  EXPECT_EQ(done.value().lost[0].place, file("truth.csv"));
  EXPECT_EQ(contents(file("serial.txt")), "hello");
}

TEST_F(Sinks, ARunThatWasCutOffIsMadeOfWhatIsThere) {
  {
    MessageWriter out(file("messages.whirl"), head_);
    for (int i = 0; i < 250'000; ++i) {
      const double row[] = {std::sin(i * 1234.5)};
      out.add_row(i * 1'000'000LL, row);
    }
  }
  const Replayed done = through(kTruth_csv);
  EXPECT_FALSE(done.whole);
  EXPECT_GT(done.rows, 200'000u);
  const std::string csv = contents(file("truth.csv"));
  EXPECT_EQ(static_cast<std::uint64_t>(std::count(csv.begin(), csv.end(), '\n')),
            1 + (done.rows + 1) / 2);
}

TEST_F(Sinks, CurvesKeepEverySpike) {
  spike_ = 2500;
  write(5000, {});
  Curves curves(head_.columns, head_.step_ns, 5000);
  ASSERT_TRUE(replay(file("messages.whirl"), ".", {}, {&curves}));
  const Curves::Curve& climb = curves.curve(0);
  EXPECT_FALSE(climb.constant);
  EXPECT_EQ(climb.low.size(), 834u);  // of 6 rows each
  EXPECT_EQ(*std::max_element(climb.high.begin(), climb.high.end()), 9.0);
  EXPECT_EQ(*std::max_element(climb.low.begin(), climb.low.end()), 1.0);
}

TEST(SinkTypes, EveryOneSaysWhatItMakes) {
  for (const SinkType& type : sink_types()) {
    EXPECT_FALSE(type.format.empty());
    EXPECT_FALSE(type.makes.empty());
    EXPECT_NE(type.make, nullptr);
  }
}

// ---- A format of somebody else's: this class, and a line where it is used.

class Counts : public Sink {
 public:
  explicit Counts(const SinkSetup& setup) : out_(setup.folder + "/counts.txt") {}
  void on_message(const io::Reader& message) override { ++messages_[message.header().board]; }
  std::vector<Error> finish() override {
    for (const auto& [board, count] : messages_) {
      out_.write(std::to_string(board) + " " + std::to_string(count) + "\n");
    }
    std::vector<Error> lost;
    close(out_, lost);
    return lost;
  }

 private:
  OutputFile out_;
  std::map<int, int> messages_;
};

const SinkType kCounts{"counts", "counts.txt", false, make_sink<Counts>};

TEST_F(Sinks, AToyIsOneFileAndOneLine) {
  head_.nodes = {{"left", {}, {}, {}}, {"right", {}, {}, {}}};
  io::Batch batch = sent({"a", "b"});
  const io::Batch right = sent({"c"}, 1);
  for (io::Reader more(right.bytes()); more.next();) batch.add(more.header(), more.payload());
  write(2, batch);
  through(kCounts);
  EXPECT_EQ(contents(file("counts.txt")), "0 2\n1 1\n");
}

}  // namespace
}  // namespace whirl::results
