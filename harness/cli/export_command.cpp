#include "harness/cli/export_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "base/places.hpp"
#include "harness/cli/console.hpp"
#include "results/sinks/replay.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

std::string word_list(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

std::vector<results::SinkType> wanted(const std::vector<std::string>& formats) {
  std::vector<results::SinkType> types;
  for (const results::SinkType& type : results::sink_types()) {
    const bool asked = std::find(formats.begin(), formats.end(), type.format) != formats.end();
    if (asked) types.push_back(type);
  }
  return types;
}

Result<std::string> folder_for(const std::string& out, const std::string& messages) {
  if (out.empty()) {
    const fs::path folder = fs::path(messages).parent_path();
    return folder.empty() ? std::string(".") : folder.string();
  }
  std::error_code status;
  fs::create_directories(out, status);
  if (!status) return out;
  return Error{ErrorKind::bad_input, out, "no folder for the files: " + status.message(), ""};
}

}  // namespace

std::vector<std::string> export_formats() {
  std::vector<std::string> formats;
  for (const results::SinkType& type : results::sink_types()) {
    if (std::find(formats.begin(), formats.end(), type.format) == formats.end()) {
      formats.emplace_back(type.format);
    }
  }
  return formats;
}

int export_command(const ExportOptions& options) {
  if (options.formats.empty()) {
    std::vector<std::string> flags = export_formats();
    for (std::string& flag : flags) flag.insert(0, "--");
    return complain({ErrorKind::bad_input, "", "whirl export: no format is asked for",
                     "say one: " + word_list(flags)});
  }
  std::error_code ignored;
  const std::string messages = fs::is_directory(options.run, ignored)
                                   ? (fs::path(options.run) / "messages.whirl").string()
                                   : options.run;
  const auto folder = folder_for(options.out, messages);
  if (!folder) return complain(folder.error());
  const std::vector<results::SinkType> types = wanted(options.formats);
  // What the run itself has made of it is better than what damage has left.
  const auto damaged = options.out.empty() ? results::Damaged::drop : results::Damaged::keep;
  auto done = results::replay(messages, folder.value(), types, {}, damaged);
  if (!done) return complain(done.error());
  if (done.value().damage && damaged == results::Damaged::drop) {
    done.value().damage->cure = "nothing was written; --out FOLDER takes what is before that";
    return complain(*done.value().damage);
  }
  int code = 0;
  for (const Error& lost : done.value().lost) code = complain(lost);
  if (done.value().damage) code = complain(*done.value().damage);
  std::vector<std::string> made;
  made.reserve(types.size());
  for (const results::SinkType& type : types) made.emplace_back(type.makes);
  std::printf("%s: %.9g s of %s%s\n", shown_path(folder.value()).c_str(),
              static_cast<double>(done.value().end_ns) * 1e-9, word_list(made).c_str(),
              done.value().lost.empty() ? "" : ", but for those above");
  if (!done.value().whole && !done.value().damage) {
    std::fprintf(stderr, "whirl: the run was cut off there: the files end with it\n");
  }
  return code;
}

}  // namespace whirl::cli
