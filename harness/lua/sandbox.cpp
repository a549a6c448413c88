#include "harness/lua/sandbox.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <lua.hpp>
#include <utility>

#include "base/mishap.hpp"
#include "base/whole_file.hpp"
#include "harness/lua/library.hpp"

namespace whirl::lua {
namespace {

namespace fs = std::filesystem;

constexpr int kHookStep = 1'000;
constexpr std::size_t kLarge_block_B = 64u << 10;
constexpr std::size_t kBytes_per_instruction = 64;  // moved, compared or searched
constexpr std::size_t kLongest_source_B = 1u << 20;

std::string chunk_name(const std::string& name) {
  return "@" + fs::path(name).filename().string();
}

}  // namespace

struct Sandbox::Inner {
  lua_State* L = nullptr;
  lua_State* running = nullptr;  // whose budget it is
  Limits limits;
  std::int64_t left = 0;
  std::size_t used_B = 0;
  std::size_t longest_text_B = 0;
  void* owner = nullptr;
  Error thrown{ErrorKind::internal, "", "an exception passed through a plan", ""};
  fs::path root;                   // include stays below it
  std::string source;              // of the file
  std::vector<std::string> below;  // files that were read, relative to the root
  std::string replaced, instead;   // a file's name, and the path that is read in its place

  static void* allocate(void* ud, void* block, std::size_t old_size, std::size_t size) {
    auto* self = static_cast<Inner*>(ud);
    const std::size_t was = block == nullptr ? 0 : old_size;
    if (size == 0) {
      std::free(block);
      self->used_B -= was;
      return nullptr;
    }
    self->charge_for(block == nullptr && old_size == LUA_TSTRING, size);
    if (size > was && self->refuses(block == nullptr && old_size == LUA_TSTRING, size - was)) {
      self->charge(self->used_B);  // Lua now collects all its garbage and asks again
      return nullptr;
    }
    void* moved = std::realloc(block, size);
    if (moved != nullptr) self->used_B += size - was;
    return moved;
  }

  bool refuses(bool text, std::size_t more) const {
    return (text && more > kLongest_text_B + 64) || used_B + more > limits.memory_B;
  }

  // Long texts, and large tables where they grow. Not small tables: the seed of Lua's hashes is the
  // clock's, so that the number of their rehashes may differ by one or two from run to run.
  void charge_for(bool text, std::size_t size) {
    if (text) longest_text_B = std::max(longest_text_B, size);
    if (size >= (text ? 4 * kBytes_per_instruction : kLarge_block_B)) charge(size);
  }

  void charge(std::size_t bytes) {
    left -= static_cast<std::int64_t>(bytes / kBytes_per_instruction);
    if (left <= 0 && running != nullptr) lua_sethook(running, count, LUA_MASKCOUNT, 1);
  }

  static Inner& of(lua_State* L) { return **static_cast<Inner**>(lua_getextraspace(L)); }

  static void count(lua_State* L, lua_Debug* frame) {
    Inner& self = of(L);
    // One instruction may compare or convert a text as long as any that has been made.
    const auto weight = static_cast<std::int64_t>(1 + self.longest_text_B / 1024);
    if (self.left > 0) self.left -= kHookStep * weight;
    if (self.left <= 0) Inner::stop(L);
    if (lua_getlocal(L, frame, -(kMost_values + 1)) != nullptr) {
      lua_pushfstring(L, "%sa call with more than %d arguments", where(L), kMost_values);
      lua_error(L);
    }
  }

  // Raises. From here on every instruction does, so that no pcall can go on.
  static void stop(lua_State* L) {
    lua_sethook(L, count, LUA_MASKCOUNT, 1);
    lua_pushfstring(L, "%sendless loop? stopped after %d million instructions without waiting",
                    where(L), static_cast<int>(of(L).limits.instructions / 1'000'000));
    lua_error(L);
  }

