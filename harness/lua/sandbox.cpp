#include "harness/lua/sandbox.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <lua.hpp>
#include <utility>

namespace whirl::lua {
namespace {

namespace fs = std::filesystem;

constexpr int kHookStep = 10'000;

// Replaces what prints addresses or walks in hash order. Runs before the globals are pruned.
constexpr const char* kPrelude = R"lua(
local type, getmetatable, raw_tostring, raw_format = type, getmetatable, tostring, string.format
local next, sort, error, select, gsub = next, table.sort, error, select, string.gsub

local function shown(v)
  local t = type(v)
  if t == "table" or t == "userdata" then
    local meta = getmetatable(v)
    if not (type(meta) == "table" and meta.__tostring) then return t end
  elseif t == "function" or t == "thread" then
    return t
  end
  return raw_tostring(v)
end
tostring = shown

string.format = function(form, ...)
  if type(form) == "string" and form:find("%%[-+ #0]*%d*%.?%d*p") then
    error("%p prints an address, which differs from run to run", 2)
  end
  local n, given = select("#", ...), {...}
  for i = 1, n do
    local t = type(given[i])
    if t ~= "number" and t ~= "string" and t ~= "boolean" and t ~= "nil" then given[i] = shown(given[i]) end
  end
  return raw_format(form, table.unpack(given, 1, n))
end

local rank = { number = 1, string = 2, boolean = 3 }
local function before(a, b)
  local ra, rb = rank[type(a)], rank[type(b)]
  if ra ~= rb then return ra < rb end
  if ra == 3 then return not a and b end
  return a < b
end
pairs = function(t)
  if type(t) ~= "table" then error("pairs wants a table, not a " .. type(t), 2) end
  local keys = {}
  for k in next, t do
    if not rank[type(k)] then error("pairs: a " .. type(k) .. " as key has no order", 2) end
    keys[#keys + 1] = k
  end
  sort(keys, before)
  local i = 0
  return function()
    local k
    repeat i = i + 1; k = keys[i] until k == nil or t[k] ~= nil
    if k ~= nil then return k, t[k] end
  end
end
for _, name in ipairs { "next", "load", "loadfile", "dofile", "collectgarbage", "print", "warn",
                        "rawget", "rawset", "rawequal", "rawlen", "getmetatable", "setmetatable",
                        "xpcall", "_VERSION" } do _G[name] = nil end
math.random, math.randomseed, string.dump = nil, nil, nil
)lua";

std::string chunk_name(const std::string& name) {
  return "@" + fs::path(name).filename().string();
}

}  // namespace

struct Sandbox::Inner {
  lua_State* L = nullptr;
  Limits limits;
  std::int64_t left = 0;
  std::size_t used_B = 0;
  void* owner = nullptr;
  fs::path root;  // include stays below it

  static void* allocate(void* ud, void* block, std::size_t old_size, std::size_t size) {
    auto* self = static_cast<Inner*>(ud);
    const std::size_t was = block == nullptr ? 0 : old_size;
    if (size == 0) {
      std::free(block);
      self->used_B -= was;
      return nullptr;
    }
    if (size > was && self->used_B + (size - was) > self->limits.memory_B) return nullptr;
    void* moved = std::realloc(block, size);
    if (moved != nullptr) self->used_B += size - was;
    return moved;
  }

  static Inner& of(lua_State* L) { return **static_cast<Inner**>(lua_getextraspace(L)); }

  static void count(lua_State* L, lua_Debug*) {
    Inner& self = of(L);
    self.left -= kHookStep;
    if (self.left > 0) return;
    // From here on every instruction fails, so that no pcall can go on.
    lua_sethook(L, count, LUA_MASKCOUNT, 1);
    luaL_where(L, 0);  // in a hook, level 0 is the function that runs
    lua_pushfstring(L, "endless loop? stopped after %d million instructions without waiting",
                    static_cast<int>(self.limits.instructions / 1'000'000));
    lua_concat(L, 2);
    lua_error(L);
  }

