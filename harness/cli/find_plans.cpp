#include "harness/cli/find_plans.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>

#include "harness/plan/plan_file.hpp"

namespace whirl::cli {
namespace {

namespace fs = std::filesystem;

bool is_data_folder(const fs::path& path) {
  static const std::set<std::string> kNames = {"batteries",    "benches", "boards",
                                               "calibrations", "include", "motors",
                                               "propellers",   "sticks",  "vehicles"};
  return kNames.count(path.filename().string()) != 0;
}

// The plan files below a folder; each folder once, however many links lead to it.
class Collection {
 public:
  void add_folder(const fs::path& folder) {
    struct stat status {};
    if (stat(folder.c_str(), &status) != 0) return refuse(folder, std::strerror(errno));
    if (!seen_.insert({status.st_dev, status.st_ino}).second) return;
    std::error_code failed;
    fs::directory_iterator entries(folder, failed);
    for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
      add_entry(entries->path());
    }
    if (failed) refuse(folder, failed.message());
  }
  void add_file(const fs::path& path) { files.push_back(path.string()); }
  void refuse(const fs::path& path, const std::string& why) {
    errors.push_back(
        {ErrorKind::bad_input, shown_path(path.string()), "cannot be read: " + why, ""});
  }

  std::vector<std::string> files;
  std::vector<Error> errors;

 private:
  void add_entry(const fs::path& path) {
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (fs::is_directory(status)) {
      if (!is_data_folder(path)) add_folder(path);
    } else if (path.extension() == ".lua") {
      if (fs::is_regular_file(status)) return add_file(path);
      refuse(path, failed ? failed.message() : "it is no regular file");
    }
  }

  std::set<std::pair<dev_t, ino_t>> seen_;
};

void add_path(Collection& found, const std::string& path, const std::string& root) {
  // As given, or below the project's root, so that `whirl run test_plans/...` works anywhere.
  std::error_code failed;
  const std::string at = fs::exists(path, failed) ? path : root + "/" + path;
  const fs::file_status status = fs::status(at, failed);
  const std::size_t before = found.files.size() + found.errors.size();
  if (fs::is_directory(status)) {
    found.add_folder(at);
    if (found.files.size() + found.errors.size() == before) {
      found.errors.push_back({ErrorKind::bad_input, path, "holds no plan (*.lua)", ""});
    }
  } else if (fs::is_regular_file(status)) {
    found.add_file(at);
  } else if (status.type() == fs::file_type::not_found || status.type() == fs::file_type::none) {
    found.errors.push_back(
        {ErrorKind::bad_input, path, "no such plan or folder", "see: whirl list"});
  } else {
    found.refuse(path, "it is no regular file");
  }
}

std::vector<std::string> plan_files(const RunOptions& options, const std::string& root,
                                    std::vector<Error>& errors) {
  Collection found;
  std::vector<std::string> paths = options.paths;
  if (paths.empty()) paths.push_back(root + "/test_plans");
  for (const std::string& path : paths) add_path(found, path, root);
  for (std::string& file : found.files) file = shown_path(file);
  std::sort(found.files.begin(), found.files.end());
  found.files.erase(std::unique(found.files.begin(), found.files.end()), found.files.end());
  errors = std::move(found.errors);
  return std::move(found.files);
}

}  // namespace

std::string shown_path(const std::string& path) {
  std::error_code status;
  const std::string near = fs::proximate(path, status).string();
  return !status && !near.starts_with("..") ? near : path;
}

namespace {

std::string images_of(const plan::Plan& plan) {
  std::string all;
  for (const plan::PlanNode& node : plan.nodes) all += (all.empty() ? "" : "+") + node.image;
  return all;
}

// Each plan on each seed, a plan's runs one after the other.
std::vector<PlanChoice> on_seeds(std::vector<PlanChoice> plans,
                                 const std::vector<std::uint64_t>& seeds) {
  if (seeds.empty()) return plans;
  std::vector<PlanChoice> all;
  all.reserve(plans.size() * seeds.size());
  for (const PlanChoice& plan : plans) {
    for (const std::uint64_t seed : seeds) {
      all.push_back(plan);
      all.back().seed = seed;
    }
  }
  return all;
}

}  // namespace

FoundPlans find_plans(const RunOptions& options, const std::string& root) {
  FoundPlans found;
  for (const std::string& path : plan_files(options, root, found.errors)) {
    const auto file = plan::PlanFile::load(path, {}, options.settings);
    if (!file) {
      found.errors.push_back(file.error());
      continue;
    }
    for (const plan::Plan& p : file.value()->plans()) {
      if (!options.tag.empty() && !p.has_tag(options.tag)) continue;
      if (!options.only.empty() && p.name != options.only) continue;
      found.plans.push_back(
          {path, p.name, p.tags, images_of(p), p.vehicle, p.timeout_ns, options.seed});
    }
  }
  found.plans = on_seeds(std::move(found.plans), options.seeds);
  if (found.plans.empty() && found.errors.empty()) {
    const std::string what =
        !options.only.empty() ? "name '" + options.only + "'" : "tag '" + options.tag + "'";
    found.errors.push_back(
        {ErrorKind::bad_input, "", "no plan has the " + what, "see: whirl list"});
  }
  return found;
}

}  // namespace whirl::cli
