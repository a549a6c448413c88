// Barometer and magnetometer over a fake I2C that answers as their data sheets say. Expected figures are
// the sheets' own.
#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <vector>

#include "base/near.hpp"
#include "firmware/drivers/hmc5883l.hpp"
#include "firmware/drivers/ms5611.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

class FakeI2c {
 public:
  Status submit(const hal::I2cJob& job) {
    if (full) return Status::busy;
    jobs.push_back(job);
    return Status::ok;
  }
  std::deque<hal::I2cJob> jobs;
  bool full = false;
};

// The worked example: C1..C6 of the sheet, with a serial word whose CRC was worked out by hand of AN520.
constexpr std::uint16_t kProm[8] = {0x0000, 40127, 36924, 23317, 23282, 33464, 28312, 0x0000};

struct FakeMs5611 {
  using Sample = BaroSample;
  FakeMs5611() {
    for (unsigned i = 0; i < 8; ++i) prom[i] = kProm[i];
    for (unsigned crc = 0; crc < 16; ++crc) {  // the one of sixteen that is right
      prom[7] = static_cast<std::uint16_t>(crc);
      Ms5611Prom candidate;
      candidate.words = prom;
      if (candidate.valid()) break;
    }
  }
  std::array<std::uint16_t, 8> prom{};
  std::uint32_t d1 = 9085466, d2 = 8569150, adc = 0;
  std::uint8_t last = 0;
  bool silent = false;
  int resets = 0;

  void serve(Ms5611<FakeI2c>& driver, FakeI2c& bus) {
    for (; !bus.jobs.empty(); bus.jobs.pop_front()) {
      hal::I2cJob job = bus.jobs.front();
      if (silent) {
        driver.job_done(job, Status::no_answer);
        continue;
      }
      if (job.read) {
        answer(job);
      } else {
        last = job.bytes[0];
        if (last == 0x1E) ++resets;
        if (last == 0x48) adc = d1;
        if (last == 0x58) adc = d2;
      }
      driver.job_done(job, Status::ok);
    }
  }
  void answer(hal::I2cJob& job) {
    std::uint32_t value = adc;
    if (last == 0x00) adc = 0;  // a second read of the same conversion gives 0
    if (last >= 0xA0) value = std::uint32_t{prom[(last - 0xA0u) / 2u]} << 8;
    for (unsigned i = 0; i < job.length; ++i) {
      job.bytes[i] = static_cast<std::uint8_t>(value >> (16 - 8 * i));
    }
  }
};

// How many samples come in so many steps of 10 ms; the last of them.
template <typename Driver, typename Part, typename Sample>
int samples(Driver& driver, FakeI2c& bus, Part& part, int steps, Sample& last) {
  int got = 0;
  for (int i = 0; i < steps; ++i) {
    driver.step();
    part.serve(driver, bus);
    got += driver.take(last) ? 1 : 0;
  }
  return got;
}
template <typename Driver, typename Part>
int samples(Driver& driver, FakeI2c& bus, Part& part, int steps) {
  typename Part::Sample last;
  return samples(driver, bus, part, steps, last);
}

TEST(Ms5611Prom, CompensatesAsTheSheetDoes) {
  Ms5611Prom prom;
  for (unsigned i = 0; i < 8; ++i) prom.words[i] = kProm[i];
  const auto check = [&](std::uint32_t d2, double pressure, double temperature) {
    const BaroSample got = prom.compensate(9085466, d2);
    EXPECT_TRUE(near(got.pressure_Pa, pressure, stated(1.0, "the sheet rounds down to a pascal")));
    EXPECT_TRUE(near(got.temperature_degC, temperature, stated(0.001, "0.01 degC, in float")));
  };
  check(8569150, 100009, 20.07);
  check(8069150, 96512, 2.05);
  check(7369150, 90613, -27.10);
}

TEST(Ms5611Prom, KnowsItsCrc) {
  Ms5611Prom prom;
  prom.words = {0x3132, 0x3334, 0x3536, 0x3738, 0x3940, 0x4142, 0x4344, 0x450B};  // AN520
  EXPECT_TRUE(prom.valid());
  prom.words[3] ^= 0x0100;
  EXPECT_FALSE(prom.valid());
  EXPECT_FALSE(Ms5611Prom{}.valid());
}

TEST(Ms5611, Gives75PressuresASecond) {
  FakeI2c bus;
  FakeMs5611 part;
  Ms5611<FakeI2c> driver(bus);
  samples(driver, bus, part, 20);
  ASSERT_TRUE(driver.running());
  BaroSample last;
  EXPECT_TRUE(near(samples(driver, bus, part, 1000, last), 742, stated(3, "the phase")));
  EXPECT_TRUE(near(last.pressure_Pa, 100009, stated(1.0, "the sheet rounds down")));
  EXPECT_EQ(driver.failures(), 0u);
}

TEST(Ms5611, StartsOverAfterAnAbsenceAndTakesNoZero) {
  FakeI2c bus;
  FakeMs5611 part;
  Ms5611<FakeI2c> driver(bus);
  samples(driver, bus, part, 100);
  part.silent = true;
  EXPECT_LE(samples(driver, bus, part, 50), 1);
  EXPECT_GT(driver.failures(), 4u);
  part.silent = false;
  const int resets = part.resets;
  samples(driver, bus, part, 30);
  EXPECT_GT(part.resets, resets);
  EXPECT_GT(samples(driver, bus, part, 100), 60);
  part.d1 = 0;
  samples(driver, bus, part, 2);  // what was converted before
  EXPECT_EQ(samples(driver, bus, part, 3), 0);
}

