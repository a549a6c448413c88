// What came into a run from outside, with its virtual times, and the plan that brings it in again.
//
//   Times    those of Companion::turn; the plan's t:at gives them back at the same step
//   Plan     commands.lua: takes the flown plan in from a copy beside it, lets it run, adds what was
//            recorded, and expects the flight to end where it ended. The pieces stand in files
//            commands_N.lua of half a MiB at most, as no file of a plan may be longer than one
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/result.hpp"
#include "harness/world/request.hpp"

namespace whirl::live {

struct FlownPlan {
  std::string file;                                           // that was flown
  std::string name;                                           // of the plan in it
  std::vector<std::string> taken_in;                          // relative to the file's folder
  std::vector<std::pair<std::string, std::string>> settings;  // plan.KEY, value: in its place
  std::uint64_t seed = 1;
  std::int64_t end_ns = 0;
  std::vector<std::pair<std::string, double>> end_m;  // signals in metres, as the flight ended
};

class Recording {
 public:
  // In order of time.
  void add(std::int64_t t_ns, std::span<const std::uint8_t> piece);
  void add(std::int64_t t_ns, const request::Sticks& sticks);
  std::size_t pieces() const { return pieces_; }  // of the radio

  // Errors  host: a file cannot be written; bad_input: one of the plan's cannot be read any more
  Result<Done> write(const std::string& folder, const FlownPlan& flown) const;

 private:
  struct Entry {
    std::int64_t t_ns;
    std::variant<std::vector<std::uint8_t>, request::Sticks> what;
  };
  std::vector<Entry> entries_;
  std::size_t pieces_ = 0;
};

}  // namespace whirl::live
