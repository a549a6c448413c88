// Drivers over fake buses. Expected bytes are the parts' own: datasheet registers and the protocol's
// published CRC, typed in here again.
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "base/near.hpp"
#include "firmware/drivers/esc_bus.hpp"
#include "firmware/drivers/mpu6000.hpp"

namespace fw {
namespace {

using whirl::near, whirl::stated;

// Registers as a map; each transfer ends when finish() is called. Remembers what was too fast.
class FakeSpi {
 public:
  Status start(std::span<const std::uint8_t> out, bool fast) {
    if (running_) return Status::busy;
    running_ = true;
    in_.assign(out.size(), 0xFF);
    std::uint8_t address = out[0] & 0x7F;
    const bool read = (out[0] & 0x80) != 0;
    if (fast && (!read || address < 0x3A || address > 0x48)) ++too_fast;
    for (std::size_t i = 1; i < out.size(); ++i, ++address) {
      if (read) in_[i] = registers[address];
      if (!read) written[address] = registers[address] = out[i];
    }
    if (!read && (out[0] & 0x7F) == 0x6B && out[1] == 0x80) registers[0x6B] = 0x40;  // reset
    return Status::ok;
  }
  std::span<const std::uint8_t> received() const { return in_; }
  bool finish() {
    const bool was = running_;
    running_ = false;
    return was;
  }

  std::map<std::uint8_t, std::uint8_t> registers{{0x75, 0x68}, {0x6B, 0x40}};
  std::map<std::uint8_t, std::uint8_t> written;
  int too_fast = 0;

