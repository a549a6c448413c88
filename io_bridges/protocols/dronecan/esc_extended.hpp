// uavcan.equipment.esc.StatusExtended: its flags are the manufacturer's. Ours are those of the I2C
// protocol's status byte (esc_codec.hpp).
#pragma once
#include "io_bridges/protocols/dronecan/data_type.hpp"
#include "io_bridges/protocols/dronecan/fields.hpp"

namespace whirl::io::dronecan {

struct EscStatusExtended {
  static constexpr DataType kType{Kind::message, 1036, 0x02DC203C50960EDC, 7, "esc.StatusExtended"};
  std::uint8_t input_pct = 0, output_pct = 0;
  std::int16_t motor_temperature_degC = 0;
  std::uint16_t motor_angle_deg = 0;
  std::uint32_t flags = 0;  // 19 bits
  std::uint8_t index = 0;

  template <typename F>
  void layout(F& f) {
    f.u(input_pct, 7);
    f.u(output_pct, 7);
    f.i(motor_temperature_degC, 9);
    f.u(motor_angle_deg, 9);
    f.u(flags, 19);
    f.u(index, 5);
  }
};

}  // namespace whirl::io::dronecan
