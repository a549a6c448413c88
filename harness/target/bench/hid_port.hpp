// A USB bridge on this host as the bench's I2C.
#pragma once
#include <memory>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/bridge_link.hpp"

namespace whirl::bench {

// Opens nothing yet. Errors of open()  bad_input: no such bridge, no permission (with the udev rule), held by
// another program
Result<std::unique_ptr<I2cPort>> hid_port(const BridgeLink& link);

}  // namespace whirl::bench
