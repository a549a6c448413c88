#pragma once
#include "firmware/hal/uart_link.hpp"

namespace fw::hal {
struct HostUart;
}

namespace fw::pod {

inline constexpr std::uint32_t kHostBaud = 3'000'000;
extern hal::UartLink<hal::HostUart> host_uart;

}  // namespace fw::pod
