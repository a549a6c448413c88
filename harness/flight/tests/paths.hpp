// Where the data files of the tree are, for tests: the build tells.
#pragma once

namespace whirl::flight {

inline constexpr const char* kSourceFolder = WHIRL_SOURCE_FOLDER;

}  // namespace whirl::flight
