// The types of devices that a board can carry, in the order in which `whirl devices` lists them.
//
//   Adding  one line here, NAME, and NAME.cpp beside it, which defines DeviceType NAME_type()
#pragma once
#include "io_bridges/rack/device_type.hpp"

// A macro because it names a file's function and calls it, and one line is to do both.
#define WHIRL_DEVICE_TYPES(TYPE) \
  TYPE(mpu6000)                  \
  TYPE(ms5611)                   \
  TYPE(hmc5883l)                 \
  TYPE(sd_card)                  \
  TYPE(eeprom_24xx)              \
  TYPE(battery_sense)            \
  TYPE(current_sense)            \
  TYPE(esc_i2c)                  \
  TYPE(esc_dronecan)             \
  TYPE(mpu6000_dronecan)         \
  TYPE(ms5611_dronecan)          \
  TYPE(hmc5883l_dronecan)        \
  TYPE(ublox_m8_dronecan)        \
  TYPE(battery_dronecan)         \
  TYPE(ublox_6)                  \
  TYPE(ublox_m8)                 \
  TYPE(cppm)                     \
  TYPE(sbus)                     \
  TYPE(mavlink_link)             \
  TYPE(serial)                   \
  TYPE(i2c_master)               \
  TYPE(can_port)                 \
  TYPE(pod_replay)               \
  TYPE(pod_host)                 \
  TYPE(pod_parts)                \
  TYPE(power_stage)              \
  TYPE(pulse_source)             \
  TYPE(volts)                    \
  TYPE(jumper)

namespace whirl::rack {

#define WHIRL_DECLARE(name) DeviceType name##_type();
WHIRL_DEVICE_TYPES(WHIRL_DECLARE)
#undef WHIRL_DECLARE

const DeviceTypes& device_types();

}  // namespace whirl::rack
