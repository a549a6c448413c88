// A bench as a Lua file: what of this host a physical board hangs on, and when it is made safe.
//
//   return { bench = "esc_stand", board = "esc32v2", pace = 1,
//            late = "200 us", late_share = "1 %",
//            links = { { name = "throttle", bus = "i2c2", bridge = "mcp2221a", serial = "0002137245", rate = "100 kHz" },
//                      { name = "bus", bus = "can1", interface = "can0", rate = "1000000 baud",
//                        allocation = { lowest = 100, highest = 125, node = 11,
//                                       ids = { ["00112233445566778899aabbccddeeff"] = 20 } } },
//                      { name = "terminal", bus = "usart1", path = "/dev/serial/by-id/...", baud = "921600 baud" },
//                      { name = "radio", kind = "mavlink", bus = "usart2", path = "/dev/ttyUSB3", baud = "57600 baud" } },
//            instruments = { { name = "cell", path = "/dev/ttyUSB1", baud = "115200 baud", delay = "4 ms",
//                              readings = { { signal = "thrust", column = 1, scale = "9.80665e-3 N", zero = 0 } } } },
//            analyser = { driver = "fx2lafw", rate = "24 MHz", marker = "/dev/ttyUSB2", clocks = { spi1 = "1 MHz" },
//                         channels = { D0 = "i2c2_scl", D1 = "i2c2_sda", D7 = "marker" } },
//            probe = { interface = "interface/stlink.cfg", target = "target/stm32f1x.cfg", idle = "fw::idle" },
//            signals = { speed = "told_speed" },
//            safety = { phrase = "the propeller is clear", longest = "120 s", heartbeat = "100 ms",
//                       limits = { { signal = "bus_current", low = "-1 A", high = "22 A" } } } }
//   Late     of the host: a step later than `late` counts; more than `late_share` of them, and the run is inconclusive
//   Scale    what one count of a reading is, with its unit: the signal is (number - zero) x scale
//   Allocation  node ids for nodes that have none: by unique id (16 bytes in hex), else of lowest..highest (1..125, all of
//            them); `node` is that of the allocator on a vehicle's bus, where it is none without it
//   Clips    names of wires as io_bridges/copper/channel_name.hpp has them; `clocks` of buses that no link states
//   Errors   bad_input, with file and line
#pragma once
#include <string>

#include "base/result.hpp"
#include "harness/target/bench/bench_description.hpp"

namespace whirl {

Result<bench::BenchDescription> read_bench(const std::string& path);

}  // namespace whirl
