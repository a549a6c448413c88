// An I2C as master at 400 kHz: a queue of short transactions, driven by interrupts from start to end.
//
//   Buses    i2c3 to the ESCs (PA8, PC9), i2c2 to the sensors on the board (PB10, PB11)
//   Writes   by TXE and BTF; reads by DMA with LAST, so that the NACK comes with the last byte
//   Time     a timer of its own times out a transaction, keeps the gap after a STOP and paces the
//            recovery: TIM7 that of i2c3, TIM6 that of i2c2
//   Errors   NACK: tried again `retries` times. Time-out, bus error or a bus that stays busy: nine
//            clocks by GPIO, STOP, and the block is reset
//   Owner    tasks submit; everything else runs at one interrupt priority and never preempts itself
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "firmware/hal/i2c_job.hpp"
#include "firmware/status.hpp"

namespace fw::hal {

struct I2cCounters {
  std::uint32_t not_acknowledged = 0, timeouts = 0, bus_errors = 0, recoveries = 0;
};

// Bus: which block, pins, DMA stream and timer (i2c_master.cpp).
template <typename Bus>
class I2cMaster {
 public:
  void init();
  Status submit(const I2cJob& job);  // busy: the queue is full
  const I2cCounters& counters() const { return counters_; }

  // From the interrupts.
  void on_event();
  void on_error();
  void on_received();
  void on_timer();

 private:
  enum class State : std::uint8_t { idle, running, gap, recovering };

  void configure();
  void start_next();
  void begin_data();
  void finish(Status status);
  void retry_or_finish(Status status);
  void recover();
  void recovery_step();
  void leave_recovery();

  static constexpr std::size_t kQueue = 8;
  std::array<I2cJob, kQueue> queue_{};
  std::array<std::uint8_t, I2cJob::kMaxLength> received_{};
  std::size_t head_ = 0, count_ = 0;
  std::uint8_t sent_ = 0;
  std::uint8_t step_ = 0;
  State state_ = State::idle;
  I2cCounters counters_;
};

struct EscI2c;
struct SensorI2c;
extern I2cMaster<EscI2c> i2c3;
extern I2cMaster<SensorI2c> i2c2;

}  // namespace fw::hal

namespace fw {
// Supplied by the application; called from interrupts. A read's bytes are in the job.
void esc_job_done(const hal::I2cJob& job, Status status);
void sensor_job_done(const hal::I2cJob& job, Status status);
}  // namespace fw
