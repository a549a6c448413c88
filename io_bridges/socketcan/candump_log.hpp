// Frames as lines of candump's log (can-utils -l; python-can and SavvyCAN read it):
//   (1732512345.000125) can0 1801552A#0403020158CDABC5
//
//   Time      seconds, to the microsecond; which clock, who writes says
//   Left out  error frames; candump's direction letter
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io_bridges/protocols/can_frame.hpp"

namespace whirl::io {

std::string candump_line(std::int64_t t_ns, std::string_view interface, const CanFrame& frame);

struct CandumpLine {
  std::int64_t t_ns = 0;
  std::string interface;
  CanFrame frame;
};
// Nothing: not such a line.
std::optional<CandumpLine> parse_candump_line(std::string_view line);

}  // namespace whirl::io
