// MAVLink on a serial line whose far end, the flight controller's, the test plays on a pseudo-terminal. Its frames are by other
// hands: made with node-mavlink 2.3.0 (mavlink-mappings 1.0.22).
#include "harness/target/bench/mavlink_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "harness/target/bench/mavlink_check.hpp"
#include "io_bridges/devices/uart_sampling.hpp"
#include "io_bridges/serial/pseudo_terminal.hpp"

namespace whirl::bench {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kMs = 1'000'000;

// HEARTBEAT of 1/1, numbers 7, 8 and 10; RADIO_STATUS of a radio, 51/68, number 200.
const Bytes kBeat_7{0xFD, 0x09, 0, 0, 0x07, 1, 1, 0, 0, 0, 3, 0, 0, 0, 2, 0, 1, 3, 3, 0x12, 0x9C};
const Bytes kBeat_8{0xFD, 0x09, 0, 0, 0x08, 1, 1, 0, 0, 0, 3, 0, 0, 0, 2, 0, 1, 3, 3, 0x95, 0x7E};
const Bytes kBeat_10{0xFD, 0x09, 0, 0, 0x0A, 1, 1, 0, 0, 0, 3, 0, 0, 0, 2, 0, 1, 3, 3, 0xA4, 0x6A};
const Bytes kRadio_200{0xFD, 0x09, 0, 0,    0xC8, 0x33, 0x44, 0x6D, 0,    0,   2,
                       0,    1,    0, 0xB4, 0xAA, 0x63, 0x28, 0x29, 0xBC, 0x2A};

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

struct Rig {
  explicit Rig(double pace = 1.0, int baud = 57600) : link({"radio", far->path(), 2, baud}, pace) {
    EXPECT_TRUE(link.open().ok());
    link.keep_time(
        {[](std::int64_t host_ns) { return host_ns; }, [](std::int64_t t_ns) { return t_ns; }});
  }
  Result<Done> serve(std::int64_t now_ns) { return link.serve(now_ns, arrivals); }
  bool send(const Bytes& frame, std::int64_t due_ns, std::uint16_t port = 2) {
    io::Batch batch;
    batch.add(io::Kind::uart_frame, port, 0, frame.data(),
              static_cast<std::uint32_t>(frame.size()));
    io::Reader order(batch.bytes());
    order.next();
    return link.take(order, due_ns);
  }
  // Until nothing is there: what was written in pieces may come in pieces.
  Bytes read() {
    Bytes all, piece(4096);
    while (const std::size_t size = far->read(piece)) {
      all.insert(all.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(size));
    }
    return all;
  }
  std::string found() {
    std::string all;
    for (const std::string& finding : link.findings()) all += finding + "\n";
    return all;
  }

