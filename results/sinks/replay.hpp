// A file of messages through sinks: after each run, and for `whirl export`.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "results/sinks/sink.hpp"

namespace whirl::results {

struct Replayed {
  std::uint64_t rows = 0;
  std::int64_t end_ns = 0;      // of the last row
  bool whole = false;           // the run came to its end; false: it was cut off here
  std::vector<Error> lost;      // files that could not be written
  std::optional<Error> damage;  // what follows could not be read
};

// Of a damaged file what is before the damage, or no files at all.
enum class Damaged { keep, drop };

// The sinks are given what is in the file, up to its damage.
// Errors  bad_input: no such file, or no file of messages; then no sink has been made
Result<Replayed> replay(const std::string& messages, const std::string& folder,
                        const std::vector<SinkType>& types, const std::vector<Sink*>& others = {},
                        Damaged damaged = Damaged::keep);

}  // namespace whirl::results
