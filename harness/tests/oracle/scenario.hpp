// A random plan with a known right outcome: its Lua, what the world and the target do under it, and
// what must be told of it.
//
//   Clauses  each brings lines of Lua, signals and messages of its own, and what must come of them in
//            closed form or straight from the definitions (design, README of the plans)
//   Apart    nothing is shared with the judging: not its metrics, units, windows or verdicts
//   Streams  a clause draws from a stream of its own, so that leaving others out does not change it
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "base/units.hpp"
#include "harness/lua/sandbox.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::oracle {

inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kAnything = std::numeric_limits<double>::infinity();

class Dice {
 public:
  Dice(std::uint64_t seed, const std::string& name) : stream_(seed, name) {}
  double uniform() { return stream_.uniform(); }
  int between(int low, int high) {  // both included
    return low + static_cast<int>(uniform() * (high - low + 1));
  }
  bool chance(double p) { return uniform() < p; }
  template <typename T>
  const T& pick(const std::vector<T>& all) {
    return all[static_cast<std::size_t>(between(0, static_cast<int>(all.size()) - 1))];
  }

 private:
  RandomStream stream_;
};

struct Unit {
  std::string symbol;
  double scale = 1.0, offset = 0.0;  // SI = x * scale + offset
  double of_SI(double x) const { return (x - offset) / scale; }
};
struct Quality {  // what a signal is
  Dimension dimension = Dimension::none;
  std::string suffix;  // of its name in conditions: "_m"
  std::vector<Unit> units;
};
const Quality& any_quality(Dice& dice);  // one that a world may have
const Quality& bare();                   // a number without a unit
const Quality& ratio();
const Quality& duration();

// What must stand in the report of one expectation; numbers in the unit of its limit.
enum class Right {
  pass,
  fail,
  unshown,
  any
};  // unshown: not a pass; any: the run ended before it was due
struct Told {
  std::string name;
  Right right = Right::any;
  double measured = kNaN, margin = kNaN;
  double tolerance = 0.0;  // kAnything: not compared
};

// A limit in words of Lua, and what must be told of a value under it.
struct Limited {
  std::string lua;  // :at_most("1.2 m")
  std::function<Told(const std::string& name, double x_SI, double tolerance_SI)> judge;
};
// Near x, on the right or the wrong side of it by more than the tolerance; `exact`: also upon it.
Limited limit_near(Dice& dice, const Quality& quality, double x_SI, double tolerance_SI,
                   bool exact = false);
// At most, as the keys of a budget have it: lua is the quoted text alone.
Limited most_near(Dice& dice, const Quality& quality, double x_SI, double tolerance_SI);

// How the run ended.
struct End {
  int t_ms = 0;         // the world's time
  int last_act_ms = 0;  // the script's last turn; it has written what was due until then
  int known_ms = 0;     // what the target did is known until here
  bool returned = false;
};

enum class Ending {
  returns,
  lua_error,
  times_out,
  core_fault,
  core_fault_with_late_host,
  watchdog,
  watchdog_allowed,
  locks_up,
  switches_off,
  late_host,
  lost_target,
  cut_batch,
  no_start_host,
  no_start_image,
};

struct Signal {
  std::string name;
  Dimension dimension = Dimension::none;
  std::function<double(int ms)> at;
};

struct Message {
  std::int64_t t_ns = 0;
  std::function<void(io::Batch&)> add;
};

struct OtherDevice {
  std::string name, bus;
  int address = -1, motor = 0;
  int host_on_can = 0;  // the host of a pod, which is on that bus by a parameter
};

struct Line {  // said by the firmware, so long after it was asked
  int after_ms = 0;
  std::string text;
};

using Judgement = std::function<void(const End& end, std::vector<Told>& told)>;

struct Scenario {
  std::string lua;  // the body of run
  int now_ms = 0;   // where the script stands
  std::vector<Signal> signals;
  std::vector<Message> messages;  // in any order
  std::vector<Judgement> judgements;
  std::map<int, std::int64_t> wires_ns;  // by the ms of a command: when its last bit had passed
  std::map<std::string, Line> answers;   // by the line that is asked
  std::vector<std::string> functions{"fw::none"}, i2c_devices{"esc0"}, spi_devices{"imu"};
  std::vector<OtherDevice> other_devices;     // behind those
  std::map<std::string, std::string> joined;  // Node::joined
  std::map<std::string, bool> world_faults;   // by kind: is it applied?
  std::vector<std::pair<std::string, bool>> board_faults;
  std::function<void(const io::FaultCommand&)> on_fault;  // told of what reaches the board
  std::function<void(io::Batch&)> last_words;  // what the target tells when it is stopped
  bool looks = false;                          // the plan reads a signal, an answer or a window
  bool authors_fault = false;                  // a limit is missing, a fault reaches nobody
  Ending ending = Ending::returns;
  int ending_ms = 0;  // of those that come from outside
  int timeout_ms = 0;
  lua::Limits limits;  // of the plan's Lua

  void say(const std::string& line) { lua += "  " + line + "\n"; }
  void wait(int ms);
  End end() const;
  void add_heartbeat();  // bytes that show that the image runs
};

struct Outcome {
  std::vector<int> codes;  // any of these is right
  std::vector<Told> told;
};

constexpr int kClauses = 5;
// The scenario of a seed; clauses whose bit in `mask` is 0 are left out.
Scenario make_scenario(std::uint64_t seed, unsigned mask = ~0u);
Outcome right_outcome(const Scenario& scenario);

// The clauses. `id` makes their names unique.
using Clause = void (*)(Scenario& s, Dice& dice, const std::string& id);
void add_step_record(Scenario& s, Dice& dice, const std::string& id);
void add_statistics(Scenario& s, Dice& dice, const std::string& id);
void add_distance(Scenario& s, Dice& dice, const std::string& id);
void add_numbers(Scenario& s, Dice& dice, const std::string& id);
void add_values(Scenario& s, Dice& dice, const std::string& id);
void add_within(Scenario& s, Dice& dice, const std::string& id);
void add_wait_until(Scenario& s, Dice& dice, const std::string& id);
void add_ask(Scenario& s, Dice& dice, const std::string& id);
void add_signal_guard(Scenario& s, Dice& dice, const std::string& id);
void add_condition_guard(Scenario& s, Dice& dice, const std::string& id);
void add_budget(Scenario& s, Dice& dice, const std::string& id);
void add_busy(Scenario& s, Dice& dice, const std::string& id);
void add_bus(Scenario& s, Dice& dice, const std::string& id);
void add_latency(Scenario& s, Dice& dice, const std::string& id);
void add_fault(Scenario& s, Dice& dice, const std::string& id);
void add_unlimited(Scenario& s, Dice& dice, const std::string& id);

}  // namespace whirl::oracle