  // "hover.lua:3: ", of the plan's innermost line. It stays on the stack.
  static const char* where(lua_State* L) {
    lua_Debug frame;
    for (int level = 0; lua_getstack(L, level, &frame) != 0; ++level) {
      lua_getinfo(L, "Sl", &frame);
      if (frame.currentline > 0 && std::string_view(frame.short_src) != "prelude") {
        return lua_pushfstring(L, "%s:%d: ", frame.short_src, frame.currentline);
      }
    }
    return lua_pushliteral(L, "");
  }

  static Error not_read(const std::string& name, const char* why) {
    // Shown up to a zero, which no file's name holds.
    return {ErrorKind::bad_input, "", "\"" + std::string(name.c_str()) + "\": " + why, ""};
  }

  Result<std::string> read_below(const std::string& name) {
    std::error_code status;
    const fs::path top = fs::weakly_canonical(root, status);
    const fs::path path = status ? fs::path() : fs::weakly_canonical(root / name, status);
    const fs::path inside = status ? fs::path() : path.lexically_relative(top);
    if (fs::path(name).is_absolute() || inside.empty() || *inside.begin() == ".." ||
        name.find('\0') != std::string::npos) {
      return not_read(name, "only files below the plan's folder");
    }
    const bool other = !replaced.empty() && path.filename() == replaced;
    auto text = read_whole_file(other ? instead : path.string());
    if (!text) return not_read(other ? instead : name, "cannot be read");
    if (text.value().size() > kLongest_source_B) return not_read(name, "longer than 1 MiB");
    if (std::find(below.begin(), below.end(), inside.string()) == below.end()) {
      below.push_back(inside.string());
    }
    return text;
  }

  static int include(lua_State* L) {
    std::size_t size = 0;
    const char* name = luaL_checklstring(L, 1, &size);
    if (!load_below(L, {name, size})) return lua_error(L);
    lua_call(L, 0, 1);
    return 1;
  }

  // False: what is wrong lies on the stack.
  static bool load_below(lua_State* L, const std::string& name) {
    Inner& self = of(L);
    const auto text = self.read_below(name);
    if (!text) {
      luaL_where(L, 1);
      lua_pushfstring(L, "include %s", text.error().what.c_str());
      lua_concat(L, 2);
      return false;
    }
    spend(L, static_cast<double>(text.value().size()));
    const std::string path = fs::weakly_canonical(self.root / name).string();
    return luaL_loadbufferx(L, text.value().data(), text.value().size(), chunk_name(path).c_str(),
                            "t") == LUA_OK;
  }

