#include "io_bridges/qemu/board/worst_calls.hpp"

#include <algorithm>
#include <utility>

namespace whirl::board {

void WorstCalls::exception_ended(std::uint32_t exception, Nanoseconds entered_ns,
                                 const Spent& ran) {
  recent_[exceptions_ % kRecent] = {exception, entered_ns, ran};
  ++exceptions_;
}

std::vector<Between> WorstCalls::between(Nanoseconds entry_ns, std::uint64_t count) const {
  std::map<std::uint32_t, Between> found;
  for (std::uint64_t n = exceptions_ - std::min<std::uint64_t>(count, kRecent); n < exceptions_;
       ++n) {
    const Ended& ended = recent_[n % kRecent];
    if (ended.entered_ns < entry_ns) continue;  // one that the call itself came in
    Between& one = found[ended.exception];
    one.exception = ended.exception;
    ++one.times;
    one.ran.ns += ended.ran.ns;
    one.ran.cycles += ended.ran.cycles;
  }
  std::vector<Between> list;
  list.reserve(found.size());
  for (const auto& [exception, one] : found) list.push_back(one);
  return list;
}

void WorstCalls::returned(std::uint16_t number, LongCall call, std::uint64_t exceptions_before,
                          const Path& path) {
  const auto [place, first] = worst_.try_emplace(number);
  Pair& worst = place->second;
  const bool by_execution = first || call.execution.ns > worst.execution.execution.ns;
  const bool by_response = first || call.response.ns > worst.response.response.ns;
  if (!by_execution && !by_response) return;
  call.exceptions = exceptions_ - exceptions_before;
  call.between = between(call.entry_ns, call.exceptions);
  if (path) call.path = path();
  if (by_execution) worst.execution = call;
  if (by_response) worst.response = std::move(call);
}

}  // namespace whirl::board