  static int include(lua_State* L) {
    const fs::path wanted = luaL_checkstring(L, 1);
    Inner& self = of(L);
    const fs::path path = fs::weakly_canonical(self.root / wanted);
    const fs::path inside = path.lexically_relative(fs::weakly_canonical(self.root));
    if (wanted.is_absolute() || inside.empty() || *inside.begin() == "..") {
      return luaL_error(L, "include \"%s\": only files below the plan's folder",
                        wanted.string().c_str());
    }
    const auto text = read_whole_file(path.string());
    if (!text) return luaL_error(L, "include \"%s\": cannot be read", wanted.string().c_str());
    if (luaL_loadbufferx(L, text.value().data(), text.value().size(),
                         chunk_name(path.string()).c_str(), "t") != LUA_OK) {
      return lua_error(L);
    }
    lua_call(L, 0, 1);
    return 1;
  }
};

Sandbox::Sandbox(Limits limits) : inner_(std::make_unique<Inner>()) {
  inner_->limits = limits;
  lua_State* L = lua_newstate(Inner::allocate, inner_.get());
  WHIRL_CHECK(L != nullptr);
  inner_->L = L;
  *static_cast<Inner**>(lua_getextraspace(L)) = inner_.get();
  for (const luaL_Reg& lib :
       {luaL_Reg{LUA_GNAME, luaopen_base}, luaL_Reg{LUA_MATHLIBNAME, luaopen_math},
        luaL_Reg{LUA_STRLIBNAME, luaopen_string}, luaL_Reg{LUA_TABLIBNAME, luaopen_table}}) {
    luaL_requiref(L, lib.name, lib.func, 1);
    lua_pop(L, 1);
  }
  const int status = luaL_dostring(L, kPrelude);
  WHIRL_CHECK(status == LUA_OK, lua_tostring(L, -1));
  // The string metatable's __index is the string table itself, so s:format is pruned with it.
  lua_register(L, "include", Inner::include);
  lua_settop(L, 0);
  refill();
}

Sandbox::~Sandbox() {
  if (inner_ != nullptr) lua_close(inner_->L);
}
Sandbox::Sandbox(Sandbox&&) noexcept = default;

lua_State* Sandbox::state() const {
  return inner_->L;
}

void Sandbox::refill(lua_State* thread) {
  inner_->left = inner_->limits.instructions;
  lua_sethook(thread == nullptr ? inner_->L : thread, Inner::count, LUA_MASKCOUNT, kHookStep);
}

void Sandbox::set_owner(void* owner) {
  inner_->owner = owner;
}

void* Sandbox::owner(lua_State* L) {
  return Inner::of(L).owner;
}

Result<Done> Sandbox::run_file(const std::string& path) {
  inner_->root = fs::absolute(path).parent_path();
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  return run_text(text.value(), path);
}

Result<Done> Sandbox::run_text(const std::string& text, const std::string& name) {
  lua_State* L = inner_->L;
  refill();
  if (luaL_loadbufferx(L, text.data(), text.size(), chunk_name(name).c_str(), "t") != LUA_OK ||
      lua_pcall(L, 0, 1, 0) != LUA_OK) {
    const char* message = lua_tostring(L, -1);
    Error error = to_error(message != nullptr ? message : "error without a text");
    lua_pop(L, 1);
    return error;
  }
  return Done{};
}

Error Sandbox::to_error(const std::string& message) {
  // "hover.lua:12: what": the place ends at the second colon, if the middle is a number.
  const auto first = message.find(':');
  const auto second = first == std::string::npos ? first : message.find(':', first + 1);
  if (second == std::string::npos || second == first + 1 ||
      message.find_first_not_of("0123456789", first + 1) != second) {
    return {ErrorKind::bad_input, "", message, ""};
  }
  const auto what = message.find_first_not_of(' ', second + 1);
  return {ErrorKind::bad_input, message.substr(0, second),
          what == std::string::npos ? "" : message.substr(what), ""};
}

Result<std::string> read_whole_file(const std::string& path) {
  std::error_code status;
  if (fs::is_directory(path, status)) {
    return Error{ErrorKind::bad_input, path, "is a folder, not a file", ""};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{ErrorKind::bad_input, path, "no such file, or not readable", ""};
  return std::string(std::istreambuf_iterator<char>(in), {});
}

}  // namespace whirl::lua
