// A transfer, or a frame on CAN, as a row of bus.csv.
#pragma once
#include <string>

#include "io_bridges/messages/messages.hpp"

namespace whirl::results {

inline constexpr const char* kBus_columns =
    "start_s,stop_s,bus,address,direction,acknowledged,length,bytes\n";

// Empty: it is no transfer on I2C or SPI and no frame.
std::string bus_row(const io::Reader& message);

}  // namespace whirl::results
