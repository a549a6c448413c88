// t:flight_log: what the firmware has written onto a card of its board, read while the run goes on.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "harness/plan/raise.hpp"
#include "harness/plan/values.hpp"
#include "results/flight_log/card_files.hpp"

namespace whirl::plan {
namespace {

using results::ULog, results::ULogTopic;

constexpr const char* kLog = "flight log";
constexpr const char* kPosition = "vehicle_local_position";
constexpr double kBytes_per_instruction = 50.0;  // what reading a log costs a plan
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double seconds_of_us(std::uint64_t us) {
  return static_cast<double>(us) * 1e-6;
}

const NamedLog& log_of(lua_State* L) {
  Script& self = Script::of(L);
  const NamedLog& log = self.logs[check_handle(L, 1, kLog)];
  lua::Sandbox::spend(L, static_cast<double>(log.log.records_bytes) / kBytes_per_instruction);
  return log;
}

int push(lua_State* L, const NamedLog& log, double value, Dimension dimension,
         const std::string& what) {
  push_measurement(L, {value, dimension, log.name + ": " + what});
  return 1;
}

const ULogTopic* topic_of(lua_State* L, const NamedLog& log, std::string& name) {
  name = check_text(L, 2, "a topic's name");
  const auto found = log.log.topics.find(name);
  return found == log.log.topics.end() ? nullptr : &found->second;
}

int samples(lua_State* L) {
  const NamedLog& log = log_of(L);
  std::string name;
  const ULogTopic* topic = topic_of(L, log, name);
  return push(L, log, topic == nullptr ? 0.0 : static_cast<double>(topic->time_us.size()),
              Dimension::none, "samples of " + name);
}

// Between two samples of a topic, less what dropout messages between them own up to.
int gap(lua_State* L) {
  const NamedLog& log = log_of(L);
  std::string name;
  const ULogTopic* topic = topic_of(L, log, name);
  double worst_s = kNothing;
  for (std::size_t i = 1; topic != nullptr && i < topic->time_us.size(); ++i) {
    const std::uint64_t from = topic->time_us[i - 1], to = topic->time_us[i];
    double gap_s = seconds_of_us(to - from);
    for (const results::ULogDropout& dropout : log.log.dropouts) {
      if (dropout.after_us >= from && dropout.after_us < to) gap_s -= 1e-3 * dropout.duration_ms;
    }
    if (!(gap_s <= worst_s)) worst_s = gap_s;
  }
  return push(L, log, worst_s, Dimension::time, "longest gap in " + name + " beyond dropouts");
}

int dropouts(lua_State* L) {
  const NamedLog& log = log_of(L);
  double total_s = log.there ? 0.0 : kNothing;
  for (const results::ULogDropout& dropout : log.log.dropouts)
    total_s += 1e-3 * dropout.duration_ms;
  return push(L, log, total_s, Dimension::time, "time in dropouts");
}

// By the firmware's clock, which starts with the board.
int last(lua_State* L) {
  const NamedLog& log = log_of(L);
  std::string name;
  const ULogTopic* topic = topic_of(L, log, name);
  const bool some = topic != nullptr && !topic->time_us.empty();
  return push(L, log, some ? seconds_of_us(topic->time_us.back()) : kNothing, Dimension::time,
              "last sample of " + name);
}

int first(lua_State* L) {
  const NamedLog& log = log_of(L);
  std::string name;
  const ULogTopic* topic = topic_of(L, log, name);
  const bool some = topic != nullptr && !topic->time_us.empty();
  return push(L, log, some ? seconds_of_us(topic->time_us.front()) : kNothing, Dimension::time,
              "first sample of " + name);
}

int closed(lua_State* L) {
  const NamedLog& log = log_of(L);
  return push(L, log, log.log.closed ? 1.0 : 0.0, Dimension::none, "closed");
}

int damaged(lua_State* L) {
  const NamedLog& log = log_of(L);
  return push(L, log, log.there && log.log.damage.empty() ? 0.0 : 1.0, Dimension::none,
              "damaged" + (log.log.damage.empty() ? "" : ", " + log.log.damage));
}

int has_text(lua_State* L) {
  const NamedLog& log = log_of(L);
  const std::string words = check_text(L, 2, "a text");
  const bool found = std::any_of(log.log.texts.begin(), log.log.texts.end(),
                                 [&](const results::ULogText& t) { return t.words == words; });
  return push(L, log, found ? 1.0 : 0.0, Dimension::none, "says '" + words + "'");
}

// ---- Against the run

// The column that tells of a signal, and what makes the one of the other.
struct Twin {
  std::string_view signal, topic, column;
  double factor;
};
constexpr Twin kTwins[] = {
    {"height", kPosition, "z", -1.0},
    {"north", kPosition, "x", 1.0},
    {"east", kPosition, "y", 1.0},
    {"climb", kPosition, "vz", -1.0},
    {"velocity_north", kPosition, "vx", 1.0},
    {"velocity_east", kPosition, "vy", 1.0},
    {"yaw", kPosition, "heading", 1.0},
    {"rate_x", "vehicle_angular_velocity", "xyz[0]", 1.0},
    {"rate_y", "vehicle_angular_velocity", "xyz[1]", 1.0},
    {"rate_z", "vehicle_angular_velocity", "xyz[2]", 1.0},
};

const Twin& twin_of(lua_State* L, const std::string& signal) {
  std::string known;
  for (const Twin& twin : kTwins) {
    if (twin.signal == signal) return twin;
    known += (known.empty() ? "" : ", ") + std::string(twin.signal);
  }
  raise(L, "a log has nothing to hold against '" + signal + "'", "one of: " + known);
}

const RecordInfo& record_at(lua_State* L, int index) {
  return Script::of(L).records[check_handle(L, index, "record")];
}

metrics::Record column_of(lua_State* L, const RecordInfo& info, const std::string& signal) {
  Script& self = Script::of(L);
  const std::size_t column = self.column(L, signal);
  if (std::find(info.columns.begin(), info.columns.end(), column) == info.columns.end()) {
    raise(L, "signal '" + signal + "' is not in this record");
  }
  return self.stage().rows.record(info.number, column);
}

// Of the record at that time, between its rows.
double value_at(const metrics::Record& record, const RecordInfo& info, std::int64_t t_ns) {
  const double rows =
      static_cast<double>(t_ns - info.from_ns) / static_cast<double>(record.step_ns);
  const auto row = static_cast<std::size_t>(rows);
  const double share = rows - static_cast<double>(row);
  const std::size_t at = record.command + row;
  if (at + 1 >= record.values.size()) return record.values.back();
  return (1.0 - share) * record.values[at] + share * record.values[at + 1];
}

// log:error(record, "height"): the largest distance of the log from the record's signal.
int error(lua_State* L) {
  const NamedLog& log = log_of(L);
  const RecordInfo& info = record_at(L, 2);
  const std::string signal = check_text(L, 3, "a signal's name");
  const Twin& twin = twin_of(L, signal);
  const metrics::Record truth = column_of(L, info, signal);
  const auto topic = log.log.topics.find(std::string(twin.topic));
  double worst = kNothing;
  const Dimension dimension = Script::of(L).dimension(Script::of(L).column(L, signal));
  const std::string name = "largest error of " + signal;
  if (topic != log.log.topics.end() && topic->second.columns.count(std::string(twin.column)) != 0) {
    const auto& values = topic->second.columns.at(std::string(twin.column));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto t_ns = static_cast<std::int64_t>(topic->second.time_us[i]) * 1000;
      if (t_ns < info.from_ns || t_ns > info.to_ns) continue;
      double off = twin.factor * values[i] - value_at(truth, info, t_ns);
      if (signal == "yaw") off = std::remainder(off, 2.0 * M_PI);
      if (!(std::abs(off) <= worst)) worst = std::abs(off);
      if (std::isnan(off)) return push(L, log, kNothing, dimension, name);  // and stays it
    }
  }
  return push(L, log, worst, dimension, name);
}

// log:untold(record): of the positions that the radio told in the record's time, those that the log does
// not hold to the last digit. The record has told_north, told_east and told_height.
int untold(lua_State* L) {
  constexpr std::uint64_t kOnItsWay_us = 200'000;
  const NamedLog& log = log_of(L);
  const RecordInfo& info = record_at(L, 2);
  const std::array<metrics::Record, 3> told = {column_of(L, info, "told_north"),
                                               column_of(L, info, "told_east"),
                                               column_of(L, info, "told_height")};
  const ULogTopic none;
  const auto found = log.log.topics.find(kPosition);
  const ULogTopic& topic = found == log.log.topics.end() ? none : found->second;
  const auto holds = [&](std::size_t row, std::uint64_t now_us) {
    const auto at = [&](const char* name, std::size_t i) { return topic.columns.at(name)[i]; };
    const auto end = std::upper_bound(topic.time_us.begin(), topic.time_us.end(), now_us);
    for (auto i = static_cast<std::size_t>(end - topic.time_us.begin()); i-- > 0;) {
      if (topic.time_us[i] + kOnItsWay_us < now_us) return false;
      if (at("x", i) == told[0].values[row] && at("y", i) == told[1].values[row] &&
          -at("z", i) == told[2].values[row]) {
        return true;
      }
    }
    return false;
  };
  double count = 0.0, missing = 0.0;
  for (std::size_t row = told[0].command + 1; row < told[0].values.size(); ++row) {
    const bool news = std::any_of(told.begin(), told.end(), [row](const metrics::Record& r) {
      return r.values[row] != r.values[row - 1];
    });
    if (!news) continue;
    const auto since = static_cast<std::int64_t>(row - told[0].command) * told[0].step_ns;
    count += 1.0;
    if (!holds(row, static_cast<std::uint64_t>((info.from_ns + since) / 1000))) missing += 1.0;
  }
  return push(L, log, count > 0.0 ? missing : kNothing, Dimension::none,
              "told positions that it lacks, of " + std::to_string(static_cast<int>(count)));
}

// t:flight_log("card" [, number]): the newest of the logs on that card, or the first, the second ...
// Where there is none it has no samples, and nothing of it meets a limit.
int flight_log(lua_State* L) {
  Script& self = Script::of(L);
  const std::string device = check_text(L, 2, "the name of a card on the board");
  const auto number = static_cast<std::size_t>(luaL_optinteger(L, 3, 0));
  const auto at = node_place(self.stage().nodes, device);
  if (!at) raise(L, at.error());
  const Node& node = self.stage().nodes[at.value().node];
  if (node.board.find(at.value().rest) == nullptr) {
    raise(L, "unknown device '" + device + "' on " + node.board.name);
  }
  if (self.stage().folder.empty()) raise(L, "a run without a folder has no card to look at");
  const std::string path = self.stage().folder + "/" + at.value().rest +
                           (node.name.empty() ? "" : "_" + node.name) + ".img";
  auto files = results::logs_on_card(path);
  if (!files) raise(L, files.error());
  self.look();
  NamedLog read;
  const std::size_t wanted = number == 0 ? files.value().size() : number;
  read.name = wanted == 0 ? device + ": no log" : "log " + std::to_string(wanted);
  if (wanted >= 1 && wanted <= files.value().size()) {
    read.there = true;
    read.log = results::read_ulog(files.value()[wanted - 1].bytes);
  }
  self.logs.push_back(std::move(read));
  push_handle(L, kLog, self.logs.size() - 1);
  return 1;
}

}  // namespace

void add_log_calls(lua_State* L) {
  const luaL_Reg calls[] = {{"flight_log", flight_log}, {nullptr, nullptr}};
  luaL_setfuncs(L, calls, 0);
  const luaL_Reg methods[] = {{"samples", samples}, {"gap", gap},       {"dropouts", dropouts},
                              {"first", first},     {"last", last},     {"closed", closed},
                              {"damaged", damaged}, {"says", has_text}, {"error", error},
                              {"untold", untold},   {nullptr, nullptr}};
  declare_handle(L, kLog, methods);
}

}  // namespace whirl::plan
