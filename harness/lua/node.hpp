// The tree behind Table: what a Lua value is once Lua is gone. Internal to harness/lua and plan.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/lua/table.hpp"

struct lua_State;

namespace whirl::lua {

struct Node {
  enum class Type { boolean, integer, real, text, table } type = Type::table;
  bool flag = false;
  std::int64_t integer = 0;
  double real = 0.0;
  std::string text;
  std::map<std::string, std::unique_ptr<Node>, std::less<>> fields;
  std::vector<std::unique_ptr<Node>> list;
  std::string path;                                  // "frame.arm", "devices[2].name"
  mutable bool asked = false;                        // somebody read it
  mutable std::set<std::string, std::less<>> known;  // the keys that were asked for in it
};

struct Document {
  std::string file;
  std::string source;      // empty: no line is searched for (a plan's own tables)
  std::string call_place;  // instead of the file, where the source is empty: "hover.lua:12"
  Node root;
  std::optional<Error> first;
};

// The table at `index` of the stack as a tree. Functions and other things that are no data are
// refused; so is a table that contains itself. The document may then outlive the state.
Result<std::shared_ptr<Document>> tree_from_stack(lua_State* L, int index, std::string file,
                                                  std::string source, std::string call_place);

}  // namespace whirl::lua
