#include <cstdarg>
#include <cstdio>
#include <filesystem>

#include "base/output_file.hpp"
#include "base/text.hpp"
#include "harness/catalogue/copies.hpp"
#include "harness/catalogue/kind.hpp"
#include "harness/catalogue/motor_file.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/stand_drive.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/option_quantity.hpp"
#include "harness/cli/page_command.hpp"
#include "harness/cli/seeds.hpp"
#include "harness/sweep/forward_sweep.hpp"
#include "harness/sweep/motor_sweep.hpp"
#include "harness/sweep/parts_spread.hpp"
#include "harness/sweep/stand_sweep.hpp"
#include "harness/sweep/sweep.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

std::string said(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string said(const char* format, ...) {
  char text[300];
  va_list list;
  va_start(list, format);
  std::vsnprintf(text, sizeof text, format, list);
  va_end(list);
  return text;
}

Result<sweep::Options> read_options(const SweepOptions& given) {
  sweep::Options options;
  const auto speed = [](const std::string& text, const char* option, double& into) {
    return read_within(text, Dimension::angular_rate, option, "10 rpm", "100000 rpm", into);
  };
  // Beyond these the models have nothing to say, and do not settle.
  for (const auto& done : {speed(given.speed, "--speed", options.speed_radps),
                           speed(given.top_speed, "--top-speed", options.top_speed_radps),
                           read_within(given.voltage, Dimension::voltage, "--voltage", "0.5 V",
                                       "1000 V", options.bus_V)}) {
    if (!done) return done.error();
  }
  for (const std::string& text : given.speeds) {
    if (const auto done = speed(text, "--speeds", options.speeds_radps.emplace_back()); !done) {
      return done.error();
    }
  }
  for (const double J : given.advance_ratios) {
    if (J >= 0.0 && J <= 2.0) continue;
    return Error{ErrorKind::bad_input, "--J", said("%g is outside 0 to 2", J), "J = V/(n D)"};
  }
  if (!given.advance_ratios.empty()) options.advance_ratios = given.advance_ratios;
  return options;
}

// What only a propeller along its shaft has.
Result<Done> check_kind(const SweepOptions& given, const std::string& kind) {
  if (kind == "propeller") return Done{};
  for (const auto& [option, is_given] : {std::pair("--speeds", !given.speeds.empty()),
                                         std::pair("--J", !given.advance_ratios.empty())}) {
    if (!is_given) continue;
    return Error{ErrorKind::bad_input, option, given.file + " is a " + kind,
                 "it is of a propeller's file; of the others --speed, --top-speed, --voltage"};
  }
  return Done{};
}

struct Swept {
  std::string name;
  std::vector<results::Chart> charts;
  std::vector<std::string> lines;  // what was chosen or found, and what is doubted
  const char *title, *head;        // of those lines, on the page
  std::string verdict;             // empty: there was nothing to judge by
  bool good = true;
};

constexpr const char *kDoubts = "Doubts", *kOf_propeller = "of its propeller";

template <typename File>
Result<std::vector<File>> read_all(const std::vector<std::string>& paths,
                                   Result<File> (*read)(const std::string&)) {
  std::vector<File> files;
  for (const std::string& path : paths) {
    auto file = read(path);
    if (!file) return file.error();
    files.push_back(std::move(file.value()));
  }
  return files;
}

// Nine in ten left-out propellers are within this.
void judge(const sweep::ForwardJudged& flight, bool has_band, Swept& swept) {
  if (flight.points == 0) return;
  constexpr double kMost_CT = 12.0, kMost_CP = 14.0;
  swept.good = flight.CT_percent <= kMost_CT && flight.CP_percent <= kMost_CP;
  swept.verdict = said("in flight CT %.1f %% (at most %g), CP %.1f %% (at most %g), %d points",
                       flight.CT_percent, kMost_CT, flight.CP_percent, kMost_CP, flight.points);
  if (!has_band) return;
  swept.verdict += said("; inside the 90 %% band: %.0f %% and %.0f %%", flight.CT_inside_percent,
                        flight.CP_inside_percent);
}

Result<Swept> sweep_propeller(const std::string& path, const std::vector<std::string>& files,
                              const sweep::Options& options) {
  const auto read = catalogue::read_propeller_file(path);
  if (!read) return read.error();
  const auto measured = read_all(files, sweep::read_measured);
  if (!measured) return measured.error();
  const auto& blade = read.value().blade;
  const sweep::SweptPropeller propeller{blade, read.value().fit.get(), read.value().twist.get()};
  Swept swept{plant::name(*blade), {}, {}, "", "", {}};
  if (propeller.fit != nullptr) {
    swept.title = "Fitted on its static rows, and how sure", swept.head = "trait, 90 % interval";
    swept.lines = sweep::fit_lines(*propeller.fit);
  } else {
    swept.title = "Sections and twist", swept.head = "as named, and as found on static thrust";
    swept.lines = sweep::twist_lines(*propeller.twist);
  }
  auto forward = sweep::forward_sweep(propeller, measured.value(), options);
  judge(forward.flight, propeller.fit != nullptr, swept);
  swept.charts = std::move(forward.charts);
  for (auto& chart : sweep::propeller_sweep(blade, options))
    swept.charts.push_back(std::move(chart));
  return swept;
}

Result<Swept> sweep_motor(const std::string& path, const std::vector<std::string>& files,
                          const sweep::Options& options) {
  const auto motor = catalogue::read_motor_file(path);
  if (!motor) return motor.error();
  const auto measured = read_all(files, sweep::read_drive_rows);
  if (!measured) return measured.error();
  constexpr double kThree_cells_V = 11.1;
  auto result = sweep::motor_sweep(
      motor.value().params, options.bus_V > 0.0 ? options.bus_V : kThree_cells_V, measured.value());
  if (!result) return result.error();
  sweep::MotorSweep& found = result.value();
  Swept swept{motor.value().name,        std::move(found.charts),
              std::move(found.lines),    "By the measured rows, and how sure",
              "constant, 95 % interval", {}};
  if (files.empty()) return swept;
  swept.good = found.speed_percent <= sweep::kMost_speed_percent && found.wrong.empty();
  swept.verdict = said("speed by voltage and current %.2f %% off (at most %g)", found.speed_percent,
                       sweep::kMost_speed_percent);
  for (const std::string& wrong : found.wrong) swept.verdict += "; the rows contradict " + wrong;
  return swept;
}

Result<Swept> sweep_stand(const std::string& path, const std::vector<std::string>& files,
                          const sweep::Options& options, const Composition& composition) {
  const auto stand = catalogue::read_stand_drive(path, composition.root + "/test_plans/propellers");
  if (!stand) return stand.error();
  const auto measured = read_all(files, sweep::read_drive_rows);
  if (!measured) return measured.error();
  auto result = sweep::stand_sweep(stand.value(), options, measured.value());
  if (!result) return result.error();
  Swept swept{stand.value().name,
              std::move(result.value().charts),
              sweep::doubt_lines(stand.value().doubts),
              kDoubts,
              kOf_propeller,
              {}};
  for (const sweep::Allowed& allowed : sweep::kStand_allowed) {
    const auto off = result.value().off_percent.find(allowed.what);
    if (off == result.value().off_percent.end()) continue;
    swept.good = swept.good && off->second <= allowed.percent;
    swept.verdict += said("%s%s %.1f %% off (at most %g)", swept.verdict.empty() ? "" : ", ",
                          allowed.what, off->second, allowed.percent);
  }
  return swept;
}

Result<Swept> sweep_file(const std::string& path, const std::vector<std::string>& measured,
                         const sweep::Options& options, const Composition& composition) {
  const auto kind = catalogue::read_kind(path);
  if (!kind) return kind.error();
  if (kind.value() == "propeller") return sweep_propeller(path, measured, options);
  if (kind.value() == "motor") return sweep_motor(path, measured, options);
  if (kind.value() == "calibration") return sweep_stand(path, measured, options, composition);
  if (kind.value() != "vehicle") return catalogue::no_part(path);
  if (!measured.empty()) {
    return Error{ErrorKind::bad_input, "--measured", path + " is a vehicle",
                 "lay measured points over its propeller, its motor or a stand"};
  }
  const auto vehicle = catalogue::read_vehicle(path);
  if (!vehicle) return vehicle.error();
  return Swept{vehicle.value().name,
               sweep::vehicle_sweep(vehicle.value(), options),
               sweep::doubt_lines(vehicle.value().doubts),
               kDoubts,
               kOf_propeller,
               {}};
}

// Ten rows of each curve are enough for a terminal; the page and the CSV have all.
void print_curves(const std::vector<results::Chart>& charts) {
  std::string group;
  for (const results::Chart& chart : charts) {
    if (chart.group != group) std::printf("\n%s\n", chart.group.c_str());
    group = chart.group;
    if (!chart.note.empty()) {
      std::printf("  note on %s: %s\n", chart.title.c_str(), printable_line(chart.note).c_str());
    }
    for (const results::ChartCurve& curve : chart.curves) {
      std::printf("  %s (%s): %s\n", chart.title.c_str(), curve.name.c_str(),
                  chart.y_label.c_str());
      const std::size_t step = std::max<std::size_t>(1, (curve.x.size() + 9) / 10);
      std::printf("    %-34s", chart.x_label.c_str());
      for (std::size_t i = 0; i < curve.x.size(); i += step) std::printf(" %9.4g", curve.x[i]);
      std::printf("\n    %-34s", "");
      for (std::size_t i = 0; i < curve.y.size(); i += step) std::printf(" %9.4g", curve.y[i]);
      std::printf("\n");
    }
  }
}

fs::path folder_of(const std::string& file, const Composition& composition) {
  const fs::path folder = fs::path(composition.results) / "sweeps" / fs::path(file).stem();
  std::error_code status;  // what could not be made is told by who writes there
  fs::create_directories(folder, status);
  return folder;
}

Result<Done> put_out(const Swept& swept, const std::string& file, const Composition& composition) {
  const fs::path folder = folder_of(file, composition);
  const std::string about =
      "Steady behaviour by the plant's own models, standard air at sea level.";
  std::vector<results::ChartTable> tables;
  if (!swept.lines.empty()) {
    auto& table = tables.emplace_back();
    table.title = swept.title;
    table.heads = {{swept.head, false}};
    for (const std::string& line : swept.lines) table.rows.push_back({line});
  }
  for (const auto& written :
       {write_text((folder / "index.html").string(),
                   results::charts_html(swept.name, about, swept.charts, tables)),
        write_text((folder / "curves.csv").string(), results::curves_csv(swept.charts)),
        write_text((folder / "figures.csv").string(), results::figures_csv(swept.charts))}) {
    if (!written) return written.error();
  }
  std::printf("%s\n", printable_line(swept.name).c_str());
  for (const std::string& line : swept.lines) std::printf("  %s\n", line.c_str());
  std::fputs(results::figures_text(swept.charts).c_str(), stdout);
  print_curves(swept.charts);
  std::printf("\n%s\n", shown_path((folder / "index.html").string()).c_str());
  return Done{};
}

Result<Done> put_out_copies(const SweepOptions& given, const Composition& composition) {
  const auto seeds = read_seeds(given.seeds);
  if (!seeds) return seeds.error();
  const auto copies = catalogue::read_copies(given.file, plant::tolerance_named(given.tolerance),
                                             composition.root + "/test_plans/propellers");
  if (!copies) return copies.error();
  sweep::PartsSpread spread(copies.value().numbers, copies.value().tolerance);
  for (const std::uint64_t seed : seeds.value()) {
    for (const DrawnPart& part : copies.value().of_seed(seed)) spread.add(part.name, part.value);
  }
  const fs::path folder = folder_of(given.file, composition);
  const std::string page = (folder / "copies.html").string();
  const std::string about = "Copies of seeds " + given.seeds + ", and what their class allows.";
  for (const auto& written :
       {write_text(page, results::charts_html(copies.value().name, about, {}, {spread.table()})),
        write_text((folder / "copies.csv").string(), spread.csv())}) {
    if (!written) return written.error();
  }
  std::printf("%s\n", printable_line(copies.value().name).c_str());
  std::fputs(spread.text().c_str(), stdout);
  std::printf("\n%s\n", shown_path(page).c_str());
  return Done{};
}

}  // namespace

