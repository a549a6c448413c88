#include "harness/tests/oracle/judged.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "harness/executive/run.hpp"
#include "io_bridges/devices/faults.hpp"

namespace whirl::oracle {
namespace {

// Plays the signals by the clock.
class PlayedWorld final : public World {
 public:
  explicit PlayedWorld(const Scenario& scenario) : scenario_(scenario) {
    for (const Signal& s : scenario.signals) signals_.push_back({s.name, s.dimension, ""});
    signals_.push_back({"idle", Dimension::none, ""});
  }
  const std::vector<whirl::Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override {
    for (std::size_t i = 0; i < scenario_.signals.size(); ++i)
      values[i] = scenario_.signals[i].at(now_ms_);
    values.back() = 0.0;
  }
  void step(std::int64_t t_ns, const io::Batch&, io::Batch& sensed) override {
    now_ms_ = static_cast<int>(t_ns / kMs);
    sensed.add(io::Kind::body_motion, 0, t_ns, io::BodyMotion{});
    std::erase_if(coming_, [&](const auto& line) {
      if (line.first > now_ms_) return false;
      heard_.push_back(line.second);
      return true;
    });
  }
  Result<Done> command(const Command&, std::int64_t now_ns) override {
    const auto wire = scenario_.wires_ns.find(static_cast<int>(now_ns / kMs));
    if (wire != scenario_.wires_ns.end()) wire_ns_ = wire->second;
    return Done{};
  }
  Result<Done> disturb(const Disturbance&, std::int64_t) override { return Done{}; }
  Result<Done> say(const std::string& line) override {
    const auto answer = scenario_.answers.find(line);
    if (answer == scenario_.answers.end()) return Done{};
    coming_.emplace_back(now_ms_ + answer->second.after_ms, answer->second.text);
    return Done{};
  }
  const std::vector<std::string>& heard() const override { return heard_; }
  std::int64_t command_on_wire_ns() const override { return wire_ns_; }
  Result<bool> take_fault(const FaultSpec& fault) override {
    const auto mine = scenario_.world_faults.find(fault.kind);
    if (mine == scenario_.world_faults.end()) return false;
    if (mine->second) applied_.push_back(fault.number);
    return true;
  }
  std::vector<std::uint32_t> applied_faults() const override { return applied_; }
  std::string status() const override { return "played"; }

 private:
  const Scenario& scenario_;
  std::vector<whirl::Signal> signals_;
  int now_ms_ = 0;
  std::int64_t wire_ns_ = -1;
  std::vector<std::pair<int, std::string>> coming_;
  std::vector<std::string> heard_;
  std::vector<std::uint32_t> applied_;
};

// Delivers the messages by their times, and ends as the scenario says.
class PlayedTarget final : public Target {
 public:
  explicit PlayedTarget(const Scenario& scenario)
      : scenario_(scenario), messages_(scenario.messages) {
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const Message& a, const Message& b) { return a.t_ns < b.t_ns; });
  }
  Result<Done> start() override {
    if (scenario_.ending == Ending::no_start_host)
      return Error{ErrorKind::host, "host", "too small", ""};
    if (scenario_.ending == Ending::no_start_image)
      return Error{ErrorKind::bad_input, "image", "is none", ""};
    return Done{};
  }
  void run(std::int64_t until_ns, const io::Batch& sensed) override {
    until_ns_ = until_ns;
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind != io::Kind::fault) continue;
      faults_.push_back(r.as<io::FaultCommand>());
      if (scenario_.on_fault) scenario_.on_fault(faults_.back());
    }
  }
  Result<TargetState> arrive(io::Batch& happened) override {
    const bool now = until_ns_ == scenario_.ending_ms * kMs;
    const Ending ending = scenario_.ending;
    if (now && ending == Ending::core_fault_with_late_host) add_fault(happened);
    if (now && (ending == Ending::late_host || ending == Ending::core_fault_with_late_host)) {
      return Error{ErrorKind::host, "host", "too late", ""};
    }
    if (now && ending == Ending::lost_target)
      return Error{ErrorKind::internal, "board", "no answer", ""};
    for (; next_ < messages_.size() && messages_[next_].t_ns <= until_ns_; ++next_)
      messages_[next_].add(happened);
    apply_faults(happened);
    if (now && ending == Ending::core_fault) add_fault(happened);
    if (now && (ending == Ending::watchdog || ending == Ending::watchdog_allowed)) {
      happened.add(io::Kind::board_reset, io::kResetByIndependentWatchdog, until_ns_ - 1, nullptr,
                   0);
    }
    if (now && ending == Ending::cut_batch) cut(happened);
    if (now && ending == Ending::locks_up) return TargetState::cpu_locked;
    if (now && ending == Ending::switches_off) return TargetState::ended;
    return TargetState::running;
  }
  void stop(io::Batch& rest) override {
    if (scenario_.last_words) scenario_.last_words(rest);
  }
  Offers offers() const override { return kAll_offers; }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return {{"target", "played"}};
  }

 private:
  void add_fault(io::Batch& happened) const {
    io::CpuFault fault;
    fault.exception = 3;
    fault.pc = 0x08001234;
    const std::string trace = "fw::wrong+0x4 at 0x08001234";
    happened.add(io::Kind::cpu_fault, 0, until_ns_ - 1, fault, trace.data(),
                 static_cast<std::uint32_t>(trace.size()));
  }
  static void cut(io::Batch& happened) {
    const std::uint8_t byte = 0;
    happened.add(io::Kind::uart_received, 1, 0, &byte, 1);
    const std::vector<std::uint8_t> all(happened.bytes().begin(), happened.bytes().end() - 1);
    happened.assign(all);
  }
  void apply_faults(io::Batch& happened) {
    std::erase_if(faults_, [&](const io::FaultCommand& fault) {
      if (fault.start_ns > until_ns_) return false;
      happened.add(io::Kind::fault_applied, static_cast<std::uint16_t>(fault.number), until_ns_ - 1,
                   nullptr, 0);
      return true;
    });
  }

  const Scenario& scenario_;
  std::vector<Message> messages_;
  std::size_t next_ = 0;
  std::int64_t until_ns_ = 0;
  std::vector<io::FaultCommand> faults_;
};

