// Oracles: HMC5883L data sheet pp. 11-16 (registers, access, status), the older HMC5883's pp. 11-14.
#include <gtest/gtest.h>

#include "io_bridges/devices/tests/hmc5883l_bench.hpp"

namespace whirl::io {
namespace {

using Bytes = HmcBench::Bytes;

TEST(Hmc5883lRegisters, ResetValuesAndIdentity) {
  HmcBench bench;
  EXPECT_EQ(bench.read(0x00, 3), (Bytes{0x10, 0x20, 0x01}));
  EXPECT_EQ(bench.read(0x03, 6), Bytes(6, 0));
  EXPECT_EQ(bench.read(0x09, 4), (Bytes{0x00, 'H', '4', '3'}));
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Hmc5883lRegisters, OnlyItsAddressAnswers) {
  HmcBench bench;
  bench.i2c.start(0);
  EXPECT_FALSE(bench.i2c.address(0x1F, false, 0));
  EXPECT_TRUE(bench.write({0x00}));
}

TEST(Hmc5883lRegisters, ThePointerRollsBackToTheDataAfterThem) {
  HmcBench bench;
  bench.power_up();
  const Bytes once = bench.read(0x03, 6);
  EXPECT_NE(once, Bytes(6, 0));
  EXPECT_EQ(bench.read_on(6), once);
  EXPECT_EQ(bench.read_on(6), once);
}

TEST(Hmc5883lRegisters, ThePointerGoesToZeroAfterTheLast) {
  HmcBench bench;
  EXPECT_EQ(bench.read(0x0C, 3), (Bytes{'3', 0x10, 0x20}));
}

TEST(Hmc5883lRegisters, AnInvalidAddressReadsZeroAndIgnoresWrites) {
  HmcBench bench;
  bench.set(0x0D, 0xFF);
  EXPECT_EQ(bench.get(0x0D), 0);
  EXPECT_EQ(bench.read(0x31, 2), (Bytes{0x00, 0x10}));  // the HMC5983's thermometer; then 0x00
  EXPECT_EQ(bench.findings.size(), 3u);
}

TEST(Hmc5883lRegisters, DataStatusAndIdentityAreReadOnly) {
  HmcBench bench;
  for (const int address : {0x03, 0x08, 0x09, 0x0A}) {
    const int before = bench.get(static_cast<std::uint8_t>(address));
    bench.set(static_cast<std::uint8_t>(address), 0x55);
    EXPECT_EQ(bench.get(static_cast<std::uint8_t>(address)), before) << address;
  }
  EXPECT_EQ(bench.findings.size(), 4u);
}

TEST(Hmc5883lRegisters, ReservedBitsAndCodesAreRefused) {
  const struct {
    std::uint8_t address, written, kept;
  } table[] = {{0x00, 0x90, 0x10}, {0x00, 0x7C, 0x70}, {0x00, 0x13, 0x10},
               {0x01, 0xBF, 0xA0}, {0x02, 0x80, 0x00}, {0x02, 0x06, 0x02}};
  for (const auto& row : table) {
    HmcBench bench;
    bench.set(row.address, row.written);
    EXPECT_EQ(bench.get(row.address), row.kept) << int{row.written};
    EXPECT_EQ(bench.findings.size(), 1u) << int{row.written};
  }
}

TEST(Hmc5883lRegisters, AllElseOfTheSettingsIsTakenWithoutAFinding) {
  HmcBench bench;
  for (int averages = 0; averages < 4; ++averages) {
    for (int rate = 0; rate < 7; ++rate) {
      for (int bias = 0; bias < 3; ++bias) {
        const auto value = static_cast<std::uint8_t>(averages << 5 | rate << 2 | bias);
        bench.set(0x00, value);
        EXPECT_EQ(bench.get(0x00), value);
      }
    }
  }
  for (int gain = 0; gain < 8; ++gain) {
    bench.set(0x01, static_cast<std::uint8_t>(gain << 5));
    EXPECT_EQ(bench.get(0x01), gain << 5);
  }
  for (std::uint8_t mode = 0; mode < 4; ++mode) {
    bench.set(0x02, mode);
    EXPECT_EQ(bench.get(0x02), mode);
  }
  EXPECT_TRUE(bench.findings.empty());
}

TEST(Hmc5883lRegisters, SeveralRegistersInOneWriteAreAFinding) {
  HmcBench bench;
  EXPECT_TRUE(bench.write({0x00, 0x70}));
  EXPECT_TRUE(bench.findings.empty());
  EXPECT_TRUE(bench.write({0x00, 0x74, 0xA0, 0x02}));
  EXPECT_EQ(bench.read(0x00, 3), (Bytes{0x74, 0xA0, 0x02}));
  EXPECT_EQ(bench.findings.size(), 1u);
}

// ---- Status

TEST(Hmc5883lStatus, ReadySetsWithTheDataAndIsLowFor250MicrosecondsBefore) {
  HmcBench bench;
  bench.power_up();
  EXPECT_EQ(bench.get(0x09), 0x01);
  bench.set(0x02, 0x01);
  bench.run_us(5749);
  EXPECT_EQ(bench.get(0x09), 0x01);
  bench.run_us(1);
  EXPECT_EQ(bench.get(0x09), 0x00);
  bench.run_us(249);
  EXPECT_EQ(bench.get(0x09), 0x00);
  bench.run_us(1);
  EXPECT_EQ(bench.get(0x09), 0x01);
}

TEST(Hmc5883lStatus, LockedFromTheFirstDataByteToTheSixth) {
  HmcBench bench;
  bench.power_up();
  for (std::uint8_t address = 0x03; address < 0x08; ++address) {
    bench.read(address, 1);
    EXPECT_EQ(bench.get(0x09), 0x03) << int{address};
  }
  bench.read(0x03, 1);  // again: it counts once
  EXPECT_EQ(bench.get(0x09), 0x03);
  bench.read(0x08, 1);
  EXPECT_EQ(bench.get(0x09), 0x01);
}

TEST(Hmc5883lStatus, AMeasurementWhileLockedIsLost) {
  HmcBench bench;
  bench.power_up();
  const auto before = bench.data();
  bench.set(0x00, 0x18);  // 75 Hz
  bench.set(0x02, 0x00);
  bench.run_us(26700);
  EXPECT_EQ(bench.part.samples(), 2u);
  bench.read(0x03, 2);
  bench.field_T = {5e-5, 5e-5, 5e-5};
  bench.edges.clear();
  bench.run_us(14000);
  EXPECT_EQ(bench.part.samples(), 2u);
  EXPECT_TRUE(bench.edges.empty());
  EXPECT_EQ(bench.get(0x09), 0x03);
  EXPECT_EQ(bench.data(), before);  // reads all six: unlocked
  bench.run_us(14000);
  EXPECT_EQ(bench.part.samples(), 3u);
  EXPECT_NE(bench.data(), before);
}

TEST(Hmc5883lStatus, ReadingModeLocksAndWritingModeOrConfAUnlocks) {
  for (const int unlock : {0x00, 0x01, 0x02}) {
    HmcBench bench;
    bench.power_up();
    EXPECT_EQ(bench.get(0x02), 0x03);
    EXPECT_EQ(bench.get(0x09) & 2, 2);
    bench.set(static_cast<std::uint8_t>(unlock), unlock == 0x02 ? 0x02 : 0x60);
    EXPECT_EQ(bench.get(0x09) & 2, unlock == 0x01 ? 2 : 0) << unlock;
  }
}

}  // namespace
}  // namespace whirl::io