int sweep_command(const SweepOptions& given, const Composition& composition) {
  if (!given.seeds.empty()) {
    const auto done = put_out_copies(given, composition);
    return done ? 0 : complain(done.error());
  }
  const auto options = read_options(given);
  if (!options) return complain(options.error());
  const auto kind = catalogue::read_kind(given.file);
  if (!kind) return complain(kind.error());
  if (const auto good = check_kind(given, kind.value()); !good) return complain(good.error());
  const auto swept = sweep_file(given.file, given.measured, options.value(), composition);
  if (!swept) return complain(swept.error());
  const auto done = put_out(swept.value(), given.file, composition);
  return done ? 0 : complain(done.error());
}

int validate_file_command(const std::string& file, const std::vector<std::string>& measured,
                          const Composition& composition) {
  if (measured.empty()) {
    return complain(Error{ErrorKind::bad_input, file, "no measured points to judge it by",
                          "name files after it: of a propeller columns rpm J CT CP, of a motor or "
                          "stand V rpm A"});
  }
  const auto swept = sweep_file(file, measured, {}, composition);
  if (!swept) return complain(swept.error());
  if (const auto done = put_out(swept.value(), file, composition); !done) {
    return complain(done.error());
  }
  if (swept.value().verdict.empty()) {
    return complain(Error{ErrorKind::bad_input, file, "no measured point with J above 0.1",
                          "a verdict needs points in flight"});
  }
  std::printf("%s: %s\n", swept.value().good ? "predicted" : "NOT predicted",
              swept.value().verdict.c_str());
  return swept.value().good ? 0 : 1;
}

}  // namespace whirl::cli
