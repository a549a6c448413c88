// Test image: starts its watchdog and hangs, as a task that never ends would.
#include "firmware/hal/watchdog.hpp"

extern "C" void fw_main() {
  fw::hal::start_watchdog();
  for (;;) {
    __asm volatile("nop");
  }
}
