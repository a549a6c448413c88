#include <cstdio>
#include <filesystem>

#include "base/output_file.hpp"
#include "harness/catalogue/calibration_file.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/cli/calibrate_command.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/inflow_bound/report.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

// From a pack that is nearly empty to a full one under load, and the stand's own voltage last.
std::vector<double> voltages(const plant::BatteryParams& feed) {
  return {14.5, 15.5, 16.8, feed.open_circuit.front().voltage_V};
}

}  // namespace

Result<inflow_bound::Report> inflow_bound_of(const std::string& file, const std::string& root) {
  const auto calibration = catalogue::read_calibration(file);
  if (!calibration) return calibration.error();
  const auto stand =
      catalogue::read_stand(calibration.value().stand, root + "/test_plans/propellers");
  if (!stand) return stand.error();
  const inflow_bound::Copy copy{stand.value().blade, stand::motor_of(stand.value().stage),
                                stand::shunt_of(stand.value().stage),
                                catalogue::density_of(calibration.value().setup, stand.value())};
  return inflow_bound::report(copy, {0.8, 1.6, 2.4, 3.2, 4.0}, voltages(stand.value().battery));
}

int inflow_bound_command(const std::string& file, const Composition& composition) {
  const auto found = inflow_bound_of(file, composition.root);
  if (!found) return complain(found.error());
  const inflow_bound::Report& report = found.value();
  const std::string name = fs::path(file).stem();
  const fs::path folder = fs::path(composition.results) / "calibrations" / name;
  std::error_code status;
  fs::create_directories(folder, status);
  const std::string page = (folder / "bound.html").string();
  const auto written = write_text(
      page,
      results::charts_html(name, "What current, voltage and speed can tell of inflow at best.",
                           report.charts, {report.table}));
  if (!written) return complain(written.error());
  std::printf("%s%s\n", inflow_bound::text(report.table).c_str(), shown_path(page).c_str());
  return 0;
}

}  // namespace whirl::cli
