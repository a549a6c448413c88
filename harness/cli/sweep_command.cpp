#include <cstdio>
#include <filesystem>
#include <fstream>

#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/page_command.hpp"
#include "harness/flight/propeller_file.hpp"
#include "harness/lua/table.hpp"
#include "harness/sweep/sweep.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

Result<sweep::Options> read_options(const SweepOptions& given) {
  sweep::Options options;
  const auto read = [](const std::string& text, Dimension dimension, const char* place,
                       double& into) {
    if (text.empty()) return Result<Done>(Done{});
    const auto value = parse_quantity_as(text, dimension, place);
    if (!value) return Result<Done>(value.error());
    if (!(value.value() > 0.0)) {
      return Result<Done>(
          Error{ErrorKind::bad_input, place, "'" + text + "' must be positive", ""});
    }
    into = value.value();
    return Result<Done>(Done{});
  };
  for (const auto& done :
       {read(given.speed, Dimension::angular_rate, "--speed", options.speed_radps),
        read(given.top_speed, Dimension::angular_rate, "--top-speed", options.top_speed_radps),
        read(given.voltage, Dimension::voltage, "--voltage", options.bus_V)}) {
    if (!done) return done.error();
  }
  return options;
}

struct Swept {
  std::string name;
  std::vector<results::Chart> charts;
};

Result<Swept> sweep_file(const std::string& path, const sweep::Options& options) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const std::string kind = file.value().text_or("kind", "");
  if (kind == "propeller") {
    const auto blade = flight::read_propeller(path);
    if (!blade) return blade.error();
    return Swept{plant::name(*blade.value()), sweep::propeller_sweep(blade.value(), options)};
  }
  if (kind == "vehicle") {
    const auto vehicle = flight::read_vehicle(path);
    if (!vehicle) return vehicle.error();
    return Swept{vehicle.value().name, sweep::vehicle_sweep(vehicle.value(), options)};
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

Result<Done> write_csv(const std::string& path, const std::vector<results::Chart>& charts) {
  std::ofstream out(path, std::ios::binary);
  out << "group;chart;curve;x_label;x;y_label;y\n";
  char numbers[2][40];
  for (const results::Chart& chart : charts) {
    for (const results::ChartCurve& curve : chart.curves) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        std::snprintf(numbers[0], sizeof numbers[0], "%.9g", curve.x[i]);
        std::snprintf(numbers[1], sizeof numbers[1], "%.9g", curve.y[i]);
        out << chart.group << ';' << chart.title << ';' << curve.name << ';' << chart.x_label << ';'
            << numbers[0] << ';' << chart.y_label << ';' << numbers[1] << '\n';
      }
    }
  }
  if (!out.flush()) return Error{ErrorKind::host, path, "cannot be written", ""};
  return Done{};
}

}  // namespace

int sweep_command(const SweepOptions& given, const Composition& composition) {
  const auto options = read_options(given);
  if (!options) return complain(options.error());
  const auto swept = sweep_file(given.file, options.value());
  if (!swept) return complain(swept.error());
  const fs::path folder = fs::path(composition.results) / "sweeps" / fs::path(given.file).stem();
  std::error_code status;
  fs::create_directories(folder, status);
  const std::string about =
      "Steady behaviour by the plant's own models, standard air at sea level.";
  for (const auto& written :
       {results::write_text((folder / "index.html").string(),
                            results::charts_html(swept.value().name, about, swept.value().charts)),
        write_csv((folder / "curves.csv").string(), swept.value().charts)}) {
    if (!written) return complain(written.error());
  }
  std::printf("%s\n%s", swept.value().name.c_str(),
              results::figures_text(swept.value().charts).c_str());
  print_curves(swept.value().charts);
  std::printf("\n%s\n", shown_path((folder / "index.html").string()).c_str());
  return 0;
}

}  // namespace whirl::cli
