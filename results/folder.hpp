// The folder of one run: results/runs/<time>-<plan>/ and the link `latest` beside it.
//
//   Files   run.json, junit.xml, index.html, truth.csv, bus.csv, telemetry.tlog
//   Name    from the host's clock; a second run within one second gets a number
#pragma once
#include <string>
#include <vector>

#include "harness/base/result.hpp"
#include "results/event_log.hpp"
#include "results/report.hpp"
#include "results/truth_log.hpp"

namespace whirl::results {

Result<std::string> make_run_folder(const std::string& results_root, const std::string& plan);

// All files but those that need the whole history. Fills Report::host.results_s before run.json.
Result<Done> write_run(const std::string& folder, Report& report, const TruthLog& truth,
                       const EventLog& events);

// The parts, for tests and for --json.
std::string run_json(const Report& report);
std::string junit_xml(const std::vector<const Report*>& reports);
std::string page_html(const Report& report, const TruthLog& truth);

Result<Done> write_text(const std::string& path, const std::string& text);

}  // namespace whirl::results
