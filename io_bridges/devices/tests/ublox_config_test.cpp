// What the receiver is told: acknowledges, refusals and their effect. Frames as the drivers of PX4,
// ArduPilot and Betaflight send them.
#include "io_bridges/devices/tests/ublox_bench.hpp"

namespace whirl::io {
namespace {

const Bytes kAck_rate = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x08, 0x16, 0x3F};
const Bytes kAck_msg = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x01, 0x0F, 0x38};
const Bytes kNak_msg = {0xB5, 0x62, 0x05, 0x00, 0x02, 0x00, 0x06, 0x01, 0x0E, 0x33};
const Bytes kRate_200 = {0xB5, 0x62, 0x06, 0x08, 0x06, 0x00, 0xC8,
                         0x00, 0x01, 0x00, 0x00, 0x00, 0xDD, 0x68};
const Bytes kRate_100 = {0xB5, 0x62, 0x06, 0x08, 0x06, 0x00, 0x64,
                         0x00, 0x01, 0x00, 0x00, 0x00, 0x79, 0x10};
const Bytes kPvt_on = {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x07, 0x01, 0x13, 0x51};
const Bytes kSol_on = {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x06, 0x01, 0x12, 0x4F};
const Bytes kPort_38400 = {0xB5, 0x62, 0x06, 0x00, 0x14, 0x00, 0x01, 0x00, 0x00, 0x00,
                           0xD0, 0x08, 0x00, 0x00, 0x00, 0x96, 0x00, 0x00, 0x01, 0x00,
                           0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x8B, 0x54};
const Bytes kAck_port = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x00, 0x0E, 0x37};

struct QuietBench : UbloxBench {
  explicit QuietBench(UbloxModel model = UbloxModel::six) : UbloxBench(model, 2.0) { ubx_only(); }
  Bytes answer(const Bytes& request, double baud = 9600.0) {
    forget();
    send(request, baud);
    run(0.1);
    return bytes;
  }
  Bytes answer(const UbxFrame& frame) { return answer(encode(frame)); }
  bool acked(const UbxFrame& frame) {
    answer(frame);
    EXPECT_EQ(of(5, 0).size() + of(5, 1).size(), 1u);
    return of(5, 1).size() == 1;
  }
};

TEST(UbloxConfig, GoldenAnswers) {
  QuietBench bench;
  EXPECT_EQ(bench.answer(kRate_200), kAck_rate);
  EXPECT_EQ(bench.answer(kSol_on), kAck_msg);
}

TEST(UbloxConfig, ASixRefusesPvtAndAnM8TakesIt) {
  QuietBench six, m8(UbloxModel::m8);
  EXPECT_EQ(six.answer(kPvt_on), kNak_msg);
  Bytes taken = m8.answer(kPvt_on);
  taken.resize(kAck_msg.size());  // then its first message
  EXPECT_EQ(taken, kAck_msg);
  EXPECT_TRUE(six.findings.empty());  // drivers ask so which part it is
}

