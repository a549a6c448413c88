// The Lua that plans and data files get: no files, no clock, no chance, no way out.
//
//   Has      assert error ipairs pairs pcall select tonumber tostring type; math without random;
//            string without dump; table; include "file.lua" (read-only, below the folder of the
//            plan)
//   Order    pairs() goes through numbers ascending, then texts ascending, then false, true; other
//            keys are an error. next() is not there: its order is the hash's.
//   Shown    tables and functions print as "table" and "function", never as an address
//   Limits   an instruction budget per run (an endless loop is one error with file and line), and
//            memory. What works long within one instruction (patterns, long texts, table.move, data
//            read from tables) is taken off the same budget, so that no call of the host's clock is
//            needed to stop anything. A text has 1 MiB at most, a call 1000 arguments and results.
//   Errors   every entry is protected: what Lua raises, lack of memory included, is a Result
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"

struct lua_State;

namespace whirl::lua {

struct Limits {
  std::int64_t instructions = 50'000'000;  // about a second of the host
  std::size_t memory_B = 256u << 20;
};

inline constexpr std::size_t kLongest_text_B = 1u << 20;

class Sandbox {
 public:
  explicit Sandbox(Limits limits = {});
  ~Sandbox();
  Sandbox(Sandbox&&) noexcept;

  lua_State* state() const;
  // A new instruction budget for this thread of the state (null: the main one).
  void refill(lua_State* thread = nullptr);
  // Takes so many instructions off the budget that runs; raises where it is used up.
  static void spend(lua_State* L, double instructions);
  // What C functions called from the chunk find by owner(L).
  void set_owner(void* owner);
  static void* owner(lua_State* L);

  // What include takes in place of every file of that name, with or without folders before it.
  void put_instead(std::string file_name, std::string path);

  // Loads and runs a chunk; what it returns (one value) is left on the stack.
  Result<Done> run_file(const std::string& path);
  // A file below the folder of the file that runs, at most 1 MiB, as include takes it.
  // Errors   bad_input without a place: not there, or not below
  Result<std::string> read_below(const std::string& name);
  // Those that were read so (include, read_below), as they were named, once each.
  const std::vector<std::string>& files_below() const;
  const std::string& source() const;  // of that file; its own while it runs, too
  Result<Done> run_text(const std::string& text, const std::string& name);

  // Runs this with so many values of the main stack's top as its own. Whatever it raises is an Error.
  Result<Done> protect(int arguments, const std::function<void(lua_State*)>& work);

  // Lua's own message "hover.lua:3: what" as an Error with a place.
  static Error to_error(const std::string& message);
  // Of a call that ended with this status: what lies on top of the stack.
  static Error raised(lua_State* L, int status);

 private:
  struct Inner;
  std::unique_ptr<Inner> inner_;
};

}  // namespace whirl::lua
