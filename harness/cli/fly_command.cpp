#include "harness/cli/fly_command.hpp"

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "harness/cli/bench_choice.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/run_one.hpp"
#include "harness/live/live_flight.hpp"
#include "harness/live/pilot_stick.hpp"
#include "io_bridges/hid/hid_device.hpp"

namespace whirl::cli {
namespace {

std::atomic<bool> end_wanted{false};

// Here a signal is the ordinary end, not an interruption of what was to be shown.
void catch_end() {
  struct sigaction action {};
  action.sa_handler = [](int) { end_wanted.store(true); };
  action.sa_flags = SA_RESETHAND;  // the second one acts as ever
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

Result<PlanChoice> choose(const FlyOptions& options, RunOptions run,
                          const Composition& composition) {
  const bool usual = options.plan.empty();
  run.paths = {usual ? composition.root + "/test_plans/flight/free.lua" : options.plan};
  const FoundPlans found = find_plans(run, composition.root);
  if (!found.errors.empty()) return found.errors.front();
  if (found.plans.size() != 1) {
    return Error{ErrorKind::bad_input, run.paths[0],
                 "holds " + std::to_string(found.plans.size()) + " plans, one is flown",
                 "choose it by --only NAME"};
  }
  const PlanChoice& plan = found.plans.front();
  if (plan.vehicle.empty()) {
    return Error{ErrorKind::bad_input, plan.file, plan.name + " has a stand, and no radio",
                 "choose a plan with a vehicle"};
  }
  return plan;
}

Settings settings_of(const FlyOptions& options) {
  Settings settings;
  for (const auto& [key, value] : {std::pair{"plan.image", options.image},
                                   {"plan.board", options.board},
                                   {"plan.vehicle", options.vehicle}}) {
    if (!value.empty()) settings.push_back({key, value});
  }
  return settings;
}

// A path counts from elsewhere when the recorded plan is read in its folder.
std::string from_anywhere(const std::string& written) {
  const bool path =
      written.find('/') != std::string::npos || written.find('.') != std::string::npos;
  std::error_code status;
  if (!path || !std::filesystem::exists(written, status)) return written;
  return std::filesystem::absolute(written, status).string();
}

live::FlownPlan flown_plan(const plan::Plan& plan, const std::vector<std::string>& taken_in,
                           const FlyOptions& options, const live::LiveFlight& flight) {
  live::FlownPlan flown;
  flown.file = plan.file;
  flown.name = plan.name;
  flown.taken_in = taken_in;
  for (const Setting& setting : settings_of(options)) {
    flown.settings.emplace_back(setting.key.substr(5), from_anywhere(setting.value));  // "plan."
  }
  flown.end_ns = flight.ended_ns();
  for (const char* signal : {"north", "east", "height"}) {
    const double value_m = flight.last(signal);
    if (std::isfinite(value_m)) flown.end_m.emplace_back(signal, value_m);
  }
  return flown;
}

Result<live::PilotStick> plug_in(const std::string& file) {
  auto map = live::read_stick(file);
  if (!map) return map.error();
  auto port = io::open_hid(map.value().device);
  if (!port) return port.error();
  return live::PilotStick::start(std::move(port.value()), std::move(map.value()));
}

void show(const std::string& line) {
  const bool in_place = is_terminal();
  std::fprintf(in_place ? stderr : stdout, in_place ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(in_place ? stderr : stdout);
}

}  // namespace

int fly_command(const FlyOptions& options, const RunOptions& run, const Composition& composition) {
  RunOptions chosen = run;
  chosen.settings = settings_of(options);
  if (const auto good = check_bench_options(chosen); !good) return complain(good.error());
  const auto plan = choose(options, chosen, composition);
  if (!plan) return complain(plan.error());
  auto port = live::UdpPort::open(options.udp, options.listen);
  if (!port) return complain(port.error());
  std::optional<live::PilotStick> stick;
  if (!options.stick.empty()) {
    auto plugged = plug_in(options.stick);
    if (!plugged) return complain(plugged.error());
    stick.emplace(std::move(plugged.value()));
  }
  catch_end();
  const bool on_bench = !run.target.empty();
  char at[60];
  std::snprintf(at, sizeof at, "at %g x real time", options.pace);
  std::printf("flying %s %s; MAVLink to UDP %s, and from %s at port %u. %s ends.\n",
              plan.value().name.c_str(), on_bench ? ("on " + run.target).c_str() : at,
              options.udp.c_str(), on_bench ? "its host" : "any",
              static_cast<unsigned>(port.value().own_port()),
              options.seconds > 0.0 ? "Its time, or Ctrl-C," : "Ctrl-C");
  std::fflush(stdout);
  pacing::MonotonicClock clock;
  live::LiveOptions live;
  live.pace = options.pace;
  live.waits = !on_bench;
  live.client_only = on_bench;
  if (options.seconds > 0.0) live.end_ns = std::llround(options.seconds * 1e9);
  live.wants_end = [] { return end_wanted.load(); };
  live.show = show;
  if (stick) live.sticks = [&stick] { return stick->read(); };
  live::LiveFlight flight(clock, std::move(port.value()), live);
  const Company company{
      flight, [&](const std::string& folder, results::Report& report, const plan::Plan& flown,
                  const std::vector<std::string>& taken_in) {
        for (const std::string& line : flight.summary()) {
          report.log.push_back({static_cast<double>(flight.ended_ns()) * 1e-9, "fly", line});
        }
        live::FlownPlan all = flown_plan(flown, taken_in, options, flight);
        all.seed = report.seed;
        return flight.recording().write(folder, all);
      }};
  const Finished finished = run_one(plan.value(), chosen, composition, nullptr, &company);
  clear_progress();
  std::fputs(outcome(finished).c_str(), stdout);
  for (const std::string& line : flight.summary()) std::printf("       %s\n", line.c_str());
  if (finished.report.verdict == results::Verdict::none) {
    std::printf(
        "       no verdict: what was commanded is not in the plan. %s\n"
        "       whirl run %s\n",
        on_bench ? "The same commands on the virtual board:" : "The same flight again:",
        shown_path(finished.folder + "/commands.lua").c_str());
  }
  return results::exit_code(finished.report);
}

}  // namespace whirl::cli
