// What every part of this folder stands on: its time, and how it says that it is used in an odd way.
//
//   Rule     freestanding C++20: no heap, no exceptions, no floating point, includes only this folder.
//            The virtual board's devices and the pod (firmware/pod) are built on the same parts
//   Outside  a part tells what it does to its pins, and asks for the time of its next event, through
//            an interface of its own; whoever owns it has the clock, the wires and what is sensed
#pragma once
#include <cstddef>
#include <cstdint>

namespace whirl::core {

using Nanoseconds = std::int64_t;
inline constexpr Nanoseconds kNever = INT64_MAX;

// Strange use of a part. `detail`: the register's address, a command, a rate in kHz, a mode.
enum class Oddity : std::uint8_t {
  read_reserved,  // of a register
  write_reserved,
  write_read_only,
  stored_only,
  starting_up_write,  // MPU-6000
  ext_sync_set,
  gyro_self_test,
  accel_self_test,
  fifo_of_slaves,
  pin_functions,
  other_interrupts,
  dmp_or_i2c_master,
  cycle_or_temp_dis,
  dlpf_reserved,
  external_clock,
  fifo_disabled,
  spi_mode,
  sck_over_1_MHz,
  sck_over_20_MHz,
  command_in_reload,  // MS5611
  unknown_command,
  conversion_disturbed,
  adc_read_too_early,
  adc_read_without_result,
  prom_read_in_conversion,
  second_command_byte,
  conf_a_bit_7,  // HMC5883L
  rate_reserved,
  bias_reserved,
  conf_b_low_bits,
  mode_high_bits,
  several_registers,
};
inline constexpr int kOddities = static_cast<int>(Oddity::several_registers) + 1;

// Whoever is told. Nothing is pure here: a freestanding image has no handler for a pure call.
class Witness {
 public:
  virtual void odd(Oddity /*what*/, std::uint32_t /*detail*/, Nanoseconds /*now*/) {}

 protected:
  ~Witness() = default;
};

}  // namespace whirl::core
