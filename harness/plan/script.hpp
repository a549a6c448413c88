// A running plan: its Lua as a coroutine in virtual time, and what it has asked to be judged.
//
//   Drive    advance() at every step; the coroutine runs when what it waits for has come
//   Judge    expectations at once; guards (t:always) and windows (budgets, buses, latency) in finish()
//   Shown    a limit that was broken is a fail whenever that was seen; one that was kept passes only
//            if the whole of its time was watched, and is inconclusive otherwise
//   Parts    api_*.cpp each bring one family of calls; they meet here
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "harness/board/node.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/plan/signal_rows.hpp"
#include "harness/target/offers.hpp"
#include "harness/world/world.hpp"
#include "results/event_log.hpp"
#include "results/flight_log/ulog.hpp"
#include "results/report.hpp"

namespace whirl::plan {

inline constexpr std::int64_t kForever = INT64_MAX;

// What a script sees and moves.
struct Stage {
  World& world;
  Offers offers;        // the targets'
  SignalTable signals;  // the world's
  const std::vector<Node>& nodes;
  SignalRows& rows;
  const std::vector<results::EventLog>& logs;  // of the nodes
  results::Report& report;
  std::function<Result<Done>(const FaultSpec&)> inject;  // into the board
  std::int64_t now_ns = 0;
  std::string folder = {};  // of the run, where its parts leave files; empty: none
  std::function<bool(const std::string&)> sees = {};  // Target::sees; empty: all
  std::function<bool(const std::string& what, const std::string& kind)> spoils =
      {};  // Target::spoils; empty: by offers
};

// Of a card, as it was when the plan looked.
struct NamedLog {
  std::string name;
  bool there = false;
  results::ULog log = {};
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
  std::size_t number = 0;    // in SignalRows
  std::int64_t from_ns = 0;  // the command
  std::int64_t to_ns = 0;
  std::int64_t wire_ns = 0;  // when the command's last bit had passed
};

// A signal over the time of a guard: the first of its lowest and of its highest values, and the first
// that is no finite number.
struct Extremes {
  struct Value {
    double x = std::numeric_limits<double>::quiet_NaN();
    std::int64_t t_ns = 0;
  };
  Value low, high;
  std::optional<Value> not_finite;
  std::int64_t seen_ns = -1;  // the latest that was looked at

  void look(double x, std::int64_t t_ns);
};

struct Guard {  // t:always
  std::string name, place;
  std::optional<std::size_t> column;  // or:
  int condition_ref = -1;
  std::int64_t from_ns = 0, to_ns = kForever;
  std::optional<How> how;
  std::optional<Limit> low, high;
  Extremes seen;                   // of a signal
  std::int64_t evaluated_ns = -1;  // of a condition: when last, how often,
  std::int64_t evaluated = 0;
  std::int64_t violated_ns = 0;  // how long it did not hold, and since when
  std::optional<std::int64_t> first_ns;
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
  // After the last step: judges guards and windows, and gives what is wrong with the plan itself.
  // `completed`: the script has returned, so that what is watched to the end has been.
  std::vector<Error> finish(bool completed);
  const std::string& step_name() const { return step_name_; }

  // What the api parts use.
  static Script& of(lua_State* L);
  Stage& stage() { return stage_; }
  std::size_t column(lua_State* L, const std::string& signal);  // raises for an unknown one
  Dimension dimension(std::size_t column) const;
  bool condition(lua_State* L, int ref);  // raises what the function raised
  void judge(const Measurement& measured, How how, std::optional<Limit> low,
             std::optional<Limit> high, const std::string& place, double t_s,
             const std::string& note = {}, const std::string& unfilled = {}, double accuracy = 0.0);
  // The same within a window that was not watched to its end: a limit kept until then shows nothing.
  // `of_all`: of a mean or a count over all of it, not even a limit broken until then does.
  enum class Figure { extreme, of_all };
  // `accuracy` of the measured value, as a share of it: who meets the limit by less is marginal.
  void judge_in_window(const Measurement& measured, Figure figure, const Limit& high,
                       const std::string& place, double t_s, const std::string& note,
                       double accuracy = 0.0);
  void add(results::Expectation expectation);  // makes its name unique
  // Of the window that is being judged: something in it was not seen, why. A figure over it shows nothing then.
  void not_seen_whole(const std::string& why) {
    if (unfilled_.empty()) unfilled_ = why;
  }
  // The plan has taken in something of the run: a signal, an answer, a window.
  void look() { looked_ = true; }
  // It has done something: what is told from now on may be the answer.
  void act() { told_before_ = stage_.world.told_texts().size(); }
  std::size_t told_before() const { return told_before_; }  // texts, by its latest act
  bool has_looked() const { return looked_; }
  void wait_until(std::int64_t t_ns, int condition_ref = -1);
  bool condition_met() const { return condition_met_; }
  void set_step(const std::string& name);
  // Of t:command: reads the table, files that it names too, and gives it to the world.
  Result<Done> give_command(const lua::Table& table);
  // Of t:at: at the first step from t_ns on, after the plan's own turn.
  Result<Done> add_timed_command(std::int64_t t_ns, const lua::Table& table);
  // Judged in finish() over [from, min(to, end)].
  using Window = std::function<void(Script&, std::int64_t from_ns, std::int64_t to_ns)>;
  void add_window(std::int64_t to_ns, Window window);
  std::size_t windows() const { return windows_.size(); }

  RandomStream& chance();  // the plan's, by the run's seed

  std::vector<Measurement> measurements;  // all that Lua holds a table of
  std::vector<RecordInfo> records;
  std::vector<Guard> guards;
  std::vector<PendingExpectation> pending;
  std::vector<FaultSpec> faults;
  std::vector<NamedLog> logs;

 private:
  struct OpenWindow {
    std::int64_t from_ns, to_ns;
    Window judge;
  };
  void start(lua_State* L, const Plan& plan);
  Result<State> resume();
  Result<Done> give_due_commands();
  void check_conditions(lua_State* L);
  void check_guarding_conditions(lua_State* L);
  void look_at_guarded();
  void judge_guard(const Guard& guard, bool completed);
  void judge_windows(bool completed);
  void list_faults();

  PlanFile& file_;
  Stage& stage_;
  lua_State* thread_ = nullptr;
  std::optional<Error> broken_;  // it could not even be set up
  std::int64_t wake_ns_ = 0;
  int wake_condition_ = -1;
  bool condition_met_ = false;
  bool started_ = false, done_ = false, in_condition_ = false;
  bool looked_ = false;
  std::size_t told_before_ = 0;
  std::optional<RandomStream> chance_;
  std::string step_name_;
  std::vector<OpenWindow> windows_;
  std::multimap<std::int64_t, Command> timed_;  // of one time in the order of their calls
  std::string unfilled_;  // of the window that is being judged: how; empty: it was watched whole
  std::set<std::string> names_;             // of the expectations
  std::map<std::string, int> last_number_;  // that made such a name unique
};

// Registers t's methods into the table on top of the stack.
void add_time_calls(lua_State* L);
void add_record_calls(lua_State* L);
void add_expect_calls(lua_State* L);
void add_timing_calls(lua_State* L);
void add_can_calls(lua_State* L);
void add_action_calls(lua_State* L);
void add_text_calls(lua_State* L);
void add_log_calls(lua_State* L);

}  // namespace whirl::plan
