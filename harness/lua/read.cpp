// From a Lua value to a tree that no longer needs Lua.
#include <lua.hpp>

#include "base/text.hpp"
#include "base/whole_file.hpp"
#include "harness/lua/node.hpp"
#include "harness/lua/sandbox.hpp"

namespace whirl::lua {
namespace {

constexpr int kDeepest = 32;
// Tables may be shared: thirty of them can stand for a tree of 2^30.
constexpr std::size_t kMost_values = 100'000;
constexpr std::size_t kLargest_tree_B = 16u << 20;
constexpr double kInstructions_per_value = 8;

struct Walk {
  lua_State* L;
  std::string complaint = {};  // of the first thing that is no data; nothing is read after it
  std::size_t values = 0, size_B = 0;

  std::unique_ptr<Node> value(int index, const std::string& path, int depth) {
    auto node = std::make_unique<Node>();
    node->path = path;
    switch (lua_type(L, index)) {
      case LUA_TBOOLEAN:
        node->type = Node::Type::boolean;
        node->flag = lua_toboolean(L, index) != 0;
        break;
      case LUA_TNUMBER:
        node->type = lua_isinteger(L, index) ? Node::Type::integer : Node::Type::real;
        node->integer = lua_tointeger(L, index);
        node->real = lua_tonumber(L, index);
        break;
      case LUA_TSTRING:
        node->type = Node::Type::text;
        node->text = text(index, path);
        break;
      case LUA_TTABLE:
        fill(*node, index, depth);
        break;
      default:
        complain(path + " is a " + luaL_typename(L, index) + ", not data");
    }
    count(*node);
    return node;
  }

  void count(const Node& node) {
    Sandbox::spend(L, kInstructions_per_value);
    size_B += node.path.size() + node.text.size();
    if (++values > kMost_values || size_B > kLargest_tree_B) {
      complain("the table holds more than 100000 values or 16 MiB, shared ones counted each time");
    }
  }

  std::string text(int index, const std::string& path) {
    std::size_t size = 0;
    const char* first = lua_tolstring(L, index, &size);
    std::string all(first, size);
    if (legal_text(all) != all) complain(path + " holds control characters, or is no UTF-8");
    return all;
  }

  void fill(Node& node, int index, int depth) {
    if (depth > kDeepest) return complain(node.path + " is nested too deep (does it hold itself?)");
    const int table = lua_absindex(L, index);
    const auto length = static_cast<lua_Integer>(lua_rawlen(L, table));
    luaL_checkstack(L, 4, "table too deep");
    for (lua_Integer i = 1; i <= length && complaint.empty(); ++i) {
      lua_rawgeti(L, table, i);
      node.list.push_back(value(-1, node.path + "[" + std::to_string(i) + "]", depth + 1));
      lua_pop(L, 1);
    }
    for (lua_pushnil(L); lua_next(L, table) != 0; lua_pop(L, 1)) {
      if (lua_type(L, -2) == LUA_TSTRING) {
        fill_field(node, depth);
      } else if (!lua_isinteger(L, -2) || lua_tointeger(L, -2) < 1 ||
                 lua_tointeger(L, -2) > length) {
        complain(node.path + " has a key that is neither a name nor a place in a list");
      }
      if (!complaint.empty()) return lua_pop(L, 2);
    }
  }

  void fill_field(Node& node, int depth) {  // key and value are on top of the stack
    const std::string key = text(-2, node.path + ": a key");
    const std::string path = node.path.empty() ? key : node.path + "." + key;
    node.fields[key] = value(-1, path, depth + 1);
  }

  void complain(std::string what) {
    if (complaint.empty()) complaint = std::move(what);
  }
};

Result<Table> read(Sandbox& sandbox, const std::string& name, std::string source,
                   const Result<Done>& ran) {
  if (!ran) return ran.error();
  lua_State* L = sandbox.state();
  if (!lua_istable(L, -1)) {
    return Error{ErrorKind::bad_input, name, "must return a table", "end it as: return { ... }"};
  }
  Result<std::shared_ptr<Document>> document = Error{};
  const auto walked = sandbox.protect(
      1, [&](lua_State* l) { document = tree_from_stack(l, -1, name, std::move(source), ""); });
  if (!walked) return Error{walked.error().kind, name, walked.error().what, walked.error().cure};
  if (!document) return document.error();
  return Table(document.value(), &document.value()->root);
}

}  // namespace

Result<std::shared_ptr<Document>> tree_from_stack(lua_State* L, int index, std::string file,
                                                  std::string source, std::string call_place) {
  auto document = std::make_shared<Document>();
  document->file = std::move(file);
  document->source = std::move(source);
  document->call_place = std::move(call_place);
  Walk walk{L};
  walk.fill(document->root, index, 0);
  if (!walk.complaint.empty()) {
    const std::string& place = document->call_place.empty() ? document->file : document->call_place;
    return Error{ErrorKind::bad_input, place, walk.complaint, ""};
  }
  return document;
}

Result<Table> read_file(const std::string& path) {
  auto source = read_whole_file(path);
  if (!source) return source.error();
  Sandbox sandbox;
  const auto ran = sandbox.run_file(path);
  return read(sandbox, path, source.value(), ran);
}

Result<Table> read_text(const std::string& text, const std::string& name) {
  Sandbox sandbox;
  const auto ran = sandbox.run_text(text, name);
  return read(sandbox, name, text, ran);
}

}  // namespace whirl::lua
