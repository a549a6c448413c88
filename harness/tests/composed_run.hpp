// The whole program run in this process, put together by the test, and what its run has left.
#pragma once
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/cli/composition.hpp"

namespace whirl {

struct ComposedRun {
  int code = -1;        // the program's exit code
  nlohmann::json file;  // run.json
  std::map<std::string, double> figures() const {
    std::map<std::string, double> all;
    for (const auto& e : file["expectations"]) all[e["name"]] = e["measured"];
    return all;
  }
};

// words: behind `whirl run`, one plan among them.
inline ComposedRun run_composed(const cli::Composition& composition,
                                std::vector<std::string> words) {
  words.insert(words.begin(), {"whirl", "run"});
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  ComposedRun run;
  run.code = cli::run_program(static_cast<int>(argv.size()), argv.data(), composition);
  std::ifstream file(composition.results + "/runs/latest/run.json");
  run.file = nlohmann::json::parse(file);
  return run;
}

}  // namespace whirl
