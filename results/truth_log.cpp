#include "results/truth_log.hpp"

#include <charconv>
#include <fstream>

namespace whirl::results {
namespace {

// A row per millisecond of ten minutes is 150 MB of text: long runs keep every second, third, ... row.
constexpr std::size_t kMostRows = 200'000;

void append_number(std::string& line, double x) {
  char text[32];
  // Seven digits: below what any model here resolves, and the same on every machine.
  const auto end = std::to_chars(text, text + sizeof text, x, std::chars_format::general, 7).ptr;
  line.append(text, end);
}

}  // namespace

Result<Done> TruthLog::write_csv(const std::string& path) const {
  std::ofstream out(path, std::ios::binary);
  std::string line = "t_s";
  for (const Column& column : columns_) {
    line += "," + column.name + (column.unit_suffix.empty() ? "" : "_" + column.unit_suffix);
  }
  line += '\n';
  const std::size_t stride = 1 + rows() / kMostRows;
  for (std::size_t row = 0; row < rows(); row += stride) {
    if (line.size() > 60'000) {
      out << line;
      line.clear();
    }
    append_number(line, static_cast<double>(row) * static_cast<double>(step_ns_) * 1e-9);
    for (const auto& column : values_) {
      line += ',';
      append_number(line, column[row]);
    }
    line += '\n';
  }
  out << line;
  if (!out.flush()) return Error{ErrorKind::host, path, "cannot be written", "is the disk full?"};
  return Done{};
}

}  // namespace whirl::results
