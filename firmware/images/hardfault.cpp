// Test image: faults on purpose, in a function that the verdict should name.
#include "firmware/hal/registers.hpp"

namespace fw {

// No memory lives there on this part: a precise bus fault, escalated to HardFault.
using NoMemory = hw::Reg32<0xD000'0000>;

__attribute__((noinline)) void fault_on_purpose() {
  NoMemory::write(0xDEAD'BEEF);
}

}  // namespace fw

extern "C" void fw_main() {
  for (int i = 0; i < 100'000; ++i) {
    __asm volatile("nop");
  }
  fw::fault_on_purpose();
}
