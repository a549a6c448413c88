// Where a key of a data file stands: the line of a path like "devices[2].params.rate" in a file that
// ends in `return { ... }`. Lua itself keeps no lines of a table's keys.
//
//   Nested  a path that the constructor does not spell out (a table that a function made, a key that
//           is missing) has the line of the innermost part of it that is there
#pragma once
#include <string_view>

namespace whirl::lua {

struct SourcePlace {
  int line = 0;        // from 1; 0: nothing of the path is there
  bool exact = false;  // the whole path
};

SourcePlace place_in_source(std::string_view source, std::string_view path);

}  // namespace whirl::lua
