// Whole I2C transfers, carried to a bus that is elsewhere and takes its time: what stands behind a played bridge whose
// bus is not in this process.
//
//   One at a time; outcome() is asked for until it is there
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

namespace whirl::io {

struct CarriedOutcome {
  bool acked = false;  // the address and every byte
  bool timed_out = false;
  std::vector<std::uint8_t> bytes;
};

class I2cCarrier {
 public:
  virtual ~I2cCarrier() = default;
  virtual void begin(std::uint8_t address, std::vector<std::uint8_t> write, std::size_t read) = 0;
  virtual std::optional<CarriedOutcome> outcome() = 0;
  virtual void abandon() = 0;  // nobody waits for it any more
};

}  // namespace whirl::io
