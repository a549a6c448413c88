// What an ESC's set-points mean, in the words of plans and vehicles: duty, rpm, thrust_by_rpm, power,
// thrust_by_power. The one table that joins them with the wire's numbers and the control core's.
#pragma once
#include <string_view>

#include "firmware/esc/core/setpoint.hpp"
#include "harness/lua/table.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::catalogue {

struct EscModeWord {
  std::string_view word;
  io::EscMode on_wire;
  fw::esc::Mode in_core;
};

// The mode at `key`. Complaints stay with the table, and the answer is then thrust_by_rpm.
EscModeWord read_esc_mode(const lua::Table& t, std::string_view key);

}  // namespace whirl::catalogue
