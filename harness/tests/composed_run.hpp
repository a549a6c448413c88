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

// The program's exit code. words: "whirl" is the first.
inline int run_words(const cli::Composition& composition, std::vector<std::string> words) {
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  return cli::run_program(static_cast<int>(argv.size()), argv.data(), composition);
}

inline nlohmann::json run_file(const std::string& results) {
  std::ifstream file(results + "/runs/latest/run.json");
  return nlohmann::json::parse(file);
}

// words: behind `whirl run`, one plan among them.
inline ComposedRun run_composed(const cli::Composition& composition,
                                std::vector<std::string> words) {
  words.insert(words.begin(), {"whirl", "run"});
  const int code = run_words(composition, std::move(words));
  return {code, run_file(composition.results)};
}

}  // namespace whirl
