// Plans as text, run by the whole program against the fakes.
#pragma once
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json_text.hpp"
#include "harness/tests/fake.hpp"

namespace whirl::test {

using nlohmann::json;

inline std::string plan_text(const std::string& body, const std::string& image = "flight",
                             const std::string& more = "") {
  return "plan \"p\" { image = \"" + image + "\", vehicle = \"hp_quad\", timeout = \"5 s\", " +
         more + "\n run = function(t)\n" + body + "\n end }\n";
}

struct Ran {
  Outcome outcome;
  json run;  // run.json; null where there is none
};

inline Ran run_plan(const std::string& text, std::vector<std::string> more = {}) {
  FakeRoot root;
  root.write("test_plans/p.lua", text);
  std::vector<std::string> words{"run", root.path() + "/test_plans/p.lua"};
  words.insert(words.end(), more.begin(), more.end());
  Ran ran{whirl(root, words), nullptr};
  const std::string file = root.read("results/runs/latest/run.json");
  if (!file.empty()) ran.run = parse_json(file);
  return ran;
}

inline const json& expectation(const json& run, const std::string& name) {
  static const json kNone;
  for (const json& e : run["expectations"]) {
    if (e["name"] == name) return e;
  }
  ADD_FAILURE() << "no expectation called " << name << " in " << text_of(run["expectations"], 1);
  return kNone;
}

}  // namespace whirl::test
