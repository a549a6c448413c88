// whirl validate --timing: both timing images on the virtual board, or a board's own lines.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/output_file.hpp"
#include "base/places.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/page_command.hpp"
#include "harness/timing/capture.hpp"
#include "harness/timing/judge.hpp"
#include "results/charts.hpp"
#include "results/folder.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;
using timing::Grade;
using timing::Verdict;

struct Subject {
  const char* part;  // as the image and the table name it
  const char* image;
  std::uint16_t uart;
};
// Of both the board's file is called like the image.
constexpr Subject kSubjects[] = {{"stm32f405", "timing_f405", 2}, {"stm32f103", "timing_f103", 1}};

struct Judged {
  std::string part;
  bool complete = true;
  std::vector<Verdict> verdicts;
};

Result<std::string> run_image(const Subject& subject, const Composition& composition) {
  const std::string& root = composition.root;
  const Asker who{"--timing", "--timing"};
  const auto image = find_file(subject.image, who, image_folders(root), ".elf");
  if (!image) return image.error();
  const auto board = read_board(root + "/test_plans/boards/" + subject.image + ".lua");
  if (!board) return board.error();
  const plan::Plan plan = plan::plan_of_one_board("timing", "--timing");
  const auto target = composition.target({plan, 0, board.value(), root, image.value(), ""});
  if (!target) return target.error();
  return timing::capture(*target.value(), subject.uart);
}

fs::path validation_folder(const std::string& results_folder) {
  const fs::path folder = fs::path(results_folder) / "validation";
  std::error_code status;  // a folder that is not there is told when a file is to be written
  fs::create_directories(folder, status);
  return folder;
}

// The lines are kept as they came, to be judged again, or beside those of a physical board.
Result<std::vector<timing::Report>> measure(const Composition& composition) {
  std::vector<timing::Report> reports;
  for (const Subject& subject : kSubjects) {
    const auto text = run_image(subject, composition);
    if (!text) return text.error();
    const fs::path kept =
        validation_folder(composition.results) / (std::string(subject.image) + ".txt");
    if (auto good = write_text(kept.string(), text.value()); !good) return good.error();
    auto read = timing::read_reports(text.value(), subject.image);
    if (!read) return read.error();
    for (timing::Report& report : read.value()) reports.push_back(std::move(report));
  }
  return reports;
}

Result<Judged> judged(const timing::Report& report, const std::string& root) {
  for (const Subject& subject : kSubjects) {
    if (report.part != subject.part) continue;
    const std::string path = root + "/io_bridges/qemu/data/timing_" + report.part + ".txt";
    const auto text = read_whole_file(path);
    if (!text) return text.error();
    const auto table = timing::read_expectations(text.value(), path);
    if (!table) return table.error();
    return Judged{report.part, report.complete, timing::judge(table.value(), report)};
  }
  return Error{ErrorKind::bad_input, "--timing",
               "no table for a part '" + printable_line(report.part) + "'",
               "stm32f405 and stm32f103 have one"};
}

std::string range_text(const timing::Expectation& e) {
  if (!(e.high_cycles > 0.0)) return "-";
  char text[64];
  if (e.low_cycles == e.high_cycles) {
    std::snprintf(text, sizeof text, "%.4g", e.low_cycles);
  } else {
    std::snprintf(text, sizeof text, "%.4g .. %.4g", e.low_cycles, e.high_cycles);
  }
  return text;
}

void print(const Judged& part) {
  std::printf("%s\n  %-34s %-3s %-15s %9s %8s  %s\n", printable_line(part.part).c_str(),
              "kernel, cycles per iteration", "WS", "expected", "measured", "error", "");
  std::string section;
  for (const Verdict& v : part.verdicts) {
    if (v.expected.section != section) std::printf(" %s\n", v.expected.section.c_str());
    section = v.expected.section;
    std::printf("  %-34s %-3u %-15s ", printable_line(v.expected.kernel).c_str(),
                v.expected.wait_states, range_text(v.expected).c_str());
    if (v.grade == Grade::missing) {
      std::printf("%9s %8s", "-", "-");
    } else if (v.grade == Grade::unknown || v.grade == Grade::reported) {
      std::printf("%9.4g %8s", v.measured_cycles, "-");
    } else {
      std::printf("%9.4g %+7.1f%%", v.measured_cycles, 100.0 * v.error);
    }
    std::printf("  %s\n", timing::name_of(v.grade));
  }
}

