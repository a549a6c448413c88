#include "harness/timing/report.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "harness/timing/fields.hpp"

namespace whirl::timing {
namespace {

constexpr const char* kCure = "send the image's own lines, as they came";

Result<Row> read_row(const std::vector<std::string_view>& words) {
  const auto fault = [](const std::string& what) {
    return Error{ErrorKind::bad_input, "", what, kCure};
  };
  if (words.size() != 4) return fault("a row is: row NAME ITERATIONS CYCLES");
  const auto iterations = whole_number(words[2]), cycles = whole_number(words[3]);
  if (!iterations || !cycles) {
    return fault("'" + printable_line(words[1]) + "': counts are whole numbers below 2^32");
  }
  // No interrupt came, say: the cycles belong to nothing.
  if (*iterations == 0) return fault("'" + printable_line(words[1]) + "' never ran");
  return Row{std::string(words[1]), *iterations, *cycles};
}

bool has(const Report& report, const std::string& kernel) {
  return std::any_of(report.rows.begin(), report.rows.end(),
                     [&](const Row& row) { return row.kernel == kernel; });
}

}  // namespace

Result<std::vector<Report>> read_reports(std::string_view text, const std::string& place) {
  std::vector<Report> reports;
  bool inside = false;
  int number = 0;
  const auto fault = [&](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, place + ":" + std::to_string(number), what, cure};
  };
  for (const std::string_view line : lines_of(text)) {
    ++number;
    const auto words = words_of(line, 6);
    if (words.empty()) continue;
    if (words.size() == 3 && words[0] == "timing") {
      if (words[1] != "1")
        return fault("an unknown version of the report", "use this whirl's images");
      reports.push_back({std::string(words[2]), {}, false});
      inside = true;
    } else if (inside && words[0] == "row") {
      auto row = read_row(words);
      if (!row) return fault(row.error().what, row.error().cure);
      if (has(reports.back(), row.value().kernel)) {
        return fault("'" + printable_line(words[1]) + "' comes twice", kCure);
      }
      reports.back().rows.push_back(std::move(row.value()));
    } else if (inside && words[0] == "end" && words.size() == 2) {
      reports.back().complete = whole_number(words[1]) == reports.back().rows.size();
      inside = false;
    } else if (inside) {
      return fault("'" + printable_line(line.substr(0, 60)) + "' is no line of a report", kCure);
    }
  }
  if (reports.empty()) {
    return Error{ErrorKind::bad_input, place, "holds no report of a timing image",
                 "it begins with: timing 1 PART"};
  }
  return reports;
}

}  // namespace whirl::timing
