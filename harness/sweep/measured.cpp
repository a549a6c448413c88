#include "harness/sweep/measured.hpp"

#include "base/rpm.hpp"
#include "harness/sweep/text_table.hpp"

namespace whirl::sweep {

Result<MeasuredFile> read_measured(const std::string& path) {
  const auto read = TextTable::read(path);
  if (!read) return read.error();
  const TextTable& table = read.value();
  MeasuredFile file{table.name(), {}};
  const auto in_name = number_in(file.name.substr(file.name.rfind('_') + 1));
  const int first = table.heads().number;
  if (first == 0) return table.bad(0, "no rows", "one row per measured point");
  if (!table.has("CT") || !table.has("CP")) {
    return table.bad(first, "no columns CT and CP",
                     "name the columns in the first line: rpm J CT CP");
  }
  if (!table.has("rpm") && !in_name) {
    return table.bad(first, "no speed", "a column rpm, or name the file like prop_5000.txt");
  }
  for (const TextTable::Line& line : table.lines()) {
    const auto rpm = table.cell(line, "rpm", in_name.value_or(0.0));
    const auto J = table.cell(line, "J", 0.0);
    const auto CT = table.cell(line, "CT", 0.0), CP = table.cell(line, "CP", 0.0);
    if (!rpm || !J || !CT || !CP) {
      return table.bad(line.number, "a number is missing", "one per named column");
    }
    if (!(*rpm > 0.0 && *rpm <= 1e5 && *J >= 0.0 && *J < 3.0)) {
      return table.bad(line.number, "rpm or J out of range",
                       "rpm above 0, J = V/(n D) from 0 to 3");
    }
    file.points.push_back({radps_of(*rpm), *J, *CT, *CP});
  }
  if (file.points.empty()) return table.bad(first, "no rows", "one row per measured point");
  return file;
}

}  // namespace whirl::sweep
