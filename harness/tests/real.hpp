// What tests of the program on real images share: they run it as a user does, and read what it left.
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.hpp"
#include "base/scratch_folder.hpp"

namespace whirl::real {

struct Outcome {
  int code = -1;
  std::string text;    // both outputs
  nlohmann::json run;  // run.json of --json; discarded where there is none
};

class Real : public ::testing::Test {
 protected:
  Real() { setenv("WHIRL_RESULTS", folder_.file("results").c_str(), 1); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.file(name), std::ios::binary) << text;
  }
  // A plan of one second on this image.
  Outcome run(const std::string& image, const std::string& body,
              const std::string& vehicle = "hp_quad") const {
    write("p.lua", "plan \"real\" { image = \"" + image + "\", vehicle = \"" + vehicle +
                       "\", timeout = \"3 s\",\nrun = function(t)\n" + body + "\nend }\n");
    return whirl("run --json " + folder_.file("p.lua"));
  }
  static Outcome whirl(const std::string& arguments) {
    std::FILE* pipe = popen((std::string(WHIRL_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
    Outcome outcome;
    char piece[4096];
    for (std::size_t n; (n = std::fread(piece, 1, sizeof piece, pipe)) > 0;) {
      outcome.text.append(piece, n);
    }
    const int status = pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const auto brace = outcome.text.find('{');
    outcome.run = parse_json(brace == std::string::npos ? "" : outcome.text.substr(brace));
    return outcome;
  }

  ScratchFolder folder_;
};

inline constexpr const char* kSecond =
    "t:wait \"1 s\" t:expect(t:value \"tilt\"):at_most \"1 rad\"";

inline void expect_told(const Outcome& outcome, int code, const std::string& words) {
  EXPECT_EQ(outcome.code, code) << outcome.text;
  EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
}

}  // namespace whirl::real
