// The Lua that plans and data files get: no files, no clock, no chance, no way out.
//
//   Has      assert error ipairs pairs pcall select tonumber tostring type; math without random;
//            string without dump; table; include "file.lua" (read-only, below the folder of the
//            plan)
//   Order    pairs() goes through numbers ascending, then texts ascending, then false, true; other
//            keys are an error. next() is not there: its order is the hash's.
//   Shown    tables and functions print as "table" and "function", never as an address
//   Limits   an instruction budget per run (an endless loop is one error with file and line), and
//            memory
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "harness/base/result.hpp"

struct lua_State;

namespace whirl::lua {

struct Limits {
  std::int64_t instructions = 50'000'000;  // about a second of the host
  std::size_t memory_B = 256u << 20;
};

class Sandbox {
 public:
  explicit Sandbox(Limits limits = {});
  ~Sandbox();
  Sandbox(Sandbox&&) noexcept;

  lua_State* state() const;
  // A new instruction budget for this thread of the state (null: the main one).
  void refill(lua_State* thread = nullptr);
  // What C functions called from the chunk find by owner(L).
  void set_owner(void* owner);
  static void* owner(lua_State* L);

  // Loads and runs a chunk; what it returns (one value) is left on the stack.
  Result<Done> run_file(const std::string& path);
  Result<Done> run_text(const std::string& text, const std::string& name);

  // Lua's own message "hover.lua:3: what" as an Error with a place.
  static Error to_error(const std::string& message);

 private:
  struct Inner;
  std::unique_ptr<Inner> inner_;
};

Result<std::string> read_whole_file(const std::string& path);

}  // namespace whirl::lua
