// Where the file is that a plan or a calibration names.
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl::cli {

struct Asker {
  std::string file;   // that names it
  std::string place;  // for the message
};

// "flight" -> build/firmware/flight.elf, in the first of these folders that has it; a path is taken as
// it is, or beside the asker. A bad_input error where nothing is there.
Result<std::string> find_file(const std::string& written, const Asker& who,
                              const std::vector<std::string>& folders,
                              const std::string& extension);

}  // namespace whirl::cli
