#include <cstdio>
#include <filesystem>
#include <fstream>

#include "base/output_file.hpp"
#include "base/text.hpp"
#include "harness/catalogue/kind.hpp"
#include "harness/catalogue/propeller_file.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/page_command.hpp"
#include "harness/sweep/forward_sweep.hpp"
#include "harness/sweep/sweep.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

struct Option {
  const char* name;
  const std::string& text;
  Dimension dimension;
  const char *low, *high;  // beyond them the models have nothing to say, and do not settle
  double& into;
};

Result<Done> read_option(const Option& option) {
  if (option.text.empty()) return Done{};
  const auto value = parse_quantity_as(option.text, option.dimension, option.name);
  if (!value) return value.error();
  const double low = parse_quantity_as(option.low, option.dimension, "").value();
  const double high = parse_quantity_as(option.high, option.dimension, "").value();
  if (!(value.value() >= low && value.value() <= high)) {
    return Error{ErrorKind::bad_input, option.name,
                 "'" + option.text + "' is outside " + option.low + " to " + option.high, ""};
  }
  option.into = value.value();
  return Done{};
}

Result<sweep::Options> read_options(const SweepOptions& given) {
  sweep::Options options;
  for (const Option& option :
       {Option{"--speed", given.speed, Dimension::angular_rate, "10 rpm", "100000 rpm",
               options.speed_radps},
        Option{"--top-speed", given.top_speed, Dimension::angular_rate, "10 rpm", "100000 rpm",
               options.top_speed_radps},
        Option{"--voltage", given.voltage, Dimension::voltage, "0.5 V", "1000 V", options.bus_V}}) {
    if (const auto done = read_option(option); !done) return done.error();
  }
  return options;
}

struct Swept {
  std::string name;
  std::vector<results::Chart> charts;
  std::vector<std::string> lines;  // what was chosen and what is doubted
  sweep::ForwardSweep forward;     // of a propeller; its charts are in `charts`
};

Result<Swept> sweep_propeller(const std::string& path, const std::vector<std::string>& files,
                              const sweep::Options& options) {
  const auto read = catalogue::read_propeller_file(path);
  if (!read) return read.error();
  std::vector<sweep::MeasuredFile> measured;
  for (const std::string& file : files) {
    auto points = sweep::read_measured(file);
    if (!points) return points.error();
    measured.push_back(std::move(points.value()));
  }
  const auto& blade = read.value().blade;
  Swept swept{plant::name(*blade), {}, {}, {}};
  if (read.value().fit) swept.lines = sweep::fit_lines(*read.value().fit);
  swept.forward = sweep::forward_sweep(
      blade, read.value().fit, measured,
      options.speed_radps > 0.0 ? options.speed_radps : options.top_speed_radps);
  swept.charts = std::move(swept.forward.charts);
  for (auto& chart : sweep::propeller_sweep(blade, options))
    swept.charts.push_back(std::move(chart));
  return swept;
}

Result<Swept> sweep_file(const std::string& path, const std::vector<std::string>& measured,
                         const sweep::Options& options) {
  const auto kind = catalogue::read_kind(path);
  if (!kind) return kind.error();
  if (kind.value() == "propeller") return sweep_propeller(path, measured, options);
  if (!measured.empty()) {
    return Error{ErrorKind::bad_input, "--measured", path + " is no propeller",
                 "lay measured points over a propeller file"};
  }
  if (kind.value() == "vehicle") {
    const auto vehicle = catalogue::read_vehicle(path);
    if (!vehicle) return vehicle.error();
    return Swept{vehicle.value().name, sweep::vehicle_sweep(vehicle.value(), options), {}, {}};
  }
  return Error{ErrorKind::bad_input, path, "is neither a vehicle nor a propeller",
               "kind = \"vehicle\" or \"propeller\""};
}

