// A running plan: its Lua as a coroutine in virtual time, and what it has asked to be judged.
//
//   Drive    advance() at every step; the coroutine runs when what it waits for has come
//   Judge    expectations at once; guards (t:always) and windows (budgets, buses, latency) in finish()
//   Parts    api_*.cpp each bring one family of calls; they meet here
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/executive/board_file.hpp"
#include "harness/executive/world.hpp"
#include "harness/plan/plan_file.hpp"
#include "results/event_log.hpp"
#include "results/report.hpp"
#include "results/truth_log.hpp"

namespace whirl::plan {

inline constexpr std::int64_t kForever = INT64_MAX;

// What a script sees and moves.
struct Stage {
  World& world;
  const Board& board;
  const results::TruthLog& truth;
  const results::EventLog& events;
  results::Report& report;
  std::function<Result<Done>(const FaultSpec&)> inject;  // into the board
  std::int64_t now_ns = 0;
};

struct Measurement {
  double value_SI = 0.0;
  Dimension dimension = Dimension::none;
  std::string name;
  // Where it comes from, for the page: see results::Expectation.
  std::vector<std::string> signals = {};
  std::int64_t from_ns = 0, to_ns = 0;
  bool level = false;
};

struct Limit {
  double value_SI = 0.0;
  std::string unit;  // as written
};

enum class How { at_most, at_least, within, equal };

struct RecordInfo {
  std::vector<std::size_t> columns;
  std::int64_t from_ns = 0;  // the command
  std::int64_t to_ns = 0;
  std::int64_t wire_ns = 0;  // when the command's last bit had passed
};

struct Guard {  // t:always
  std::string name, place;
  std::optional<std::size_t> column;  // or:
  int condition_ref = -1;
  std::int64_t from_ns = 0, to_ns = kForever;
  std::optional<How> how;
  std::optional<Limit> low, high;
  std::int64_t violated_ns = 0;  // of a condition: how long, and when first
  std::int64_t first_ns = -1;
};

struct PendingExpectation {
  Measurement measured;
  std::string place;
  bool judged = false;
};

class Script {
 public:
  enum class State { waiting, done };

  Script(PlanFile& file, const Plan& plan, Stage& stage);

  Result<State> advance();
  // After the last step: judges guards and windows. Complaints about the plan are errors.
  Result<Done> finish();
  const std::string& step_name() const { return step_name_; }

  // What the api parts use.
  static Script& of(lua_State* L);
  Stage& stage() { return stage_; }
  std::size_t column(lua_State* L, const std::string& signal);  // raises for an unknown one
  Dimension dimension(std::size_t column) const;
  bool condition(lua_State* L, int ref);  // raises what the function raised
  void judge(const Measurement& measured, How how, std::optional<Limit> low,
             std::optional<Limit> high, const std::string& place, double t_s,
             const std::string& note = {});
  void add(results::Expectation expectation);  // makes its name unique
  void wait_until(std::int64_t t_ns, int condition_ref = -1);
  bool condition_met() const { return condition_met_; }
  void set_step(const std::string& name);
  // Judged in finish() over [from, min(to, end)].
  using Window = std::function<void(Script&, std::int64_t from_ns, std::int64_t to_ns)>;
  void add_window(std::int64_t to_ns, Window window);

  std::vector<Measurement> measurements;  // all that Lua holds a table of
  std::vector<RecordInfo> records;
  std::vector<Guard> guards;
  std::vector<PendingExpectation> pending;
  std::vector<FaultSpec> faults;
  std::vector<std::string> fault_targets;

 private:
  struct OpenWindow {
    std::int64_t from_ns, to_ns;
    Window judge;
  };
  void judge_guard(const Guard& guard);
  void judge_faults();

  PlanFile& file_;
  Stage& stage_;
  lua_State* thread_ = nullptr;
  std::int64_t wake_ns_ = 0;
  int wake_condition_ = -1;
  bool condition_met_ = false;
  bool started_ = false;
  std::string step_name_;
  std::vector<OpenWindow> windows_;
};

// Registers t's methods into the table on top of the stack.
void add_time_calls(lua_State* L);
void add_record_calls(lua_State* L);
void add_expect_calls(lua_State* L);
void add_timing_calls(lua_State* L);
void add_action_calls(lua_State* L);
void add_text_calls(lua_State* L);

}  // namespace whirl::plan
