// The command line: one line in, one answer out ("ok", "refused", or what was asked for).
//
//   duty 20 | rpm 3500 | thrust 2.0 | power 12.0 | st 2.0   set-point in its mode (25 zeros arm: `arm`)
//   pwm 1200           set-point as a servo pulse of so many microseconds would give it
//   still              the air is still: what the rotor takes for a calm second is still air's power from now on
//                      (core/still_air.hpp). "still 0.9731", of what the map said, or "refused", after 1 to 5 s;
//                      other lines are answered meanwhile. `save` keeps it, at rest
//   mode 0..5 | status | inflow | stop | arm | watch 0|1 | save | motor 1..4 | identified 0|1
//   set NAME VALUE     calibration, by the names of core/parameters.hpp
//   get NAME           "NAME VALUE", the same bits when set again; also mode, motor, identified,
//                      i2c_rejected (writes), i2c_restarts (of a stuck block)
//   get all            one such line for each
//   stream HZ          binary frames (stream_frame.hpp), up to 1000 a second; 0 stops
#pragma once
#include <cstdint>
#include <string_view>

#include "firmware/esc/core/core.hpp"
#include "firmware/esc/image/settings.hpp"

namespace fw::esc {

// The answer is queued on the serial line. Called without a lock; what the tick shares is changed
// under one that leaves commutation and sampling free.
void execute(std::string_view line, Core& core, Settings& settings);
// What a line has begun and a later tick ends. Called as often as the main loop turns.
void go_on(std::uint32_t ticks, Core& core, Settings& settings);

}  // namespace fw::esc
