// Fuzzes what a board's process sends.
#include <tuple>

#include "results/event_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  whirl::io::Batch batch;
  batch.assign({data, size});
  whirl::results::EventLog log;
  std::ignore = log.add(batch);
  std::ignore = log.busy_share(0, 1'000'000'000);
  return 0;
}
