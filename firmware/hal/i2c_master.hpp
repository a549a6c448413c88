// I2C3 as master at 400 kHz: a queue of short transactions, driven by interrupts from start to end.
//
//   Writes   by TXE and BTF; reads by DMA with LAST, so that the NACK comes with the last byte
//   Time     TIM7 times out a transaction, keeps the gap after a STOP and paces the recovery
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

extern I2cMaster i2c3;

}  // namespace fw::hal

namespace fw {
// Supplied by the application; called from interrupts. A read's bytes are in the job.
void i2c_job_done(const hal::I2cJob& job, Status status);
}  // namespace fw
