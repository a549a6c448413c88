// Runs a timing image on a target and takes down what it sends.
#pragma once
#include <cstdint>
#include <string>

#include "harness/target/target.hpp"

namespace whirl::timing {

// The text on UART `port` up to the report's last line. What came until then is given back too when the core
// locks up, the target ends, or 60 s of virtual time have passed: the kernels that are missing tell where.
Result<std::string> capture(Target& target, std::uint16_t port);

}  // namespace whirl::timing