  static void open(lua_State* L) {
    for (const luaL_Reg& lib :
         {luaL_Reg{LUA_GNAME, luaopen_base}, luaL_Reg{LUA_MATHLIBNAME, luaopen_math},
          luaL_Reg{LUA_STRLIBNAME, luaopen_string}, luaL_Reg{LUA_TABLIBNAME, luaopen_table}}) {
      luaL_requiref(L, lib.name, lib.func, 1);
      lua_pop(L, 1);
    }
    open_charged_calls(L);
    open_pattern_calls(L);
    if (luaL_loadbufferx(L, kPrelude, std::strlen(kPrelude), "=prelude", "t") != LUA_OK) {
      lua_error(L);
    }
    lua_call(L, 0, 0);
    // The string metatable's __index is the string table itself, so s:format is pruned with it.
    lua_register(L, "include", include);
  }
};

Sandbox::Sandbox(Limits limits) : inner_(std::make_unique<Inner>()) {
  inner_->limits = limits;
  inner_->left = limits.instructions;
  lua_State* L = lua_newstate(Inner::allocate, inner_.get());
  WHIRL_CHECK(L != nullptr);
  inner_->L = L;
  *static_cast<Inner**>(lua_getextraspace(L)) = inner_.get();
  const auto opened = protect(0, Inner::open);
  WHIRL_CHECK(opened.ok(), opened.ok() ? "" : opened.error().message());
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
  inner_->running = thread == nullptr ? inner_->L : thread;
  lua_sethook(inner_->running, Inner::count, LUA_MASKCOUNT, kHookStep);
}

void Sandbox::spend(lua_State* L, double instructions) {
  Inner& self = Inner::of(L);
  // Written so that a NaN stops, too.
  if (instructions < static_cast<double>(self.left)) {
    self.left -= static_cast<std::int64_t>(instructions);
    return;
  }
  self.left = 0;
  Inner::stop(L);
}

void Sandbox::set_owner(void* owner) {
  inner_->owner = owner;
}

void* Sandbox::owner(lua_State* L) {
  return Inner::of(L).owner;
}

Result<Done> Sandbox::run_file(const std::string& path) {
  std::error_code status;
  inner_->root = fs::absolute(path, status).parent_path();
  auto text = read_whole_file(path);
  if (!text) return text.error();
  inner_->source = std::move(text.value());
  return run_text(inner_->source, path);
}

void Sandbox::put_instead(std::string file_name, std::string path) {
  inner_->replaced = std::move(file_name);
  inner_->instead = std::move(path);
}

Result<std::string> Sandbox::read_below(const std::string& name) {
  return inner_->read_below(name);
}

const std::vector<std::string>& Sandbox::files_below() const {
  return inner_->below;
}

const std::string& Sandbox::source() const {
  return inner_->source;
}

Result<Done> Sandbox::run_text(const std::string& text, const std::string& name) {
  if (text.size() > kLongest_source_B) {
    return Error{ErrorKind::bad_input, name, "is longer than 1 MiB", ""};
  }
  lua_State* L = inner_->L;
  refill();
  const std::string chunk = chunk_name(name);
  int status = luaL_loadbufferx(L, text.data(), text.size(), chunk.c_str(), "t");
  if (status == LUA_OK) status = lua_pcall(L, 0, 1, 0);
  if (status == LUA_OK) return Done{};
  Error error = raised(L, status);
  if (error.place.empty()) error.place = chunk.substr(1);
  lua_pop(L, 1);
  return error;
}

Result<Done> Sandbox::protect(int arguments, const std::function<void(lua_State*)>& work) {
  lua_State* L = inner_->L;
  if (lua_checkstack(L, 2) == 0) return raised(L, LUA_ERRMEM);
  lua_pushcfunction(L, [](lua_State* l) {
    const auto* mine = static_cast<const std::function<void(lua_State*)>*>(lua_touserdata(l, -1));
    lua_pop(l, 1);
    try {
      (*mine)(l);
    } catch (const std::exception&) {  // Lua's own are none of these
      Inner::of(l).thrown = error_of_current_exception();
      throw;
    }
    return 0;
  });
  lua_insert(L, -1 - arguments);
  lua_pushlightuserdata(L, const_cast<std::function<void(lua_State*)>*>(&work));
  const int status = lua_pcall(L, arguments + 1, 0, 0);
  if (status == LUA_OK) return Done{};
  Error error = raised(L, status);
  lua_pop(L, 1);
  return error;
}

Error Sandbox::raised(lua_State* L, int status) {
  if (status == LUA_ERRMEM) {
    const std::size_t memory_B = Inner::of(L).limits.memory_B;
    return {ErrorKind::bad_input, "",
            "not enough memory: a plan has " + std::to_string(memory_B >> 20) +
                " MiB, and a text 1 MiB",
            ""};
  }
  // Lua caught an exception that was none of its own, and dropped it.
  if (status < 0) return Inner::of(L).thrown;
  if (lua_type(L, -1) == LUA_TSTRING) {
    std::size_t size = 0;
    const char* text = lua_tolstring(L, -1, &size);
    return to_error({text, size});
  }
  return {ErrorKind::bad_input, "",
          std::string("error was called with a ") + luaL_typename(L, -1) + ", not with a text",
          "write it as: error \"what is wrong\""};
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

}  // namespace whirl::lua