  std::optional<io::PseudoTerminal> far = std::move(io::PseudoTerminal::open().value());
  MavlinkLine link;
  Arrivals arrivals;
};

TEST(MavlinkLine, EachWholeFrameIsAMessageOfTheTimeOfItsLastByte) {
  Rig rig;
  rig.far->write(joined({kBeat_7, kBeat_8, Bytes(kBeat_10.begin(), kBeat_10.begin() + 5)}));
  ASSERT_TRUE(rig.serve(1000).ok());
  ASSERT_EQ(rig.arrivals.size(), 2u);
  EXPECT_EQ(rig.arrivals[0].payload, kBeat_7);
  EXPECT_EQ(rig.arrivals[1].payload, kBeat_8);
  rig.far->write(std::span(kBeat_10).subspan(5));
  ASSERT_TRUE(rig.serve(2000).ok());
  ASSERT_EQ(rig.arrivals.size(), 3u);
  EXPECT_EQ(rig.arrivals[2].payload, kBeat_10);
  EXPECT_EQ(rig.arrivals[2].host_ns, 2000);
  EXPECT_EQ(rig.arrivals[2].kind, io::Kind::uart_received);
  EXPECT_EQ(rig.arrivals[2].port, 2);
}

TEST(MavlinkLine, WhatIsBrokenIsToldOnceAndTheNextFrameIsWhole) {
  Rig rig;
  const Bytes end_of_one(kBeat_7.begin() + 9, kBeat_7.end());
  Bytes spoilt = kBeat_8;
  spoilt[12] ^= 0x10;
  rig.far->write(joined({end_of_one, kBeat_7, spoilt, kBeat_10}));
  ASSERT_TRUE(rig.serve(1000).ok());
  ASSERT_EQ(rig.arrivals.size(), 2u);
  EXPECT_EQ(rig.arrivals[1].payload, kBeat_10);
  EXPECT_EQ(rig.link.counts().outside_B, 21u);  // all of the spoilt one, none of the first's end
  EXPECT_EQ(rig.link.counts().missing, 2u);     // 8 and 9
  EXPECT_EQ(rig.found(),
            "21 bytes outside of MAVLink frames (2 frames came whole)\n"
            "2 frames of the board missing by their numbers (2 frames came whole)\n");
}

TEST(MavlinkLine, ARadioThatSpeaksOfItselfIsNoGapInTheBoardsNumbers) {
  Rig rig;
  rig.far->write(joined({kBeat_7, kRadio_200, kBeat_8}));
  ASSERT_TRUE(rig.serve(1000).ok());
  EXPECT_EQ(rig.arrivals.size(), 3u);
  EXPECT_EQ(rig.found(), "");
}

TEST(MavlinkLine, FramesLeaveInOrderOfTimeAndAreDeliveredWhenTheirLastStopBitIsOver) {
  Rig rig;
  EXPECT_TRUE(rig.send(kBeat_8, 2 * kMs));
  EXPECT_TRUE(rig.send(kBeat_7, 1 * kMs));
  EXPECT_FALSE(rig.send(kBeat_7, 1 * kMs, 3));
  EXPECT_EQ(rig.link.next_due_host_ns(), 1 * kMs);
  ASSERT_TRUE(rig.serve(1 * kMs - 1).ok());
  EXPECT_EQ(rig.read(), Bytes{});
  ASSERT_TRUE(rig.serve(1 * kMs).ok());
  EXPECT_EQ(rig.read(), kBeat_7);
  ASSERT_TRUE(rig.serve(2 * kMs).ok());
  EXPECT_EQ(rig.read(), kBeat_8);
  EXPECT_TRUE(rig.arrivals.empty());
  constexpr std::int64_t kFrame_ns = 3'645'833;  // 21 characters of ten bits each
  EXPECT_EQ(rig.link.next_due_host_ns(), 1 * kMs + kFrame_ns);
  ASSERT_TRUE(rig.serve(20 * kMs).ok());
  ASSERT_EQ(rig.arrivals.size(), 2u);
  EXPECT_EQ(rig.arrivals[0].kind, io::Kind::uart_delivered);
  EXPECT_EQ(rig.arrivals[0].payload, kBeat_7);
  EXPECT_EQ(rig.arrivals[1].host_ns, 1 * kMs + 2 * kFrame_ns);
}

TEST(MavlinkLine, AFrameThatWouldWaitLongerThanARadiosBufferIsDroppedAndTold) {
  for (const double pace : {1.0, 0.5}) {
    Rig rig(pace);
    for (int i = 0; i < 60; ++i) rig.send(kBeat_7, 0);
    ASSERT_TRUE(rig.serve(0).ok());
    // 200 ms carry 1152 bytes, 54.9 frames, at any pace: the 56th is the last that begins in time.
    EXPECT_EQ(rig.read().size(), 55u * 21u) << pace;
    EXPECT_EQ(rig.link.counts().dropped, 5u) << pace;
    EXPECT_NE(rig.found().find("5 frames for the board found the line full"), std::string::npos);
  }
}

TEST(MavlinkLine, OneThatIsMadeSafeSendsNothingMore) {
  Rig rig;
  rig.send(kBeat_7, 0);
  rig.link.make_safe();
  EXPECT_TRUE(rig.send(kBeat_8, 0));
  ASSERT_TRUE(rig.serve(kMs).ok());
  EXPECT_EQ(rig.read(), Bytes{});
}

// What the kernel did not take waits here: a command among it would arm a vehicle behind the emergency.
TEST(MavlinkLine, OneThatIsMadeSafeKeepsBackWhatTheKernelDidNotTake) {
  Rig rig(1.0, 12'000'000);
  constexpr int kFrames = 2500;
  for (int i = 0; i < kFrames; ++i) rig.send(kBeat_7, 0);
  ASSERT_TRUE(rig.serve(0).ok());
  ASSERT_EQ(rig.link.counts().dropped, 0u);
  rig.link.make_safe();
  const std::size_t of_kernel_B = rig.read().size();
  ASSERT_LT(of_kernel_B, kFrames * kBeat_7.size());
  ASSERT_TRUE(rig.serve(kMs).ok());
  EXPECT_EQ(rig.read(), Bytes{});
}

TEST(MavlinkLine, FiveSecondsAfterMoreBytesThanAFrameHasNoFrameIsAWrongRate) {
  Rig rig;
  EXPECT_TRUE(rig.serve(60'000 * kMs).ok());  // the board is powered a minute later
  rig.far->write(Bytes(280, 0x55));
  EXPECT_TRUE(rig.serve(61'000 * kMs).ok());
  rig.far->write(Bytes(1, 0x55));
  EXPECT_TRUE(rig.serve(70'000 * kMs).ok());
  EXPECT_TRUE(rig.serve(74'999 * kMs).ok());
  const auto deaf = rig.serve(75'000 * kMs);
  ASSERT_FALSE(deaf.ok());
  EXPECT_EQ(deaf.error().kind, ErrorKind::bad_input);
  EXPECT_EQ(deaf.error().what, "281 bytes at 57600 baud, and no MAVLink frame among them");
  EXPECT_EQ(deaf.error().place, rig.far->path());
}

TEST(MavlinkLine, ASilentLineEndsNothingAndIsTold) {
  Rig rig;
  rig.far->write(Bytes(280, 0x55));  // may be the end of a frame
  EXPECT_TRUE(rig.serve(1000 * kMs).ok());
  EXPECT_TRUE(rig.serve(60'000 * kMs).ok());
  EXPECT_NE(rig.found().find("no MAVLink frame was heard, 280 bytes at 57600 baud"),
            std::string::npos);
}

// As the line reads, at 57600 baud, what the board sends at its new rate.
Bytes garbled(const Bytes& sent, double baud) {
  Bytes read;
  for (const std::uint8_t byte : sent) {
    const auto sample = io::sample_uart({.value = byte}, {.baud = baud}, 8, 57600.0);
    if (!sample.stop_missing) read.push_back(static_cast<std::uint8_t>(sample.bits));
  }
  return read;
}

TEST(MavlinkLine, ABoardThatChangesItsRateAndChangesBackIsHeardAgainAndToldOf) {
  Rig rig;
  rig.far->write(kBeat_7);
  ASSERT_TRUE(rig.serve(1000 * kMs).ok());
  Bytes at_38400;
  for (int i = 0; i < 160; ++i) {
    const Bytes beat = garbled(kBeat_8, 38400.0);
    at_38400.insert(at_38400.end(), beat.begin(), beat.end());
  }
  ASSERT_GT(at_38400.size(), 280u);
  rig.far->write(at_38400);
  ASSERT_TRUE(rig.serve(2000 * kMs).ok());
  ASSERT_TRUE(rig.serve(11'500 * kMs).ok());  // the plan judges
  EXPECT_EQ(rig.arrivals.size(), 1u);
  EXPECT_NE(rig.found().find("no frame from 1.0 s to the end, and "), std::string::npos)
      << rig.found();
  // What has looked like the begin of a frame takes from the next ones; its length is spent after 280 bytes.
  for (int i = 0; i < 14; ++i) rig.far->write(kBeat_8);
  ASSERT_TRUE(rig.serve(12'000 * kMs).ok());
  rig.far->write(kBeat_10);
  ASSERT_TRUE(rig.serve(13'000 * kMs).ok());
  ASSERT_GT(rig.arrivals.size(), 2u);
  EXPECT_EQ(rig.arrivals.back().payload, kBeat_10);
  EXPECT_NE(rig.found().find("no frame from 1.0 s to 12.0 s, and "), std::string::npos)
      << rig.found();
  EXPECT_NE(rig.found().find(" bytes: did the board change its rate?"), std::string::npos);
}

TEST(MavlinkLine, OfAFrameWhoseEndIsLostTheNextOneIsNotPartOfTheLoss) {
  Rig rig;
  rig.far->write(joined({kBeat_7, Bytes(kBeat_8.begin(), kBeat_8.begin() + 12), kBeat_10}));
  ASSERT_TRUE(rig.serve(kMs).ok());
  ASSERT_EQ(rig.arrivals.size(), 2u);
  EXPECT_EQ(rig.arrivals[1].payload, kBeat_10);
  EXPECT_EQ(rig.link.counts().outside_B, 12u);
}

TEST(MavlinkLine, NoiseBetweenFramesIsNoStretchWithoutThem) {
  Rig rig;
  for (int i = 0; i < 20; ++i) rig.far->write(joined({kBeat_7, Bytes(30, 0x55)}));
  ASSERT_TRUE(rig.serve(kMs).ok());
  EXPECT_EQ(rig.link.counts().outside_B, 600u);
  EXPECT_EQ(rig.found().find("no frame from"), std::string::npos) << rig.found();
}

// A line that is flooded is read in turns, that others are served too.
TEST(MavlinkLine, OfAFloodATurnReadsEightKibibytes) {
  Rig rig;
  for (int i = 0; i < 3000; ++i) rig.far->write(kBeat_7);
  ASSERT_TRUE(rig.serve(kMs).ok());
  EXPECT_LE(rig.link.counts().bytes, 8u * 1024u);
  EXPECT_GT(rig.link.counts().frames, 100u);
}

TEST(MavlinkLine, OneFrameIsEnoughToGoOn) {
  Rig rig;
  rig.far->write(joined({kBeat_7, Bytes(1000, 0x55)}));
  EXPECT_TRUE(rig.serve(1000 * kMs).ok());
  EXPECT_TRUE(rig.serve(60'000 * kMs).ok());
}

TEST(MavlinkLine, UnpluggedInTheMidstOfAFrameIsSaid) {
  Rig rig;
  rig.far->write(std::span(kBeat_7).first(9));
  ASSERT_TRUE(rig.serve(kMs).ok());
  rig.far.reset();
  const auto served = rig.serve(2 * kMs);
  ASSERT_FALSE(served.ok());
  EXPECT_EQ(served.error().kind, ErrorKind::host);
  EXPECT_EQ(served.error().what, "the serial line was unplugged");
  EXPECT_TRUE(rig.arrivals.empty());
}

TEST(MavlinkLine, WhatCannotBeOpenedIsSaidWithItsPlace) {
  const Rig rig;
  const auto refused = [](const std::string& path) {
    MavlinkLine line({"radio", path, 2, 57600});
    const auto opened = line.open();
    EXPECT_FALSE(opened.ok()) << path;
    if (opened) return std::string();
    EXPECT_EQ(opened.error().kind, ErrorKind::bad_input);
    EXPECT_EQ(opened.error().place, path);
    return opened.error().what;
  };
  EXPECT_EQ(refused("/nowhere/radio"), "no such serial line");
  EXPECT_EQ(refused("/dev/null"), "is no serial line");
}

// With its sum behind it: CRC-16/MCRF4XX, bit by bit.
Bytes summed(Bytes frame, std::uint8_t extra) {
  std::uint16_t crc = 0xFFFF;
  const auto add = [&crc](std::uint8_t byte) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 1) != 0 ? (crc >> 1) ^ 0x8408 : crc >> 1);
    }
  };
  for (std::size_t i = 1; i < frame.size(); ++i) add(frame[i]);
  add(extra);
  frame.push_back(static_cast<std::uint8_t>(crc));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  return frame;
}

// HEARTBEATs of who is on a radio's air as well: a ground station, 255/190 (MAV_TYPE_GCS, no autopilot), and a vehicle, 2/1.
Bytes station_beat(std::uint8_t number) {
  return summed({0xFD, 0x09, 0, 0, number, 0xFF, 0xBE, 0, 0, 0, 0, 0, 0, 0, 6, 8, 0, 4, 3}, 50);
}

Bytes other_beat(std::uint8_t number) {
  return summed({0xFD, 0x09, 0, 0, number, 2, 1, 0, 0, 0, 3, 0, 0, 0, 2, 3, 0, 3, 3}, 50);
}

// A clock on which the far end acts: HEARTBEAT at 0.3 s of each second, each other one 4 ms late, and answers to what is asked.
class FarClock final : public pacing::HostClock {
 public:
  FarClock(io::PseudoTerminal& far, bool beats, std::int64_t answer_ns, std::size_t noise_B)
      : far_(far), beats_(beats), answer_ns_(answer_ns), noise_B_(noise_B) {}
  std::int64_t now_ns() const override { return now_ns_; }
  void sleep_until(std::int64_t t_ns) override { now_ns_ = std::max(now_ns_, t_ns); }
  void wait_for(std::span<pollfd> /*files*/, std::int64_t t_ns) override {
    now_ns_ = std::min(t_ns, now_ns_ + kMs);
    if (beats_ && now_ns_ % (2000 * kMs) == 300 * kMs) beat();
    if (beats_ && now_ns_ % (2000 * kMs) == 1304 * kMs) beat();
    if (beats_ && now_ns_ % (1000 * kMs) == 100 * kMs) far_.write(station_beat(of_others_));
    if (beats_ && now_ns_ % (1000 * kMs) == 700 * kMs) far_.write(other_beat(of_others_++));
    far_.write(Bytes(noise_B_, 0x55));
    Bytes asked(1024);
    asked.resize(far_.read(asked));
    if (asked.size() == 30) {
      question_ = asked;
      asked_ns_ = now_ns_;
    }
    if (!question_.empty() && answer_ns_ >= 0 && now_ns_ - asked_ns_ >= answer_ns_) answer();
  }

 private:
  void beat() {
    Bytes frame(kBeat_7.begin(), kBeat_7.end() - 2);
    frame[4] = number_++;
    far_.write(summed(frame, 50));
  }
  // TIMESYNC of 1/1: its time, and the one that was asked with.
  void answer() {
    Bytes frame{0xFD, 0x12, 0, 0, number_++, 1, 1, 0x6F, 0, 0, 0xF2, 0x05, 0x2A, 0x01, 0, 0, 0, 0};
    for (std::size_t i = 18; i < 26; ++i) frame.push_back(question_.at(i));
    for (const std::uint8_t byte : {0xFF, 0xBE}) frame.push_back(byte);
    far_.write(summed(frame, 34));
    question_.clear();
  }

  io::PseudoTerminal& far_;
  bool beats_;
  std::int64_t answer_ns_, now_ns_ = 124'000 * kMs, asked_ns_ = 0;
  std::size_t noise_B_;
  std::uint8_t number_ = 250, of_others_ = 254;
  Bytes question_;
};

Result<std::vector<std::string>> checked(bool beats, std::int64_t answer_ns,
                                         std::size_t noise_B = 0) {
  io::PseudoTerminal far = std::move(io::PseudoTerminal::open().value());
  FarClock clock(far, beats, answer_ns, noise_B);
  return check_mavlink({.link = {"radio", far.path(), 2, 57600}}, clock);
}

TEST(MavlinkCheck, TellsWhoBeatsHowSteadyAndWhatAnAnswerTakes) {
  const auto told = checked(true, 40 * kMs);
  ASSERT_TRUE(told.ok()) << told.error().message();
  ASSERT_EQ(told.value().size(), 3u);
  EXPECT_EQ(told.value()[0],
            "MAVLink of 1/1 at 57600 baud: 3.0 frames and 63 B a second; 0 missing by their "
            "numbers, 0 B outside of frames");
  EXPECT_EQ(told.value()[1], "HEARTBEAT heard 5 times, period 1004.0 ms, 8.0 ms off it at most");
  // Asked and answered in turns of a millisecond each.
  EXPECT_EQ(told.value()[2],
            "TIMESYNC answered 20 of 20 times; both ways p50 41.0, p99 41.0, most 41.0 ms");
}

TEST(MavlinkCheck, SaysWhatIsWrongInOneLine) {
  EXPECT_EQ(checked(false, -1).error().what, "says nothing in 5 s");
  const std::string deaf = checked(false, -1, 2).error().what;
  EXPECT_NE(deaf.find(" bytes at 57600 baud in 5 s, and no MAVLink frame among them"),
            std::string::npos)
      << deaf;
  const auto mute = checked(true, -1);
  ASSERT_TRUE(mute.ok());
  EXPECT_NE(mute.value()[2].find("answered 0 of 20 times"), std::string::npos);
}

}  // namespace
}  // namespace whirl::bench
