// The longest calls of each watched function, by execution and by response: when they were, how they
// were reached and what came between.
//
//   Path      as of the return, innermost first: the stack is searched for words that point behind a
//             call, so it may name too many callers, never too few (post_mortem.hpp)
//   Between   the exceptions that were taken between entry and return, with what each ran by itself; of
//             more than 64 the last ones
//   Worst     of those seen: no bound
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "io_bridges/devices/event_queue.hpp"

namespace whirl::board {

using io::Nanoseconds;

// Time of the core: what it was, and cycles of HCLK.
struct Spent {
  Nanoseconds ns = 0;
  std::uint64_t cycles = 0;
};

struct Between {
  std::uint32_t exception = 0;
  std::uint32_t times = 0;
  Spent ran;
};

struct LongCall {
  Nanoseconds entry_ns = 0, return_ns = 0;
  Spent execution, response;
  std::uint32_t exception = 0;  // whose handler it ran in; 0: thread mode
  std::string path;             // a caller per line
  std::vector<Between> between;
  std::uint64_t exceptions = 0;  // taken between entry and return, however many are listed
};

class WorstCalls {
 public:
  using Path = std::function<std::string()>;

  void exception_ended(std::uint32_t exception, Nanoseconds entered_ns, const Spent& ran);
  std::uint64_t exceptions() const { return exceptions_; }  // ended until now

  // A call has returned; `path` is asked only where it is the longest yet. `exceptions_before`: at its
  // entry.
  void returned(std::uint16_t number, LongCall call, std::uint64_t exceptions_before,
                const Path& path);

  struct Pair {
    LongCall execution, response;
  };
  const std::map<std::uint16_t, Pair>& by_number() const { return worst_; }

 private:
  static constexpr std::size_t kRecent = 64;
  struct Ended {
    std::uint32_t exception = 0;
    Nanoseconds entered_ns = 0;
    Spent ran;
  };

  std::vector<Between> between(Nanoseconds entry_ns, std::uint64_t count) const;

  std::map<std::uint16_t, Pair> worst_;
  std::array<Ended, kRecent> recent_;
  std::uint64_t exceptions_ = 0;
};

}  // namespace whirl::board
