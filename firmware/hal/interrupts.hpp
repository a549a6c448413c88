// Masking, sleeping, and who is more urgent than whom (0 is the most urgent).
#pragma once
#include <cstdint>

namespace fw::hal {

enum Priority : std::uint32_t {
  kPriorityImu = 1,
  kPriorityTick = 2,
  kPriorityI2c = 3,
  kPriorityCan = 3,
  kPriorityUart = 4
};

class InterruptLock {  // for the few words that interrupts and tasks share
 public:
  InterruptLock() { __asm volatile("mrs %0, primask\n cpsid i" : "=r"(was_) : : "memory"); }
  ~InterruptLock() { __asm volatile("msr primask, %0" : : "r"(was_) : "memory"); }
  InterruptLock(const InterruptLock&) = delete;
  InterruptLock& operator=(const InterruptLock&) = delete;

 private:
  std::uint32_t was_;
};

// Keeps out what is as urgent as kPriority or less; what is more urgent still comes through. For
// what tasks share, where a full lock would hold up an interrupt that keeps time. Pre: kPriority > 0.
template <std::uint32_t kPriority>
class PriorityLock {
 public:
  PriorityLock() {
    __asm volatile("mrs %0, basepri" : "=r"(was_) : : "memory");
    __asm volatile("msr basepri_max, %0" : : "r"(kPriority << 4) : "memory");
  }
  ~PriorityLock() { __asm volatile("msr basepri, %0" : : "r"(was_) : "memory"); }
  PriorityLock(const PriorityLock&) = delete;
  PriorityLock& operator=(const PriorityLock&) = delete;

 private:
  std::uint32_t was_;
};

// Sleeps until an interrupt is pending, with interrupts masked: what the caller checked before
// under the same lock cannot have changed. The pending one is served when the lock ends.
inline void wait_for_interrupt() {
  __asm volatile("dsb\n wfi" ::: "memory");
}

}  // namespace fw::hal
