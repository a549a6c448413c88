// A USB bridge on this host as the bench's I2C.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "io_bridges/hid/i2c_bridge.hpp"

namespace whirl::bench {

// Opens nothing yet. Errors of open()  bad_input: no such bridge, no permission (with the udev rule), held by
// another program
Result<std::unique_ptr<I2cPort>> hid_port(const BridgeLink& link);

using BridgeOpener = std::function<Result<std::unique_ptr<io::I2cBridge>>(
    io::BridgeKind kind, const std::string& serial, const io::I2cBridgeSettings& settings)>;
// The same by a bridge that is not this host's: a played one.
std::unique_ptr<I2cPort> hid_port_over(const BridgeLink& link, BridgeOpener opener);

}  // namespace whirl::bench