BoardDescription board_of(const Scenario& scenario) {
  BoardDescription board;
  board.name = "played";
  for (const std::string& name : scenario.spi_devices) {
    BoardDevice device;
    device.name = name;
    device.bus = "spi1";
    device.senses = {"accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z"};
    board.devices.push_back(device);
  }
  int address = 0x29;
  for (const std::string& name : scenario.i2c_devices) {
    BoardDevice device;
    device.name = name;
    device.bus = "i2c3";
    device.address = address++;
    board.devices.push_back(device);
  }
  for (const OtherDevice& other : scenario.other_devices) {
    BoardDevice device;
    device.name = other.name;
    device.bus = other.bus;
    device.address = other.address;
    device.motor = other.motor;
    if (other.host_on_can != 0) {
      device.type = "pod_parts";
      device.keys["params.can"] = static_cast<double>(other.host_on_can);
    }
    board.devices.push_back(device);
  }
  board.watch = scenario.functions;
  return board;
}

bool close(double got, double want, double tolerance) {
  if (tolerance == kAnything || (std::isnan(got) && std::isnan(want))) return true;
  return std::abs(got - want) <= tolerance;
}

bool agrees(const Told& right, const results::Expectation& got, std::ostringstream& out) {
  const bool passed = got.verdict == results::Verdict::pass,
             failed = got.verdict == results::Verdict::fail;
  const bool verdict = right.right == Right::any || (right.right == Right::pass && passed) ||
                       (right.right == Right::fail && failed) ||
                       (right.right == Right::unshown && !passed);
  const bool figures = right.right == Right::any || right.right == Right::unshown ||
                       (close(got.measured, right.measured, right.tolerance) &&
                        close(got.margin, right.margin, 2 * right.tolerance));
  if (verdict && figures) return true;
  static const char* const kWords[] = {"pass", "fail", "no pass", "anything"};
  out << right.name << ": said " << name(got.verdict) << ", measured " << got.measured << " margin "
      << got.margin << "; right is " << kWords[static_cast<int>(right.right)] << ", "
      << right.measured << " margin " << right.margin << " +- " << right.tolerance << "\n";
  return false;
}

}  // namespace

std::string plan_text(const Scenario& s) {
  return "plan 'p' { image = 'x', vehicle = 'x', timeout = '" + std::to_string(s.timeout_ms) +
         " ms', tags = { 'played' }," +
         (s.ending == Ending::watchdog_allowed ? " may_reset = true," : "") +
         " run = function(t)\n" + s.lua + "end }\n";
}

results::Report run_scenario(const Scenario& scenario, const std::string& file,
                             const ProgressSink& progress) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << plan_text(scenario);
  auto loaded = plan::PlanFile::load(file, scenario.limits);
  if (!loaded) {
    results::Report report;
    report.reason = loaded.error().message();
    return report;
  }
  const std::vector<Node> nodes{{"", board_of(scenario), scenario.joined}};
  PlayedWorld world(scenario);
  PlayedTarget target(scenario);
  const RunParts parts{*loaded.value(), loaded.value()->plans().front(), nodes, world, target, 1};
  return execute(parts, progress).report;
}

std::string complaint(const Outcome& right, const results::Report& report) {
  std::ostringstream out;
  out.precision(17);
  const int code = results::exit_code(report);
  if (std::find(right.codes.begin(), right.codes.end(), code) == right.codes.end()) {
    out << "exit code " << code << " (" << report.reason << "), right is " << right.codes.front()
        << "\n";
  }
  if ((code == 0) != report.reason.empty())
    out << "exit code " << code << " with the reason '" << report.reason << "'\n";
  for (const Told& told : right.told) {
    const auto got =
        std::find_if(report.expectations.begin(), report.expectations.end(),
                     [&](const results::Expectation& e) { return e.name == told.name; });
    if (got == report.expectations.end()) {
      if (told.right != Right::any) out << told.name << ": not told\n";
      continue;
    }
    agrees(told, *got, out);
  }
  for (const results::Expectation& e : report.expectations) {
    const bool known =
        e.how == "holds" || std::any_of(right.told.begin(), right.told.end(),
                                        [&](const Told& told) { return told.name == e.name; });
    if (!known) out << e.name << ": told of nothing that was asked\n";
  }
  return out.str();
}

}  // namespace whirl::oracle
