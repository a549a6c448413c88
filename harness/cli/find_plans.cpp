#include "harness/cli/find_plans.hpp"

#include <algorithm>
#include <filesystem>

#include "harness/plan/plan_file.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

bool is_data_folder(const fs::path& path) {
  const std::string name = path.filename().string();
  return name == "boards" || name == "vehicles" || name == "propellers" || name == "include" ||
         name == "calibrations";
}

void collect(const fs::path& folder, std::vector<std::string>& files) {
  std::error_code status;
  for (const auto& entry : fs::directory_iterator(folder, status)) {
    if (entry.is_directory()) {
      if (!is_data_folder(entry.path())) collect(entry.path(), files);
    } else if (entry.path().extension() == ".lua") {
      files.push_back(entry.path().string());
    }
  }
}

std::vector<std::string> plan_files(const RunOptions& options, const std::string& root,
                                    std::vector<Error>& errors) {
  std::vector<std::string> files;
  std::vector<std::string> paths = options.paths;
  if (paths.empty()) paths.push_back(root + "/test_plans");
  for (const std::string& path : paths) {
    // As given, or below the project's root, so that `whirl run test_plans/...` works anywhere.
    const std::string at = fs::exists(path) ? path : root + "/" + path;
    if (fs::is_directory(at)) {
      const std::size_t before = files.size();
      collect(at, files);
      if (files.size() == before) {
        errors.push_back({ErrorKind::bad_input, path, "holds no plan (*.lua)", ""});
      }
    } else if (fs::exists(at)) {
      files.push_back(at);
    } else {
      errors.push_back({ErrorKind::bad_input, path, "no such plan or folder", "see: whirl list"});
    }
  }
  for (std::string& file : files) file = shown_path(file);
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace

std::string shown_path(const std::string& path) {
  std::error_code status;
  const std::string near = fs::proximate(path, status).string();
  return !status && !near.starts_with("..") ? near : path;
}

FoundPlans find_plans(const RunOptions& options, const std::string& root) {
  FoundPlans found;
  for (const std::string& path : plan_files(options, root, found.errors)) {
    const auto file = plan::PlanFile::load(path);
    if (!file) {
      found.errors.push_back(file.error());
      continue;
    }
    for (const plan::Plan& p : file.value()->plans()) {
      if (!options.tag.empty() && !p.has_tag(options.tag)) continue;
      if (!options.only.empty() && p.name != options.only) continue;
      found.plans.push_back({path, p.name, p.tags, p.image, p.board, p.vehicle});
    }
  }
  if (found.plans.empty() && found.errors.empty()) {
    const std::string what =
        !options.only.empty() ? "name '" + options.only + "'" : "tag '" + options.tag + "'";
    found.errors.push_back(
        {ErrorKind::bad_input, "", "no plan has the " + what, "see: whirl list"});
  }
  return found;
}

}  // namespace whirl::cli
