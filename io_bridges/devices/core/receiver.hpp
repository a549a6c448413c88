// What a radio-control receiver does at its outputs by its own clock, SBUS and sum signal (CPPM): the same
// for the virtual board's receivers and for those that the pod plays.
//
//   Source  see io_bridges/devices/sbus.hpp, cppm.hpp and radio_link.hpp, and what there is from memory
#pragma once
#include "io_bridges/devices/core/part.hpp"

namespace whirl::core::receiver {

inline constexpr Nanoseconds kLost_after_ns = 60'000'000;  // without news: three frames of 20 ms
inline constexpr Nanoseconds kFailsafe_after_ns = 500'000'000;

inline constexpr Nanoseconds kSbusBoot_ns = 200'000'000, kSbusPeriod_ns = 14'000'000;
inline constexpr std::uint32_t kSbusBaud = 100'000;  // 8E2, inverted
inline constexpr std::size_t kSbusBytes = 25;        // the start, 22 of channels, flags, the end
inline constexpr std::uint8_t kSbusStart = 0x0F, kSbusEnd = 0x00;
inline constexpr std::uint8_t kSbusFrameLost = 0x04, kSbusFailsafe = 0x08;

inline constexpr Nanoseconds kCppmFrame_ns = 22'500'000, kCppmPulse_ns = 300'000;
inline constexpr Nanoseconds kCppmShortestGap_ns = 4'000'000;
inline constexpr Nanoseconds kCppmStep_ns = 500;  // of a channel's length

}  // namespace whirl::core::receiver
