// A part on I2C as a driver talks to it: commands, and questions that are a write of one byte and a read.
// One question at a time; its answer is there when the task comes next.
//
//   Contract  job_done() from the bus's interrupt, of this part's address; the rest from one task
//   Errors    a transaction that failed, or a question that nothing came of, is Outcome::failed
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "firmware/drivers/i2c_queue.hpp"

namespace fw {

template <I2cQueue Bus, std::uint8_t kAddress, std::size_t kLongest>
class I2cDialogue {
 public:
  enum class Outcome : std::uint8_t { nothing, answered, failed };
  using Answer = std::array<std::uint8_t, kLongest>;

  explicit constexpr I2cDialogue(Bus& bus) : bus_(bus) {}

  Status write(std::uint8_t byte) {
    return bus_.submit({.address = kAddress, .read = false, .length = 1, .bytes = {byte}});
  }
  Status write(std::uint8_t first, std::uint8_t second) {
    return bus_.submit({.address = kAddress, .read = false, .length = 2, .bytes = {first, second}});
  }
  // False: the bus is full. A read must not follow a byte that never went out.
  bool ask(std::uint8_t byte, std::uint8_t length) {
    if (write(byte) != Status::ok) return false;
    asked_ = bus_.submit({.address = kAddress, .read = true, .length = length}) == Status::ok;
    return asked_;
  }
  // What came of all since the last call.
  Outcome take() {
    const bool failed = failed_ || (asked_ && !answered_), answered = asked_ && answered_;
    failed_ = false;
    answered_ = false;
    asked_ = false;
    if (failed) return Outcome::failed;
    return answered ? Outcome::answered : Outcome::nothing;
  }
  const Answer& answer() const { return answer_; }

  void job_done(const hal::I2cJob& job, Status status) {
    if (status != Status::ok) {
      failed_ = true;
      return;
    }
    if (!job.read) return;
    std::copy_n(job.bytes.begin(), kLongest, answer_.begin());
    answered_ = true;
  }

 private:
  Bus& bus_;
  bool asked_ = false;
  // Set in the interrupt, read a step later.
  volatile bool answered_ = false, failed_ = false;
  Answer answer_{};
};

}  // namespace fw
