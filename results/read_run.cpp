#include "results/read_run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "base/json_text.hpp"

namespace whirl::results {
namespace {

using nlohmann::json;

// What is wrong, and at which key: "expectations[2].measured".
struct WrongValue {
  std::string key, what;
};

template <typename T>
bool fits(const json& value) {
  if constexpr (std::is_same_v<T, std::string>) return value.is_string();
  if constexpr (std::is_same_v<T, bool>) return value.is_boolean();
  if constexpr (std::is_unsigned_v<T>) return value.is_number_unsigned();
  return value.is_number();
}

template <typename T>
const char* word_for() {
  if constexpr (std::is_same_v<T, std::string>) return "a text";
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_unsigned_v<T>) return "a whole number";
  return "a number";
}

const json& at(const json& from, const std::string& key) {
  if (!from.is_object()) throw WrongValue{"", "is of type " + std::string(from.type_name())};
  const auto found = from.find(key);
  if (found == from.end()) throw WrongValue{key, "is missing"};
  return *found;
}

template <typename T>
T as(const json& value, const std::string& key) {
  if (fits<T>(value)) return value.get<T>();
  throw WrongValue{key, std::string("is of type ") + value.type_name() + ", and " + word_for<T>() +
                            " is wanted"};
}

template <typename T>
T get(const json& from, const std::string& key) {
  return as<T>(at(from, key), key);
}

// NaN where it is null: what could not be measured.
double number(const json& value, const std::string& key) {
  return value.is_null() ? std::nan("") : as<double>(value, key);
}

// Each element of a list, with its own key. `read` is given the element and that key.
template <typename Read>
void each(const json& from, const std::string& key, Read read) {
  const json& list = at(from, key);
  if (!list.is_array()) {
    throw WrongValue{key, std::string("is of type ") + list.type_name() + ", and a list is wanted"};
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    read(list[i], key + "[" + std::to_string(i) + "]");
  }
}

// Keys within an element are told behind its own.
template <typename Read>
auto within(const std::string& key, Read read) {
  try {
    return read();
  } catch (const WrongValue& wrong) {
    throw WrongValue{key + (wrong.key.empty() ? "" : "." + wrong.key), wrong.what};
  }
}

std::vector<std::string> texts(const json& from, const std::string& key) {
  std::vector<std::string> all;
  each(from, key, [&](const json& text, const std::string& own) {
    all.push_back(as<std::string>(text, own));
  });
  return all;
}

template <typename Word>
Word word_of(const json& from, const char* key, std::initializer_list<Word> all) {
  const auto text = get<std::string>(from, key);
  for (const Word word : all) {
    if (text == name(word)) return word;
  }
  throw WrongValue{key, "'" + text + "' is no such word"};
}

Verdict read_verdict(const json& from) {
  return word_of(
      from, "verdict",
      {Verdict::pass, Verdict::fail, Verdict::inconclusive, Verdict::error, Verdict::none});
}

Blame read_blame(const json& from) {
  return word_of(from, "blame",
                 {Blame::firmware, Blame::user, Blame::host, Blame::not_shown, Blame::harness});
}

void read_limit(const json& from, Expectation& e) {
  const json& limit = at(from, "limit");
  if (limit.is_array()) {
    if (limit.size() != 2) throw WrongValue{"limit", "has not two numbers"};
    e.low = as<double>(limit[0], "limit[0]");
    e.high = as<double>(limit[1], "limit[1]");
  } else if (!limit.is_null()) {
    const double value = as<double>(limit, "limit");
    const bool both = e.how == "equal" || e.how == "within";
    if (both || e.how == "at least") e.low = value;
    if (both || e.how != "at least") e.high = value;
  }
}

Expectation expectation(const json& from) {
  Expectation e;
  e.name = get<std::string>(from, "name");
  e.verdict = read_verdict(from);
  e.how = get<std::string>(from, "how");
  e.measured = number(at(from, "measured"), "measured");
  e.margin = number(at(from, "margin"), "margin");
  e.unit = get<std::string>(from, "unit");
  e.note = get<std::string>(from, "note");
  e.place = get<std::string>(from, "place");
  e.signals = texts(from, "signals");
  e.from_s = get<double>(from, "from_s");
  e.to_s = get<double>(from, "to_s");
  e.level = get<bool>(from, "level");
  each(from, "limits_SI", [&](const json& limit, const std::string& key) {
    e.limits_SI.push_back(number(limit, key));
  });
  read_limit(from, e);
  return e;
}

CpuFaultRow cpu_fault(const json& from) {
  return {get<std::string>(from, "name"), get<std::string>(from, "where"),
          get<std::string>(from, "registers"), get<std::string>(from, "backtrace"),
          get<double>(from, "t_s")};
}

Report report_of(const json& from) {
  Report r;
  r.plan = get<std::string>(from, "plan");
  r.file = get<std::string>(from, "file");
  r.tags = texts(from, "tags");
  r.verdict = read_verdict(from);
  r.blame = read_blame(from);
  r.reason = get<std::string>(from, "reason");
  each(from, "reasons", [&](const json& why, const std::string& key) {
    within(key, [&] { r.reasons.push_back({read_blame(why), get<std::string>(why, "what")}); });
  });
  if (from.contains("doubts")) r.doubts = texts(from, "doubts");  // older runs have none
  r.seed = get<std::uint64_t>(from, "seed");
  r.digest = get<std::string>(from, "digest");
  r.virtual_s = get<double>(from, "virtual_s");
  r.host.total_s = get<double>(from, "host_s");
  within("versions", [&] {
    const json& versions = at(from, "versions");
    if (!versions.is_object()) throw WrongValue{"", "is no table"};
    for (const auto& [what, version] : versions.items()) {
      r.versions.emplace_back(what, as<std::string>(version, what));
    }
  });
  each(from, "expectations", [&](const json& e, const std::string& key) {
    r.expectations.push_back(within(key, [&] { return expectation(e); }));
  });
  each(from, "cpu_faults", [&](const json& f, const std::string& key) {
    r.cpu_faults.push_back(within(key, [&] { return cpu_fault(f); }));
  });
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
  } catch (const WrongValue& wrong) {
    return Error{ErrorKind::internal, "run.json", wrong.key + " " + wrong.what,
                 "it is of another version, or was changed by hand"};
  }
}

}  // namespace whirl::results
