// What a plan asks of its targets, and whether they offer it.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/plan/plan_file.hpp"
#include "harness/target/offers.hpp"
#include "harness/world/signal_table.hpp"

namespace whirl::plan {

struct Need {
  Offer offer = Offer::virtual_time;
  std::string what, place;  // "t:budget", "hover.lua:31"
};

// What a call of this name asks: budget, bus, can, latency, fault. Of a fault only the plan's run shows where
// it is to act.
std::vector<Offer> needs_of_call(const std::string& call);
// By its keys and by the calls in its function's text.
std::vector<Need> needs_of(const Plan& plan);

// Errors  bad_input, with the plan's line: its text names a signal that `elsewhere` has and `here` has not
Result<Done> check_signals(const Plan& plan, const std::vector<Signal>& here,
                           const std::vector<Signal>& elsewhere);

// Errors  bad_input, with the plan's line: its text names a kind of fault that does not act here
Result<Done> check_faults(const Plan& plan, const std::function<bool(const std::string&)>& acts);

// In one sentence, for who asks: "t:budget".
std::string not_offered(const std::string& what, Offer offer);

// Errors  bad_input, with the plan's line: the first need that is not met
Result<Done> check_offers(const Plan& plan, const Offers& offers);

}  // namespace whirl::plan
