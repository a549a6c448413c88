// A file as one text.
//
//   Valid    plain files up to 64 MiB: a pipe or a device might never end
//   Errors   bad_input: no such file, a folder, no plain file, too large; host: the disk did not give it
#pragma once
#include <string>

#include "base/result.hpp"

namespace whirl {

Result<std::string> read_whole_file(const std::string& path);

}  // namespace whirl
