#include "harness/cli/calibrate_command.hpp"

#include <cstdio>
#include <filesystem>

#include "harness/calibrate/procedure.hpp"
#include "harness/calibrate/report.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;
using calibrate::Calibration;

int complain(const Error& error) {
  std::fprintf(stderr, "whirl: %s\n", error.message().c_str());
  return error.kind == ErrorKind::bad_input ? 2 : error.kind == ErrorKind::host ? 3 : 4;
}

std::string named(const std::string& written, const std::string& folder,
                  const std::string& extension) {
  return written.find('/') != std::string::npos ? written : folder + "/" + written + extension;
}

// Measures, concludes, and stores the constants in the ESC, all in one power-up.
Result<Calibration> calibrate_esc(const calibrate::Setup& setup, const Composition& composition) {
  const std::string& root = composition.root;
  auto board = read_board(named(setup.board, root + "/test_plans/boards", ".lua"));
  if (!board) return board.error();
  board.value().watch.clear();
  plan::Plan plan;
  plan.name = "calibration";
  plan.file = plan.place = setup.file;
  plan.stand = setup.stand;
  const std::string image = named(setup.image, root + "/build/firmware", ".elf");
  if (!fs::is_regular_file(image)) {
    return Error{ErrorKind::bad_input, setup.file, "no image at " + image, "./whirl builds it"};
  }
  const Setup parts{plan,       board.value(),
                    root,       image,
                    "",         board_json(board.value(), {.image = image, .seed = setup.seed}),
                    setup.seed, 0};
  auto world = composition.world(parts);
  if (!world) return world.error();
  auto target = composition.target(parts);
  if (!target) return target.error();

  calibrate::Bench bench(*world.value(), *target.value(), setup.serial);
  if (auto started = bench.start(); !started) return started.error();
  const auto tell = [&](const std::string& words) {
    std::fprintf(stderr, "%7.1f s  %s\n", static_cast<double>(bench.now_ns()) * 1e-9,
                 words.c_str());
  };
  auto data = measure_all(bench, setup, tell);
  if (!data) return data.error();
  auto result = calibrate::identify(std::move(data.value()));
  if (!result) return result.error();
  tell("storing the constants in the ESC");
  if (auto stored = store(bench, lines(result.value())); !stored) return stored.error();
  return result;
}

}  // namespace

int calibrate_esc_command(const CalibrateOptions& options, const Composition& composition) {
  const auto setup = calibrate::read_setup(options.file);
  if (!setup) return complain(setup.error());
  const auto result = calibrate_esc(setup.value(), composition);
  if (!result) return complain(result.error());
  const Calibration& c = result.value();

  const std::string name = fs::path(options.file).stem();
  const fs::path folder = fs::path(composition.results) / "calibrations" / name;
  std::error_code status;
  fs::create_directories(folder, status);
  const std::string constants = lua_file(c, options.command);
  const std::string page = (folder / "index.html").string();
  const std::string about = "Calibration of an ESC on the stand: " + options.command;
  std::vector<std::pair<std::string, std::string>> files = {
      {page, results::charts_html(name, about, charts(c))},
      {(folder / "constants.lua").string(), constants}};
  if (!options.write.empty()) files.emplace_back(options.write, constants);
  for (const auto& [path, text] : files) {
    if (const auto written = results::write_text(path, text); !written) {
      return complain(written.error());
    }
  }
  std::printf("%s", table(c).c_str());
  for (const auto& [path, text] : files) std::printf("%s\n", shown_path(path).c_str());
  return 0;
}

}  // namespace whirl::cli
