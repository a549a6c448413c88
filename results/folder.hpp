// The folder of one run: RESULTS/runs/<time>-<plan>/ and the link `latest` beside it.
//
//   Files     messages.whirl (results/messages/message_file.hpp) and what is made of it: index.html,
//             truth.csv, bus.csv, telemetry.tlog (serial.txt where it is no MAVLink); of nodes with
//             names bus_NODE.csv and telemetry_NODE.tlog. run.json, junit.xml. The firmware's own logs
//             from the images of cards: flight.ulg, flight_2.ulg and so on
//   Name      from the host's clock; a second run within one second gets a number
//   Whole     it is written as .unfinished-..., and gets its name by one rename when all is in it. A
//             run that was interrupted ends in "-interrupted", one that lost a file in "-incomplete".
//   Lost      a file that cannot be written is removed (it would be half), the others are still
//             written, and the loss is a reason in the report (see verdict.hpp)
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"
#include "results/messages/message_file.hpp"
#include "results/report.hpp"
#include "results/sinks/curves.hpp"

namespace whirl::results {

// What a plan's name is in the names of files.
std::string file_name(const std::string& plan);

class RunFolder {
 public:
  static Result<RunFolder> create(const std::string& results_root, const std::string& plan);
  ~RunFolder();  // an empty one is removed; any other stays, unfinished, for who looks
  RunFolder(RunFolder&& other) noexcept;
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string messages() const { return file("messages.whirl"); }
  const std::string& path() const { return path_; }
  // Gives it its name and points `latest` at it. Returns the path.
  Result<std::string> publish(const std::string& mark);

 private:
  RunFolder(std::string runs, std::string name);

  std::string runs_, name_, path_;
};

// All files but those that need the whole history. What is lost becomes a reason of the report, which
// is concluded anew; false then. Fills Report::host.results_s before run.json.
bool write_run(const RunFolder& folder, Report& report, MessageWriter& messages);

// Of a run that was refused before it began: run.json, junit.xml and the page with the reason.
bool write_refusal(const RunFolder& folder, Report& report);

// The parts, for tests and for --json.
std::string run_json(const Report& report);
std::string junit_xml(const std::vector<const Report*>& reports);
std::string page_html(const Report& report, const Curves& curves);

}  // namespace whirl::results
