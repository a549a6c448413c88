// Scenarios by hand, for facts of the judging one by one: a few lines of Lua against signals and
// messages that the test gives.
#pragma once
#include <gtest/gtest.h>

#include <utility>

#include "base/scratch_folder.hpp"
#include "harness/tests/oracle/judged.hpp"

namespace whirl::oracle {

inline Scenario playing(const std::string& lua) {
  Scenario s;
  s.lua = lua;
  s.timeout_ms = 10'000;
  s.functions.emplace_back("fw::task");
  s.i2c_devices.emplace_back("esc1");
  s.now_ms = 1;
  s.add_heartbeat();
  return s;
}

inline Scenario with_signal(const std::string& lua, std::function<double(int)> at) {
  Scenario s = playing(lua);
  s.signals.push_back({"x", Dimension::length, std::move(at)});
  return s;
}

// x is 1 m and rises by a millimetre per ms, y is 2 N.
inline Scenario with_two_signals(const std::string& lua) {
  Scenario s = with_signal(lua, [](int ms) { return 1.0 + 0.001 * ms; });
  s.signals.push_back({"y", Dimension::force, [](int) { return 2.0; }});
  return s;
}

inline void add_call(Scenario& s, std::int64_t entry_ns, std::int64_t return_ns,
                     std::int64_t execution_ns = 1000, std::int64_t latency_ns = 500) {
  s.messages.push_back({return_ns, [=](io::Batch& batch) {
                          batch.add(io::Kind::function_call, 1, return_ns,
                                    io::FunctionCall{entry_ns, execution_ns, latency_ns});
                        }});
}

inline results::Report report_of(const Scenario& s) {
  const ScratchFolder folder;
  return run_scenario(s, folder.file("plan.lua"));
}

// The only expectation of the plan.
inline results::Expectation only(const Scenario& s) {
  const results::Report report = report_of(s);
  EXPECT_EQ(report.expectations.size(), 1u) << report.reason;
  return report.expectations.empty() ? results::Expectation{} : report.expectations.front();
}

inline bool passes(const Scenario& s) {
  return results::exit_code(report_of(s)) == 0;
}

}  // namespace whirl::oracle
