// whirl export: other formats of a run's messages, also of a run that was cut off.
#pragma once
#include <string>
#include <vector>

namespace whirl::cli {

struct ExportOptions {
  std::string run;                   // its folder, or its messages.whirl
  std::vector<std::string> formats;  // of results::sink_types()
  std::string out;                   // where the files go; empty: into the run's folder
};

std::vector<std::string> export_formats();  // "csv", each once

// Exit code 0: all files are whole.
int export_command(const ExportOptions& options);

}  // namespace whirl::cli
