// The virtual board or a bench, and the world around it, a flight or a thrust stand, put together.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "harness/cli/composition.hpp"
#include "harness/target/bench/bridge_link.hpp"

namespace whirl {

// Errors  bad_input: there is no such bridge, or this program cannot drive it
using BridgeMaker =
    std::function<Result<std::unique_ptr<bench::I2cPort>>(const bench::BridgeLink&)>;

cli::Composition boards_and_worlds(const std::string& root, const std::string& results,
                                   const BridgeMaker& bridge);

}  // namespace whirl
