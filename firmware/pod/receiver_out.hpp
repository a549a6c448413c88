// A radio-control receiver's outputs, by the positions that the host told last.
//
//   SBUS     USART2 (PA2), 100000 baud 8E2, a frame each 14 ms by the pod's clock; on copper an inverter stands
//            behind the pin
//   CPPM     TIM4 (PB6), positive, up to 16 channels in steps of 0.5 us, made by the timer: no interrupt's
//            time is in an edge
//   Silence  of the host: frames are lost after 60 ms and failsafe after 500 ms, as a receiver says it; CPPM has
//            no flags and stops then. Before the host has said anything nothing goes out, nor when it says so
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "io_bridges/devices/core/receiver.hpp"

namespace fw::pod {

class SbusOut {
 public:
  static constexpr std::size_t kData = 23;       // channels as on the line, flags
  static constexpr std::uint8_t kSilent = 0x80;  // of the flags, from the host only

  void start();
  void set(std::span<const std::uint8_t> data, std::uint32_t now_us);  // Pre: kData
  void poll(std::uint32_t now_us);

 private:
  std::uint8_t flags(std::uint32_t now_us) const;

  std::array<std::uint8_t, kData> data_{};
  bool told_ = false;
  std::uint32_t told_us_ = 0, due_us_ = 0;
};

class CppmOut {
 public:
  static constexpr std::size_t kMost = 16;

  void start();
  // Lengths in steps; none: silent. What no timer makes is brought into its range.
  void set(std::span<const std::uint16_t> steps, std::uint32_t now_us);

  void on_update();  // from TIM4's interrupt

 private:
  void begin_frame();

  std::array<std::uint16_t, kMost> told_{}, sent_{};
  std::size_t told_count_ = 0, count_ = 0, next_ = 0;
  std::uint32_t told_us_ = 0, passed_ = 0;  // steps of this frame
};

extern SbusOut sbus_out;
extern CppmOut cppm_out;

}  // namespace fw::pod