TEST(UbloxConfig, ASixNavigatesFiveTimesASecondAtMost) {
  QuietBench six, m8(UbloxModel::m8);
  EXPECT_EQ(six.answer(kRate_200), kAck_rate);
  EXPECT_EQ(six.answer(kRate_100)[3], 0x00);  // NAK
  EXPECT_EQ(m8.answer(kRate_100), kAck_rate);
  ASSERT_EQ(six.findings.size(), 1u);
  EXPECT_NE(six.findings[0].find("200 ms"), std::string::npos);
  six.switch_on(0x02);
  six.queue.run_until(3'990'000'000);
  six.forget();
  six.run(2.0);
  EXPECT_EQ(six.of(1, 2).size(), 10u);
  EXPECT_EQ(six.of(1, 2)[1].get<std::uint32_t>(0) - six.of(1, 2)[0].get<std::uint32_t>(0), 200u);
}

TEST(UbloxConfig, TheAcknowledgeOfABaudRateStillComesAtTheOldOne) {
  QuietBench bench;
  EXPECT_EQ(bench.answer(kPort_38400), kAck_port);
  for (const double baud : bench.bauds) EXPECT_EQ(baud, 9600.0);
  EXPECT_EQ(bench.answer(kSol_on, 38400.0), kAck_msg);
  for (const double baud : bench.bauds) EXPECT_EQ(baud, 38400.0);
  EXPECT_TRUE(bench.findings.empty());
}

TEST(UbloxConfig, AtAnotherBaudRateItUnderstandsNothingAndSaysSoOnce) {
  for (const double baud : {4800.0, 19200.0, 38400.0, 57600.0, 115200.0}) {
    QuietBench bench;
    EXPECT_TRUE(bench.answer(kSol_on, baud).empty()) << baud;
    EXPECT_TRUE(bench.answer(kSol_on, baud).empty()) << baud;
    EXPECT_EQ(bench.gps().parser_counts().frames, 1u) << baud;  // the one of ubx_only()
    ASSERT_EQ(bench.findings.size(), 1u) << baud;
    EXPECT_NE(bench.findings[0].find("listens at 9600 8N1"), std::string::npos);
    EXPECT_EQ(bench.answer(kSol_on), kAck_msg) << baud;
  }
}

TEST(UbloxConfig, WithAParityBitItsStopBitsAreAmiss) {
  QuietBench bench;
  bench.send(kSol_on, 9600.0, 'E');
  bench.run(0.1);
  EXPECT_TRUE(bench.frames.empty());
  EXPECT_EQ(bench.findings.size(), 1u);
}

TEST(UbloxConfig, OtherPortsBehindItsOwnAreAcknowledgedAndLeadNowhere) {
  QuietBench bench;
  Bytes two_ports(kPort_38400.begin() + 6, kPort_38400.end() - 2);
  Bytes usb = two_ports;
  usb[0] = 3, usb[8] = 0x00, usb[9] = 0xC2;
  two_ports.insert(two_ports.end(), usb.begin(), usb.end());
  EXPECT_EQ(bench.answer(UbxFrame{0x06, 0x00, two_ports}), kAck_port);
  EXPECT_EQ(bench.gps().baud(), 38400.0);
}

TEST(UbloxConfig, RefusedPortSettingsChangeNothing) {
  QuietBench bench;
  const Bytes good(kPort_38400.begin() + 6, kPort_38400.end() - 2);
  Bytes odd_baud = good, parity = good, short_one = good;
  odd_baud[8] = 0x01;
  parity[5] = 0x00;  // even
  short_one.pop_back();
  for (const Bytes& wrong : {odd_baud, parity, short_one}) {
    EXPECT_FALSE(bench.acked({0x06, 0x00, wrong}));
  }
  EXPECT_EQ(bench.findings.size(), 3u);
  EXPECT_EQ(bench.gps().baud(), 9600.0);
}

TEST(UbloxConfig, AnM8KnowsFasterRatesAndCountsCycles) {
  QuietBench six, m8(UbloxModel::m8);
  Bytes fast(kPort_38400.begin() + 6, kPort_38400.end() - 2);
  fast[8] = 0x00, fast[9] = 0x84, fast[10] = 0x03;  // 230400
  EXPECT_FALSE(six.acked({0x06, 0x00, fast}));
  EXPECT_TRUE(m8.acked({0x06, 0x00, fast}));
  EXPECT_EQ(m8.gps().baud(), 230400.0);
  QuietBench slow_six, slow_m8(UbloxModel::m8);
  for (QuietBench* bench : {&slow_six, &slow_m8}) {
    EXPECT_TRUE(bench->acked({0x06, 0x08, {0xE8, 0x03, 2, 0, 0, 0}}));  // each second measurement
    bench->switch_on(0x02);
    bench->queue.run_until(10'900'000'000);
    bench->forget();
    bench->run(8.0);
  }
  EXPECT_EQ(slow_six.of(1, 2).size(), 8u);  // of a 6 navRate is 1
  EXPECT_EQ(slow_m8.of(1, 2).size(), 4u);
}

TEST(UbloxConfig, PollsTellWhatIsSet) {
  QuietBench bench;
  bench.answer(kRate_200);
  bench.answer(UbxFrame{0x06, 0x08, {}});
  EXPECT_EQ(bench.of(6, 8).at(0).payload, (Bytes{0xC8, 0, 1, 0, 0, 0}));
  EXPECT_EQ(bench.of(5, 1).size(), 1u);
  bench.answer(UbxFrame{0x06, 0x01, {0x01, 0x02, 5}});
  bench.answer(UbxFrame{0x06, 0x01, {0x01, 0x02}});
  EXPECT_EQ(bench.of(6, 1).at(0).payload, (Bytes{1, 2, 0, 5, 0, 0, 0, 0}));
  bench.answer(UbxFrame{0x06, 0x00, {}});
  EXPECT_EQ(bench.of(6, 0).at(0).get<std::uint32_t>(4), 0x8D0u);
  EXPECT_EQ(bench.of(6, 0).at(0).get<std::uint32_t>(8), 9600u);
}

TEST(UbloxConfig, Nav5TakesWhatItsMaskNames) {
  QuietBench bench;
  Bytes nav5(36, 0);
  nav5[0] = 0x05, nav5[2] = 6, nav5[3] = 2,
  nav5[12] = 33;  // airborne, 3D; minElev is not in the mask
  EXPECT_TRUE(bench.acked({0x06, 0x24, nav5}));
  bench.answer(UbxFrame{0x06, 0x24, {}});
  const Bytes stored = bench.of(6, 0x24).at(0).payload;
  ASSERT_EQ(stored.size(), 36u);
  EXPECT_EQ(stored[2], 6);
  EXPECT_EQ(stored[3], 2);
  EXPECT_EQ(stored[12], 5);
  nav5[2] = 1;
  EXPECT_FALSE(bench.acked({0x06, 0x24, nav5}));
}

TEST(UbloxConfig, WhatIsStoredOnlySaysSoAndWhatIsUnknownIsRefused) {
  QuietBench bench;
  EXPECT_TRUE(bench.acked({0x06, 0x01, {0x01, 0x30, 5}}));  // SVINFO
  EXPECT_TRUE(bench.acked({0x06, 0x16, {1, 3, 3, 0, 0, 0, 0, 0}}));
  EXPECT_EQ(bench.findings.size(), 2u);
  EXPECT_FALSE(bench.acked({0x06, 0x8A, {0, 1, 0, 0, 1, 0, 0x52, 0x40}}));  // VALSET
  EXPECT_FALSE(bench.acked({0x06, 0x3E, {0, 0, 0, 0}}));                    // GNSS: not on a 6
  EXPECT_FALSE(bench.acked({0x06, 0x01, {0x77, 0x01, 1}}));
  bench.answer(UbxFrame{0x06, 0x16, {}});
  EXPECT_EQ(bench.of(6, 0x16).at(0).payload, (Bytes{1, 3, 3, 0, 0, 0, 0, 0}));
}

TEST(UbloxConfig, SavedSettingsOutliveARestartAndOthersDoNot) {
  QuietBench bench;
  bench.answer(kRate_200);
  EXPECT_TRUE(bench.acked({0x06, 0x09, {0, 0, 0, 0, 8, 0, 0, 0, 0, 0, 0, 0}}));
  bench.answer(kSol_on);
  EXPECT_TRUE(bench.answer(UbxFrame{0x06, 0x04, {0, 0, 0, 0}}).empty());  // no acknowledge
  bench.run(0.5);
  bench.send(UbxFrame{0x06, 0x08, {}});
  bench.run(1.2);
  EXPECT_EQ(bench.of(6, 8).at(0).get<std::uint16_t>(0), 200);
  EXPECT_TRUE(bench.of(1, 6).empty());
  EXPECT_NE(bench.text.find("$GPRMC"), std::string::npos);  // the port is the default's again
}

TEST(UbloxConfig, ASentenceSetsPortAndProtocols) {
  UbloxBench bench;
  bench.run(0.5);
  const std::string sentence = "$PUBX,41,1,0023,0001,115200,0*1C\r\n";
  bench.send(Bytes(sentence.begin(), sentence.end()));
  bench.run(3.0);
  EXPECT_EQ(bench.gps().baud(), 115200.0);
  EXPECT_TRUE(bench.text.empty());  // no NMEA any more
}

TEST(UbloxConfig, ItHearsNothingBeforeItHasStarted) {
  UbloxBench bench;
  bench.send(kPort_38400, 9600.0);
  bench.run(0.5);
  EXPECT_EQ(bench.gps().baud(), 9600.0);
}

}  // namespace
}  // namespace whirl::io
