// Which of t's calls stand in a stretch of Lua source: "t:budget(...)" is a call of `budget`.
//
//   Found    name and line of each ":name" that is followed by (, {, a text or a function
//   Not      comments and texts; what is called by another name, or from another file
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace whirl::plan {

struct SourceCall {
  std::string name;
  int line = 0;  // the first one is 1
};

std::vector<SourceCall> source_calls(std::string_view source, int first_line, int last_line);

// All names and texts of the stretch: a signal is read as s.speed_radps or as "speed".
std::vector<SourceCall> source_words(std::string_view source, int first_line, int last_line);

}  // namespace whirl::plan
