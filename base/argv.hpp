// Words as execv() and posix_spawn() want them: pointers into `words`, closed by a null.
#pragma once
#include <string>
#include <vector>

namespace whirl {

inline std::vector<char*> argv_of(std::vector<std::string>& words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

}  // namespace whirl
