#include "firmware/images/boot_text.hpp"

#include "firmware/hal/clock.hpp"
#include "firmware/hal/fault_record.hpp"

namespace fw {

const char* boot_text() {
  const hal::ResetCause cause = hal::take_reset_cause();
  if (fw_fault_record.magic == FaultRecord::kMagic) {
    fw_fault_record.magic = ~FaultRecord::kMagic;  // told once; the registers stay
    return "boot after a fault, see fw_fault_record";
  }
  switch (cause) {
    case hal::ResetCause::power:
      return "boot: power";
    case hal::ResetCause::pin:
      return "boot: reset pin";
    case hal::ResetCause::software:
      return "boot: software reset";
    case hal::ResetCause::watchdog:
      return "boot: watchdog";
    case hal::ResetCause::low_power:
      return "boot: low-power reset";
  }
  return "boot";
}

}  // namespace fw
