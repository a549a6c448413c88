// Where whirl's own files are: found from where the program stands, so that nothing of a checkout's
// path is compiled in, and a copy uses its own.
//
//   Checkout   ROOT/build/.../harness/whirl, its boards in ROOT/test_plans, images in ROOT/build/firmware
//   Installed  PREFIX/bin/whirl, PREFIX/lib/whirl/whirl_board.so, all else in PREFIX/share/whirl
//   Elsewhere  WHIRL_ROOT in the environment names the root (for a build folder outside the checkout)
#pragma once
#include <string>
#include <vector>

#include "base/result.hpp"

namespace whirl {

struct Places {
  std::string root;     // has test_plans/ and plant/data/
  std::string plugin;   // whirl_board.so
  std::string results;  // where runs go unless told otherwise
};

// `wanted_root`: instead of looking for it; empty: look.
Result<Places> find_places(const std::string& program, const std::string& wanted_root);
std::string own_program();  // the path of this process's program
// Of this process: its program and WHIRL_ROOT.
const Result<Places>& places();

std::vector<std::string> image_folders(const std::string& root);
std::string polar_folder();  // "" where there are no places

}  // namespace whirl