 private:
  std::vector<std::uint8_t> in_;
  bool running_ = false;
};

int ticks_until_running(Mpu6000<FakeSpi>& imu, FakeSpi& spi, int limit) {
  for (int tick = 0; tick < limit; ++tick) {
    if (imu.running()) return tick;
    std::ignore = imu.setup_tick();
    if (spi.finish()) std::ignore = imu.transfer_done();
  }
  return -1;
}

void sample(Mpu6000<FakeSpi>& imu, FakeSpi& spi) {
  imu.data_ready(0);
  while (spi.finish()) std::ignore = imu.transfer_done();
}

TEST(Mpu6000Driver, ComesUpAndWritesItsSettings) {
  FakeSpi spi;
  Mpu6000<FakeSpi> imu(spi);
  const int ticks = ticks_until_running(imu, spi, 400);
  EXPECT_GT(ticks, 200);                  // two pauses of 100 ms that the part needs after resets
  EXPECT_EQ(spi.written.at(0x1A), 0x01);  // 188 Hz
  EXPECT_EQ(spi.written.at(0x1B), 0x18);  // 2000 deg/s
  EXPECT_EQ(spi.written.at(0x1C), 0x18);  // 16 g
  EXPECT_EQ(spi.written.at(0x38), 0x01);  // data ready
  EXPECT_EQ(spi.too_fast, 0);
}

TEST(Mpu6000Driver, RefusesAnotherPart) {
  FakeSpi spi;
  spi.registers[0x75] = 0x70;
  Mpu6000<FakeSpi> imu(spi);
  EXPECT_EQ(ticks_until_running(imu, spi, 1000), -1);
  EXPECT_EQ(imu.last_error(), Status::wrong_id);
  spi.registers[0x75] = 0x68;  // and finds it when it is there after all
  EXPECT_GT(ticks_until_running(imu, spi, 1000), 0);
}

TEST(Mpu6000Driver, RefusesARegisterThatDoesNotHold) {
  struct Deaf : FakeSpi {
    Status start(std::span<const std::uint8_t> out, bool fast) {
      const Status s = FakeSpi::start(out, fast);
      registers[0x1A] = 0x00;
      return s;
    }
  };
  Deaf spi;
  Mpu6000<Deaf> imu(spi);
  for (int tick = 0; tick < 1000; ++tick) {
    std::ignore = imu.setup_tick();
    if (spi.finish()) std::ignore = imu.transfer_done();
  }
  EXPECT_FALSE(imu.running());
  EXPECT_EQ(imu.last_error(), Status::config_lost);
}

TEST(Mpu6000Driver, ScalesABurst) {
  FakeSpi spi;
  Mpu6000<FakeSpi> imu(spi);
  ASSERT_GT(ticks_until_running(imu, spi, 400), 0);
  spi.registers[0x3B] = 0x08;  // 2048 counts: 1 g at 16 g full scale
  spi.registers[0x3C] = 0x00;
  spi.registers[0x41] = 0xFD;  // -521 counts: 35 degC
  spi.registers[0x42] = 0xF7;
  spi.registers[0x47] = 0xF9;  // -1640 counts: -100 deg/s by the 16.4 of the datasheet
  spi.registers[0x48] = 0x98;
  sample(imu, spi);
  const ImuReading reading = imu.burst().decode();
  EXPECT_TRUE(near(reading.acceleration_mps2[0], 9.80665, stated(1e-5, "float")));
  EXPECT_TRUE(near(reading.temperature_degC, 35.0, stated(0.003, "printed to 1/340")));
  EXPECT_TRUE(near(reading.rate_radps[2], -100.0 * M_PI / 180.0, stated(2e-3, "16.4 is rounded")));
  EXPECT_EQ(spi.too_fast, 0);
}

TEST(Mpu6000Driver, KnowsARateAtItsRailAndLetsAccelerationClip) {
  ImuBurst burst;
  EXPECT_FALSE(burst.rate_saturated());
  burst.bytes[0] = 0x7F;  // acceleration x at its rail: a hard landing, not a broken part
  burst.bytes[1] = 0xFF;
  EXPECT_FALSE(burst.rate_saturated());
  burst.bytes[12] = 0x80;  // rate z, negative rail
  EXPECT_TRUE(burst.rate_saturated());
  burst.bytes[13] = 0x01;  // one count inside
  EXPECT_FALSE(burst.rate_saturated());
  burst.bytes[8] = 0x7F;
  burst.bytes[9] = 0xFF;
  EXPECT_TRUE(burst.rate_saturated());
}

TEST(Mpu6000Driver, NoticesALostSettingInFlightAndRestoresIt) {
  FakeSpi spi;
  Mpu6000<FakeSpi> imu(spi);
  ASSERT_GT(ticks_until_running(imu, spi, 400), 0);
  for (int i = 0; i < 100; ++i) sample(imu, spi);
  EXPECT_EQ(imu.reconfigured(), 0u);
  const std::map<std::uint8_t, std::uint8_t> as_set = spi.registers;
  unsigned lost = 0;
  for (const std::uint8_t address : {0x6B, 0x6A, 0x6C, 0x19, 0x1A, 0x1B, 0x1C, 0x37, 0x38}) {
    spi.registers[address] ^= 0x02;
    for (int i = 0; i < 9; ++i) sample(imu, spi);  // in which all are read again
    EXPECT_EQ(imu.reconfigured(), ++lost) << int{address};
    EXPECT_FALSE(imu.running());
    EXPECT_LT(ticks_until_running(imu, spi, 400), 30);  // no reset: back within 30 ms
    EXPECT_EQ(spi.registers, as_set);
  }
  EXPECT_EQ(spi.too_fast, 0);
}

TEST(Mpu6000Driver, APartThatFallsAsleepIsSetUpAnew) {
  FakeSpi spi;
  Mpu6000<FakeSpi> imu(spi);
  ASSERT_GT(ticks_until_running(imu, spi, 400), 0);
  for (int i = 0; i < 100; ++i) {
    sample(imu, spi);
    EXPECT_EQ(imu.setup_tick(), Status::ok);
  }
  spi.registers[0x6B] = 0x40;  // its supply was away: it sleeps, and tells no sample any more
  for (int i = 0; i < 9; ++i) EXPECT_EQ(imu.setup_tick(), Status::ok);
  EXPECT_EQ(imu.setup_tick(), Status::busy);
  EXPECT_EQ(imu.reconfigured(), 1u);
  EXPECT_LT(ticks_until_running(imu, spi, 400), 30);
  EXPECT_EQ(spi.registers[0x6B], 0x01);
}

class FakeQueue {
 public:
  Status submit(const hal::I2cJob& job) {
    jobs.push_back(job);
    return Status::ok;
  }
  std::vector<hal::I2cJob> jobs;
};

// CRC-8/SMBUS bit by bit from its definition (polynomial division), not by the driver's loop.
std::uint8_t crc8_of(const std::vector<std::uint8_t>& bytes) {
  unsigned remainder = 0;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const unsigned carry = (remainder >> 7 & 1u) ^ (byte >> bit & 1u);
      remainder = (remainder << 1 & 0xFFu) ^ (carry != 0 ? 0x07u : 0u);
    }
  }
  return static_cast<std::uint8_t>(remainder);
}

