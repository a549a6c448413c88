// Who took part in a run: versions and hashes, so that two runs can be told apart by their cause.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace whirl::cli {

using Versions = std::vector<std::pair<std::string, std::string>>;

// Files by role ("image", "plan"): their name and an FNV-1a 64 of their bytes.
void add_files(Versions& versions, const Versions& files);
// whirl itself (with the commit of its sources, where git knows it), host compiler, CPU, kernel.
void add_host(Versions& versions, const std::string& root);

}  // namespace whirl::cli
