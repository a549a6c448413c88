#include "results/sinks/sink_types.hpp"

namespace whirl::results {

std::span<const SinkType> sink_types() {
  static const SinkType kAll[] = {
      kTruth_csv, kBus_csv, kTelemetry, kMessages_csv, kVcd,
  };
  return kAll;
}

}  // namespace whirl::results
