#pragma once
#include <span>

#include "results/sinks/sink.hpp"

namespace whirl::results {

std::span<const SinkType> sink_types();

extern const SinkType kTruth_csv;     // every signal at every step
extern const SinkType kBus_csv;       // every transfer on I2C and SPI with its bytes and times
extern const SinkType kTelemetry;     // what the board sent on its UARTs
extern const SinkType kMessages_csv;  // everything, field by field
extern const SinkType kVcd;           // buses, serial lines and pins as wires

}  // namespace whirl::results