// Ten rows of each curve are enough for a terminal; the page and the CSV have all.
void print_curves(const std::vector<results::Chart>& charts) {
  std::string group;
  for (const results::Chart& chart : charts) {
    if (chart.group != group) std::printf("\n%s\n", chart.group.c_str());
    group = chart.group;
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

// A name may hold what separates fields and lines: RFC 4180 puts such a field into quotes.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(";\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

Result<Done> write_csv(const std::string& path, const std::vector<results::Chart>& charts) {
  std::ofstream out(path, std::ios::binary);
  out << "group;chart;curve;x_label;x;y_label;y\n";
  char numbers[2][40];
  for (const results::Chart& chart : charts) {
    for (const results::ChartCurve& curve : chart.curves) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        std::snprintf(numbers[0], sizeof numbers[0], "%.9g", curve.x[i]);
        std::snprintf(numbers[1], sizeof numbers[1], "%.9g", curve.y[i]);
        for (const std::string& text : {chart.group, chart.title, curve.name, chart.x_label}) {
          out << csv_field(text) << ';';
        }
        out << numbers[0] << ';' << csv_field(chart.y_label) << ';' << numbers[1] << '\n';
      }
    }
  }
  if (!out.flush()) return Error{ErrorKind::host, path, "cannot be written", ""};
  return Done{};
}

Result<Done> put_out(const Swept& swept, const std::string& file, const Composition& composition) {
  const fs::path folder = fs::path(composition.results) / "sweeps" / fs::path(file).stem();
  std::error_code status;
  fs::create_directories(folder, status);
  const std::string about =
      "Steady behaviour by the plant's own models, standard air at sea level.";
  std::vector<results::ChartTable> tables;
  if (!swept.lines.empty()) {
    auto& table = tables.emplace_back();
    table.title = "Fitted on its static rows, and how sure";
    table.heads = {{"trait, 90 % interval", false}};
    for (const std::string& line : swept.lines) table.rows.push_back({line});
  }
  for (const auto& written :
       {write_text((folder / "index.html").string(),
                   results::charts_html(swept.name, about, swept.charts, tables)),
        write_csv((folder / "curves.csv").string(), swept.charts)}) {
    if (!written) return written.error();
  }
  std::printf("%s\n", printable_line(swept.name).c_str());
  for (const std::string& line : swept.lines) std::printf("  %s\n", line.c_str());
  std::fputs(results::figures_text(swept.charts).c_str(), stdout);
  print_curves(swept.charts);
  std::printf("\n%s\n", shown_path((folder / "index.html").string()).c_str());
  return Done{};
}

}  // namespace

int sweep_command(const SweepOptions& given, const Composition& composition) {
  const auto options = read_options(given);
  if (!options) return complain(options.error());
  const auto swept = sweep_file(given.file, given.measured, options.value());
  if (!swept) return complain(swept.error());
  const auto done = put_out(swept.value(), given.file, composition);
  return done ? 0 : complain(done.error());
}

int validate_propeller_command(const std::string& propeller,
                               const std::vector<std::string>& measured,
                               const Composition& composition) {
  if (measured.empty()) {
    return complain(Error{ErrorKind::bad_input, propeller, "no measured points to judge it by",
                          "name files with columns rpm J CT CP after it"});
  }
  const auto swept = sweep_propeller(propeller, measured, {});
  if (!swept) return complain(swept.error());
  if (const auto done = put_out(swept.value(), propeller, composition); !done) {
    return complain(done.error());
  }
  const sweep::ForwardJudged& flight = swept.value().forward.flight;
  if (flight.points == 0) {
    return complain(Error{ErrorKind::bad_input, propeller, "no measured point with J above 0.1",
                          "a verdict needs points in flight"});
  }
  constexpr double kMost_CT = 12.0, kMost_CP = 14.0;
  const bool good = flight.CT_percent <= kMost_CT && flight.CP_percent <= kMost_CP;
  std::printf(
      "%s: in flight CT %.1f %% (at most %g), CP %.1f %% (at most %g), %d points; inside the "
      "90 %% band: %.0f %% and %.0f %%\n",
      good ? "predicted" : "NOT predicted", flight.CT_percent, kMost_CT, flight.CP_percent,
      kMost_CP, flight.points, flight.CT_inside_percent, flight.CP_inside_percent);
  return good ? 0 : 1;
}

}  // namespace whirl::cli
