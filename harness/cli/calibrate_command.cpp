#include "harness/cli/calibrate_command.hpp"
#include "base/output_file.hpp"
#include "base/text.hpp"

#include <cstdio>
#include <filesystem>

#include "harness/calibrate/data_file.hpp"
#include "harness/calibrate/procedure.hpp"
#include "harness/calibrate/report.hpp"
#include "harness/catalogue/calibration_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/find_plans.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;
using calibrate::Calibration;

struct Parts {
  plan::Plan plan;
  BoardDescription board;
  std::unique_ptr<World> world;
  std::unique_ptr<Target> target;
};

Result<Done> compose(const catalogue::CalibrationFile& file, const Composition& composition,
                     Parts& parts) {
  const calibrate::Setup& setup = file.setup;
  const std::string& root = composition.root;
  const Asker who{setup.file, setup.file};
  const auto board = find_board(setup.board, who, root);
  if (!board) return board.error();
  parts.board = board.value();
  parts.board.watch.clear();
  parts.plan = plan::plan_of_one_board("calibration", setup.file);
  parts.plan.stand = file.stand;
  const auto image = find_file(setup.image, who, {root + "/build/firmware"}, ".elf");
  if (!image) return image.error();
  const Setup all{parts.plan, 0, parts.board, root, image.value(), "", setup.seed, 0};
  auto world = composition.world(all);
  if (!world) return world.error();
  auto target = composition.target(all);
  if (!target) return target.error();
  parts.world = std::move(world.value());
  parts.target = std::move(target.value());
  return Done{};
}

// Measures, concludes, and stores the constants in the ESC, all in one power-up.
Result<Calibration> on_the_stand(const catalogue::CalibrationFile& file,
                                 const Composition& composition, const std::string& data_path) {
  const calibrate::Setup& setup = file.setup;
  Parts parts;
  if (auto good = compose(file, composition, parts); !good) return good.error();
  for (const std::string& doubt : parts.world->doubts()) {
    std::fprintf(stderr, "whirl: doubt: %s\n", printable_line(doubt).c_str());
  }
  calibrate::Bench bench(*parts.world, *parts.target, setup.serial);
  if (auto started = bench.start(); !started) return started.error();
  const auto progress = [&](const std::string& words) {
    std::fprintf(stderr, "%7.1f s  %s\n", static_cast<double>(bench.now_ns()) * 1e-9,
                 words.c_str());
  };
  auto data = measure_all(bench, setup, progress);
  if (!data) return data.error();
  const auto kept = write_text(data_path, data_text(data.value()));
  if (!kept) return kept.error();
  auto result = calibrate::identify(std::move(data.value()), setup);
  if (!result || !physical(result.value())) return result;
  progress("storing the constants in the ESC");
  if (auto stored = store(bench, lines(result.value())); !stored) return stored.error();
  return result;
}

Result<Calibration> again(const std::string& data_path, const calibrate::Setup& setup) {
  auto data = calibrate::read_data(data_path);
  if (!data) return data.error();
  return calibrate::identify(std::move(data.value()), setup);
}

}  // namespace

int calibrate_esc_command(const CalibrateOptions& options, const Composition& composition) {
  auto file = catalogue::read_calibration(options.file);
  if (!file) return complain(file.error());
  const std::string name = fs::path(options.file).stem();
  fs::path folder = fs::path(composition.results) / "calibrations" / name;
  if (options.seed) {
    file.value().setup.seed = *options.seed;
    folder /= "seed_" + std::to_string(*options.seed);
  }
  std::error_code status;
  fs::create_directories(folder, status);
  const std::string data = (folder / "data.txt").string();
  const auto result = options.data.empty() ? on_the_stand(file.value(), composition, data)
                                           : again(options.data, file.value().setup);
  if (!result) return complain(result.error());
  const Calibration& c = result.value();

  const std::string constants = lua_file(c, options.command);
  const std::string page = (folder / "index.html").string();
  const std::string about = "Calibration of an ESC on the stand: " + options.command;
  const auto bound = inflow_bound_of(options.file, composition.root);
  if (!bound) return complain(bound.error());
  auto all = charts(c);
  all.insert(all.end(), bound.value().charts.begin(), bound.value().charts.end());
  std::vector<std::pair<std::string, std::string>> files = {
      {page, results::charts_html(name, about, all, {bound.value().table})},
      {(folder / "constants.lua").string(), constants}};
  const auto believed = physical(c);
  if (believed.ok() && !options.write.empty()) files.emplace_back(options.write, constants);
  for (const auto& [path, text] : files) {
    if (const auto written = write_text(path, text); !written) {
      return complain(written.error());
    }
  }
  std::printf("%s\n%s\n", table(c).c_str(), inflow_bound::text(bound.value().table).c_str());
  for (const auto& [path, text] : files) std::printf("%s\n", shown_path(path).c_str());
  if (!believed) return complain(believed.error());
  return 0;
}

}  // namespace whirl::cli
