#include "results/read_run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.hpp"

namespace whirl::results {
namespace {

using nlohmann::json;

double number(const json& value) {
  return value.is_null() ? std::nan("") : value.get<double>();
}

template <typename Word>
Word word_of(const json& value, std::initializer_list<Word> all) {
  for (const Word word : all) {
    if (value == name(word)) return word;
  }
  throw json::other_error::create(599, "'" + value.get<std::string>() + "' is no such word",
                                  &value);
}

Verdict verdict_of_word(const json& value) {
  return word_of(
      value, {Verdict::pass, Verdict::fail, Verdict::inconclusive, Verdict::error, Verdict::none});
}

Blame blame_of_word(const json& value) {
  return word_of(value,
                 {Blame::firmware, Blame::user, Blame::host, Blame::not_shown, Blame::harness});
}

void read_limit(const json& limit, Expectation& e) {
  if (limit.is_array()) {
    e.low = limit.at(0).get<double>();
    e.high = limit.at(1).get<double>();
  } else if (limit.is_number()) {
    const bool both = e.how == "equal" || e.how == "within";
    if (both || e.how == "at least") e.low = limit.get<double>();
    if (both || e.how != "at least") e.high = limit.get<double>();
  }
}

Expectation expectation(const json& from) {
  Expectation e;
  from.at("name").get_to(e.name);
  e.verdict = verdict_of_word(from.at("verdict"));
  from.at("how").get_to(e.how);
  e.measured = number(from.at("measured"));
  e.margin = number(from.at("margin"));
  from.at("unit").get_to(e.unit);
  from.at("note").get_to(e.note);
  from.at("place").get_to(e.place);
  from.at("signals").get_to(e.signals);
  from.at("from_s").get_to(e.from_s);
  from.at("to_s").get_to(e.to_s);
  from.at("level").get_to(e.level);
  for (const json& limit : from.at("limits_SI")) e.limits_SI.push_back(number(limit));
  read_limit(from.at("limit"), e);
  return e;
}

Report report_of(const json& from) {
  Report r;
  from.at("plan").get_to(r.plan);
  from.at("file").get_to(r.file);
  from.at("tags").get_to(r.tags);
  r.verdict = verdict_of_word(from.at("verdict"));
  r.blame = blame_of_word(from.at("blame"));
  from.at("reason").get_to(r.reason);
  for (const json& why : from.at("reasons")) {
    r.reasons.push_back({blame_of_word(why.at("blame")), why.at("what")});
  }
  from.at("seed").get_to(r.seed);
  from.at("digest").get_to(r.digest);
  from.at("virtual_s").get_to(r.virtual_s);
  from.at("host_s").get_to(r.host.total_s);
  for (const auto& [what, version] : from.at("versions").items()) {
    r.versions.emplace_back(what, version.get<std::string>());
  }
  for (const json& e : from.at("expectations")) r.expectations.push_back(expectation(e));
  for (const json& f : from.at("cpu_faults")) {
    r.cpu_faults.push_back({f.at("name"), f.at("where"), f.at("registers"), f.at("backtrace"),
                            f.at("t_s").get<double>()});
  }
  return r;
}

}  // namespace

Result<Report> read_run(std::string_view json_text) {
  const json run = parse_json(json_text);
  if (!run.is_object()) {
    return Error{ErrorKind::internal, "run.json", "is no object of JSON",
                 "it is cut off, or no run's"};
  }
  try {
    return report_of(run);
  } catch (const json::exception& e) {
    return Error{ErrorKind::internal, "run.json", e.what(), ""};
  }
}

}  // namespace whirl::results