// A chart per section: the ends of the ranges and what was measured, kernel by kernel.
std::vector<results::Chart> charts_of(const Judged& part) {
  std::vector<results::Chart> charts;
  for (const Verdict& v : part.verdicts) {
    const timing::Expectation& e = v.expected;
    const std::string title = e.section.empty() ? "Not in the table" : e.section;
    if (charts.empty() || charts.back().title != title) {
      charts.push_back(
          {part.part,
           title,
           "kernel, in the order of the rows below",
           "cycles per iteration",
           "",
           "",
           {{"least", {}, {}, true}, {"most", {}, {}, true}, {"measured", {}, {}, false}},
           {}});
    }
    results::Chart& chart = charts.back();
    const auto place = static_cast<double>(chart.figures.size());
    const bool there = v.grade != Grade::missing;
    const double ends[] = {e.low_cycles, e.high_cycles, v.measured_cycles};
    for (std::size_t i = 0; i < chart.curves.size(); ++i) {
      if (i < 2 ? !(e.high_cycles > 0.0) : !there) continue;
      chart.curves[i].x.push_back(place);
      chart.curves[i].y.push_back(ends[i]);
    }
    results::ChartFigure figure;
    char measured[48];
    std::snprintf(measured, sizeof measured, there ? "%.4g" : "nothing", v.measured_cycles);
    figure.name = e.kernel + ", " + std::to_string(e.wait_states) + " WS: measured " + measured +
                  ", expected " + range_text(e) + " cycles" +
                  (e.derivation.empty() ? "" : "; " + e.derivation + " [" + e.source + "]");
    figure.measured = there ? 100.0 * v.error : std::nan("");
    figure.unit = "% off";
    if (v.grade != Grade::reported) figure.limit = 100.0 * timing::kWithin;
    figure.ok = v.grade == Grade::within || v.grade == Grade::reported;
    chart.figures.push_back(std::move(figure));
  }
  return charts;
}

Result<std::string> write_page(const std::vector<Judged>& parts,
                               const std::string& results_folder) {
  std::vector<results::Chart> charts;
  for (const Judged& part : parts) {
    for (results::Chart& chart : charts_of(part)) charts.push_back(std::move(chart));
  }
  const std::string path = (validation_folder(results_folder) / "timing.html").string();
  const auto written = write_text(
      path,
      results::charts_html(
          "Cycles of instructions",
          "Measured by the cycle counter (DWT_CYCCNT) within the timing images, against what the "
          "manuals give; a range of theirs is a range here, and the error is the distance from its "
          "nearer end. Keys are resolved in io_bridges/qemu/REFERENCES.md.",
          charts));
  if (!written) return written.error();
  return path;
}

bool print_score(const Judged& part) {
  const timing::Score score = timing::score_of(part.verdicts);
  std::printf("%s: %d of %d within 10 %%, %d more within 15 %%; mean error %.1f %%\n",
              printable_line(part.part).c_str(), score.within, score.judged, score.outer,
              100.0 * score.mean_error);
  for (const Verdict& v : part.verdicts) {
    if (v.grade != Grade::missing && v.grade != Grade::unknown) continue;
    std::printf("  %s: %s\n", printable_line(v.expected.kernel).c_str(), timing::name_of(v.grade));
  }
  if (!part.complete) std::printf("  the report is cut short, or lines of it are lost\n");
  return part.complete && score.within == score.judged;
}

}  // namespace

int timing_command(const TimingOptions& options, const Composition& composition) {
  Result<std::vector<timing::Report>> reports = std::vector<timing::Report>{};
  if (options.file.empty()) {
    reports = measure(composition);
  } else {
    const auto text = read_whole_file(options.file);
    if (!text) return complain(text.error());
    reports = timing::read_reports(text.value(), options.file);
  }
  if (!reports) return complain(reports.error());
  std::vector<Judged> parts;
  for (const timing::Report& report : reports.value()) {
    auto part = judged(report, composition.root);
    if (!part) return complain(part.error());
    parts.push_back(std::move(part.value()));
  }
  for (const Judged& part : parts) print(part);
  const auto page = write_page(parts, composition.results);
  if (!page) return complain(page.error());
  bool good = true;
  for (const Judged& part : parts) good = print_score(part) && good;
  std::printf("%s\n", shown_path(page.value()).c_str());
  return good ? 0 : 1;
}

}  // namespace whirl::cli