TEST(Ms5611, APressureBeyondItsRangeIsNoSample) {
  FakeI2c bus;
  FakeMs5611 part;
  Ms5611<FakeI2c> driver(bus);
  samples(driver, bus, part, 100);
  for (const std::uint32_t nonsense : {100'000u, 16'777'215u}) {
    part.d1 = nonsense;
    samples(driver, bus, part, 2);  // what was converted before
    EXPECT_EQ(samples(driver, bus, part, 3), 0) << nonsense;
  }
  EXPECT_GT(driver.failures(), 0u);
}

TEST(Ms5611, AnotherPartInItsPlaceIsSeenWithinItsRound) {
  FakeI2c bus;
  FakeMs5611 part;
  Ms5611<FakeI2c> driver(bus);
  samples(driver, bus, part, 100);
  part.prom[4] ^= 1;  // and its CRC is wrong then
  samples(driver, bus, part, 1000);
  EXPECT_GT(driver.restarts(), 0u);
  EXPECT_FALSE(driver.running());
}

TEST(Ms5611, AFullQueueIsNoSample) {
  FakeI2c bus;
  FakeMs5611 part;
  Ms5611<FakeI2c> driver(bus);
  samples(driver, bus, part, 100);
  bus.full = true;
  EXPECT_LE(samples(driver, bus, part, 50), 1);
  bus.full = false;
  EXPECT_GT(samples(driver, bus, part, 100), 60);
}

// ---- Magnetometer

struct FakeHmc5883l {
  using Sample = MagSample;
  std::map<std::uint8_t, std::uint8_t> registers{{0x00, 0x10}, {0x01, 0x20}, {0x02, 0x01},
                                                 {0x0A, 'H'},  {0x0B, '4'},  {0x0C, '3'}};
  std::uint8_t pointer = 0;
  std::array<std::int16_t, 3> xyz{100, -200, 300};
  bool measures = true;
  int noise = 0;

  void serve(Hmc5883l<FakeI2c>& driver, FakeI2c& bus) {
    for (; !bus.jobs.empty(); bus.jobs.pop_front()) {
      hal::I2cJob job = bus.jobs.front();
      if (job.read) {
        for (unsigned i = 0; i < job.length; ++i) job.bytes[i] = registers[pointer++];
      } else {
        pointer = job.bytes[0];
        if (job.length == 2) registers[pointer] = job.bytes[1];
      }
      driver.job_done(job, Status::ok);
    }
    if (measures && registers[0x02] == 0) place();
  }
  void place() {
    noise = 1 - noise;
    const std::int16_t order[3] = {static_cast<std::int16_t>(xyz[0] + noise), xyz[2], xyz[1]};
    for (unsigned i = 0; i < 3; ++i) {
      registers[static_cast<std::uint8_t>(3 + 2 * i)] = static_cast<std::uint8_t>(order[i] >> 8);
      registers[static_cast<std::uint8_t>(4 + 2 * i)] = static_cast<std::uint8_t>(order[i]);
    }
  }
};

TEST(Hmc5883l, SetsItUpAndReadsTheFieldInTheOrderOfItsAxes) {
  FakeI2c bus;
  FakeHmc5883l part;
  Hmc5883l<FakeI2c> driver(bus);
  MagSample last;
  EXPECT_GT(samples(driver, bus, part, 100, last), 60);
  EXPECT_EQ(part.registers[0x00], 0x18);  // 75 Hz
  EXPECT_EQ(part.registers[0x01], 0x20);  // 1090 counts per gauss
  EXPECT_EQ(part.registers[0x02], 0x00);
  // 1090 counts are 100 uT.
  EXPECT_TRUE(near(last.field_uT[0], 100.0 / 10.9, stated(0.1, "a count of noise")));
  EXPECT_TRUE(near(last.field_uT[1], -200.0 / 10.9, stated(0.001, "float")));
  EXPECT_TRUE(near(last.field_uT[2], 300.0 / 10.9, stated(0.001, "float")));
}

TEST(Hmc5883l, RestoresSettingsThatABrownOutTook) {
  FakeI2c bus;
  FakeHmc5883l part;
  Hmc5883l<FakeI2c> driver(bus);
  samples(driver, bus, part, 50);
  part.registers[0x00] = 0x10;
  part.registers[0x02] = 0x01;
  samples(driver, bus, part, 20);
  EXPECT_EQ(driver.reconfigured(), 1u);
  EXPECT_EQ(part.registers[0x02], 0x00);
  EXPECT_GT(samples(driver, bus, part, 100), 60);
}

TEST(Hmc5883l, FrozenDataHaveItSetUpAnew) {
  FakeI2c bus;
  FakeHmc5883l part;
  Hmc5883l<FakeI2c> driver(bus);
  samples(driver, bus, part, 50);
  part.measures = false;
  EXPECT_LE(samples(driver, bus, part, 60), 1);
  EXPECT_GT(driver.reconfigured(), 0u);
}

TEST(Hmc5883l, AnOverflowIsNoSample) {
  FakeI2c bus;
  FakeHmc5883l part;
  Hmc5883l<FakeI2c> driver(bus);
  samples(driver, bus, part, 50);
  part.xyz[1] = -4096;
  samples(driver, bus, part, 1);
  EXPECT_LE(samples(driver, bus, part, 50), 1);
}

TEST(Hmc5883l, SomethingElseThatAnswersIsNotIt) {
  FakeI2c bus;
  FakeHmc5883l part;
  part.registers[0x0B] = '5';
  Hmc5883l<FakeI2c> driver(bus);
  EXPECT_EQ(samples(driver, bus, part, 100), 0);
  EXPECT_FALSE(driver.running());
  EXPECT_GT(driver.failures(), 0u);
}

}  // namespace
}  // namespace fw
