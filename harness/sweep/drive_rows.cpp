#include "harness/sweep/drive_rows.hpp"

#include <optional>

#include "base/rpm.hpp"
#include "harness/sweep/text_table.hpp"

namespace whirl::sweep {
namespace {

std::optional<std::string> fault_of(const DriveRow& row, const DriveFile& file) {
  if (!(row.speed_radps > 0.0 && row.speed_radps <= radps_of(2e5))) {
    return "rpm is to be above 0 and at most 200000";
  }
  if (file.volts && !(row.bus_V > 0.0 && row.bus_V <= 1000.0)) return "V is to be 0 to 1000";
  if (!(row.bus_A > 0.0 && row.bus_A <= 1000.0)) return "A is to be 0 to 1000";
  if (!(row.duty > 0.0 && row.duty <= 1.0)) return "duty is to be 0 to 1";
  if (!(row.torque_Nm >= 0.0 && row.torque_Nm <= 1000.0)) return "Nm is to be 0 to 1000";
  if (!(row.thrust_N >= 0.0 && row.thrust_N <= 1e5)) return "N is to be 0 to 100000";
  return {};
}

std::optional<DriveRow> row_of(const TextTable& table, const TextTable::Line& line) {
  const auto V = table.cell(line, "V", 0.0), rpm = table.cell(line, "rpm", 0.0);
  const auto A = table.cell(line, "A", 0.0), duty = table.cell(line, "duty", 1.0);
  const auto Nm = table.cell(line, "Nm", 0.0), N = table.cell(line, "N", 0.0);
  if (!V || !rpm || !A || !duty || !Nm || !N) return {};
  return DriveRow{*V, radps_of(*rpm), *A, *duty, *Nm, *N, table.word(line, "prop")};
}

}  // namespace

Result<DriveFile> read_drive_rows(const std::string& path) {
  const auto read = TextTable::read(path);
  if (!read) return read.error();
  const TextTable& table = read.value();
  DriveFile file{table.name(),
                 table.has("V"),
                 table.has("duty"),
                 table.has("Nm"),
                 table.has("N"),
                 table.has("prop"),
                 {}};
  const int first = table.heads().number;
  if (!table.has("rpm") || !table.has("A")) {
    return table.bad(first, "no columns rpm and A",
                     "name the columns in the first line: V rpm A, and Nm N duty prop where known");
  }
  for (const TextTable::Line& line : table.lines()) {
    const auto row = row_of(table, line);
    if (!row) return table.bad(line.number, "a number is missing", "one per named column");
    if (file.prop && row->prop.empty()) {
      return table.bad(line.number, "the propeller's name is missing", "\"none\" for a bare shaft");
    }
    if (const auto fault = fault_of(*row, file)) return table.bad(line.number, *fault, "");
    file.rows.push_back(*row);
  }
  if (file.rows.empty()) return table.bad(first, "no rows", "one row per measured point");
  return file;
}

}  // namespace whirl::sweep
