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

// How much is in it, and in which state.
// Errors  bad_input: no such file, or no file of messages
Result<Replayed> look_through(const std::string& messages);

// The sinks are given what is in the file, up to its damage.
// Errors  as above; then no sink has been made
Result<Replayed> replay(const std::string& messages, const std::string& folder,
                        const std::vector<SinkType>& types, const std::vector<Sink*>& others = {});

}  // namespace whirl::results