TEST(EscBus, WritesEachEscItsElevenBits) {
  EXPECT_EQ(crc8_of({'1', '2', '3', '4', '5', '6', '7', '8', '9'}), 0xF4);  // published check value
  FakeQueue queue;
  EscBus<FakeQueue> escs(queue);
  ASSERT_EQ(escs.write({0, 1, 1027, 2047}), Status::ok);
  ASSERT_EQ(queue.jobs.size(), 4u);
  const std::uint8_t hi[4] = {0, 0, 128, 255}, lo[4] = {0, 1, 3, 7};
  for (unsigned i = 0; i < 4; ++i) {
    const hal::I2cJob& job = queue.jobs[i];
    EXPECT_EQ(job.address, 0x29 + i);
    EXPECT_FALSE(job.read);
    EXPECT_EQ(job.length, 3);
    EXPECT_EQ(job.bytes[0], hi[i]);
    EXPECT_EQ(job.bytes[1], lo[i]);
    EXPECT_EQ(job.bytes[2], crc8_of({static_cast<std::uint8_t>(job.address << 1), hi[i], lo[i]}));
  }
}

TEST(EscBus, TakesAStatusOnceAndOnlyWithItsCrc) {
  FakeQueue queue;
  EscBus<FakeQueue> escs(queue);
  ASSERT_EQ(escs.request_status(2), Status::ok);
  hal::I2cJob job = queue.jobs.at(0);
  EXPECT_TRUE(job.read);
  EXPECT_EQ(job.length, 6);
  const std::vector<std::uint8_t> bytes{0xF6, 0xFF, 0x6E, 0x0F, 0x03};  // -10 mA, 3950 RPM
  std::copy(bytes.begin(), bytes.end(), job.bytes.begin());
  job.bytes[5] = crc8_of({0x2B << 1 | 1, 0xF6, 0xFF, 0x6E, 0x0F, 0x03});
  escs.job_done(job, Status::ok);
  esc::protocol::Status status;
  ASSERT_TRUE(escs.take_status(2, status));
  EXPECT_EQ(status.current_mA, -10);
  EXPECT_EQ(status.speed_rpm, 3950);
  EXPECT_EQ(status.flags, 3);
  EXPECT_FALSE(escs.take_status(2, status));
  job.bytes[2] ^= 1;
  escs.job_done(job, Status::ok);
  EXPECT_FALSE(escs.take_status(2, status));
  EXPECT_EQ(escs.bad_status(), 1u);
}

TEST(EscBus, CountsWhatFailedAndDoesNotTakeItForAnAnswer) {
  FakeQueue queue;
  EscBus<FakeQueue> escs(queue);
  ASSERT_EQ(escs.write({5, 5, 5, 5}), Status::ok);
  escs.job_done(queue.jobs[0], Status::ok);
  escs.job_done(queue.jobs[1], Status::no_answer);
  EXPECT_TRUE(escs.take_answered(0));
  EXPECT_FALSE(escs.take_answered(0));
  EXPECT_FALSE(escs.take_answered(1));
  EXPECT_EQ(escs.failures(), 1u);
}

}  // namespace
}  // namespace fw
