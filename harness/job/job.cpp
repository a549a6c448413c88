#include "harness/job/job.hpp"

#include <nlohmann/json.hpp>

#include "base/json_text.hpp"

namespace whirl {
namespace {

using nlohmann::json;

template <typename T, typename Read>
Result<T> read_object(std::string_view text, const char* what, Read read) {
  const json object = parse_json(text);
  T value;
  try {
    read(object, value);  // throws where a key is missing or of another type
  } catch (const json::exception& e) {
    return Error{ErrorKind::internal, what, e.what(), ""};
  }
  return value;
}

}  // namespace

std::string job_text(const Job& job) {
  json settings = json::array();
  for (const Setting& s : job.settings) settings.push_back({{"key", s.key}, {"value", s.value}});
  return text_of(json{{"file", job.file},
                      {"plan", job.plan},
                      {"seed", job.seed ? json(*job.seed) : json(nullptr)},
                      {"set", settings},
                      {"results", job.results},
                      {"keep", job.keep},
                      {"twice", job.twice},
                      {"calibrations", job.calibrations}});
}

Result<Job> read_job(std::string_view text) {
  return read_object<Job>(text, "job", [](const json& object, Job& job) {
    object.at("file").get_to(job.file);
    object.at("plan").get_to(job.plan);
    if (!object.at("seed").is_null()) job.seed = object.at("seed").get<std::uint64_t>();
    for (const json& s : object.at("set")) job.settings.push_back({s.at("key"), s.at("value")});
    object.at("results").get_to(job.results);
    object.at("keep").get_to(job.keep);
    object.at("twice").get_to(job.twice);
    object.at("calibrations").get_to(job.calibrations);
  });
}

// File names may be any bytes: what is no UTF-8 is replaced, and is only shown.
std::string job_report_text(const JobReport& report) {
  return text_of(json{{"exit_code", report.exit_code},
                      {"folder", report.folder},
                      {"outcome", report.outcome},
                      {"run", report.run}},
                 -1, NoUtf8::replace);
}

Result<JobReport> read_job_report(std::string_view text) {
  return read_object<JobReport>(text, "report of a job", [](const json& object, JobReport& report) {
    object.at("exit_code").get_to(report.exit_code);
    object.at("folder").get_to(report.folder);
    object.at("outcome").get_to(report.outcome);
    object.at("run").get_to(report.run);
  });
}

}  // namespace whirl
