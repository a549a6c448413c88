// whirl doctor: is everything here that a run needs, and if not, how to get it.
#pragma once
#include <string>

namespace whirl::cli {

// Prints a line for each; 0 if nothing is missing, 2 otherwise.
int doctor_command(const std::string& root);

}  // namespace whirl::cli
