#include <cstdio>
#include <filesystem>

#include "base/output_file.hpp"
#include "base/whole_file.hpp"
#include "harness/catalogue/battery_file.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/page_command.hpp"
#include "plant/validation/discharge_proof.hpp"
#include "plant/validation/left_out.hpp"
#include "plant/validation/rotor_proofs.hpp"
#include "plant/validation/validation.hpp"
#include "results/charts.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

results::Chart chart_of(const std::string& group, const plant::Proof& proof) {
  results::Chart chart{group, proof.title, proof.x_label, proof.y_label, proof.source, proof.note,
                       {},    {}};
  for (const plant::Curve& c : proof.model) chart.curves.push_back({c.name, c.x, c.y, false});
  for (const plant::Curve& c : proof.reference) chart.curves.push_back({c.name, c.x, c.y, true});
  for (const plant::Figure& f : proof.figures) {
    chart.figures.push_back({f.name, f.measured, f.limit, f.unit, f.within()});
  }
  return chart;
}

void add(std::vector<results::Chart>& charts, const std::string& group,
         const std::vector<plant::Proof>& proofs) {
  for (const plant::Proof& proof : proofs) charts.push_back(chart_of(group, proof));
}

}  // namespace

int validate_command(const Composition& composition) {
  const std::string& root = composition.root;
  Result<Done> readable = Done{};
  const auto read = [&](const std::string& path) {
    auto text = read_whole_file(root + "/plant/data/" + path);
    if (text) return text.value();
    if (readable) readable = text.error();
    return std::string();
  };
  const auto blade = catalogue::read_propeller(root + "/test_plans/propellers/hk_10x4.5.lua");
  if (!blade) return complain(blade.error());
  std::vector<results::Chart> charts;
  add(charts, "Rotor", plant::rotor_proofs(read));
  if (!readable) return complain(readable.error());
  add(charts, "Motor", plant::motor_proofs(blade.value()));
  add(charts, "Battery", plant::battery_proofs(blade.value()));
  const auto pack = catalogue::read_battery_file(root + "/test_plans/batteries/lco_4s_2340.lua");
  if (!pack) return complain(pack.error());
  constexpr int kCells = 4;
  add(charts, "Battery",
      {plant::discharge_proof(pack.value(), kCells, read("batteries/enertech_spb655060.txt"))});
  if (!readable) return complain(readable.error());
  add(charts, "Airframe", plant::airframe_proofs());
  add(charts, "Free flight", plant::flight_proofs(blade.value()));
  add(charts, "Sensors", plant::sensor_proofs());

  const fs::path folder = fs::path(composition.results) / "validation";
  std::error_code status;
  fs::create_directories(folder, status);
  const auto written =
      write_text((folder / "index.html").string(),
                 results::charts_html(
                     "Validation of the plant",
                     "Each curve over the points of a reference that nobody here made up; the "
                     "keys are resolved in plant/REFERENCES.md.",
                     charts));
  if (!written) return complain(written.error());
  // What plant/data/propellers/known.txt must hold; a figure above says whether it does.
  const auto known = plant::known_text(plant::know(plant::measured_blades(read, "propellers")));
  if (const auto done = write_text((folder / "known.txt").string(), known); !done) {
    return complain(done.error());
  }
  std::fputs(results::figures_text(charts).c_str(), stdout);
  int judged = 0, good = 0;
  for (const results::Chart& chart : charts) {
    for (const results::ChartFigure& f : chart.figures) {
      if (std::isinf(f.limit)) continue;
      ++judged;
      good += f.ok ? 1 : 0;
    }
  }
  std::printf("%d of %d figures within their limits\n%s\n", good, judged,
              shown_path((folder / "index.html").string()).c_str());
  return good == judged ? 0 : 1;
}

}  // namespace whirl::cli
