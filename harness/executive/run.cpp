#include "harness/executive/run.hpp"

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "base/digest.hpp"
#include "base/interruption.hpp"
#include "base/mishap.hpp"
#include "base/stopwatch.hpp"
#include "harness/executive/clock_log.hpp"
#include "harness/executive/cpu_fault.hpp"
#include "harness/executive/held_pace.hpp"
#include "harness/executive/task_table.hpp"
#include "harness/lockstep/lockstep.hpp"
#include "harness/plan/script.hpp"
#include "io_bridges/devices/faults.hpp"

namespace whirl {
namespace {

constexpr std::int64_t kProgress_ns = 10 * kLockstep_ns;

// The watchdog that has reset the board, or null.
const char* bitten(const std::vector<results::ResetRecord>& resets) {
  for (const results::ResetRecord& reset : resets) {
    if (reset.cause == io::kResetByIndependentWatchdog) return "independent";
    if (reset.cause == io::kResetByWindowWatchdog) return "window";
  }
  return nullptr;
}

// What only an image that runs brings about: bytes on a bus, a watched function, a set-point, or the
// end of an interrupt's latency. A core that spins on a flag for ever does none of these.
bool is_act_of_firmware(const io::Reader& message) {
  const io::Kind kind = message.header().kind;
  if (kind == io::Kind::can_transfer) {  // of its own: the harness's nodes send, too
    const auto frame = message.as<io::CanRecord>();
    return frame.sender == -1 && frame.error == 0;
  }
  return kind == io::Kind::i2c_transaction || kind == io::Kind::spi_transaction ||
         kind == io::Kind::uart_received || kind == io::Kind::function_call ||
         kind == io::Kind::esc_setpoint || kind == io::Kind::interrupt_latency ||
         kind == io::Kind::i2c_reply;
}

// Bus and address of a fault's place as the board's process counts them (FaultCommand).
std::pair<std::int32_t, std::int32_t> on_wire(const FaultPlace& place) {
  using Numbers = std::pair<std::int32_t, std::int32_t>;
  return std::visit(
      Match{[](const fault_at::Anywhere&) { return Numbers(-1, -1); },
            [](const fault_at::Wire& wire) { return Numbers(wire.bus, wire.address); },
            [](const fault_at::Device& device) { return Numbers(device.bus, device.address); },
            [](const fault_at::Motor& motor) { return Numbers(-1, motor.number); },
            [](const fault_at::Function& function) { return Numbers(-1, function.number); }},
      place);
}

class Run {
 public:
  explicit Run(const RunParts& parts)
      : parts_(parts),
        rows_(columns_of(parts.world), kLockstep_ns),
        logs_(parts.nodes.size()),
        stage_{parts.world,
               parts.target.offers(),
               SignalTable(parts.world.signals()),
               parts.nodes,
               rows_,
               logs_,
               record_.report,
               [this](const FaultSpec& f) { return inject(f); }},
        script_(parts.file, parts.plan, stage_),
        lockstep_(parts.world, parts.target),
        acted_(parts.nodes.size()) {
    stage_.folder = parts.folder;
    stage_.spoils = [&parts](const std::string& what, const std::string& kind) {
      return parts.target.spoils(what, kind);
    };
    stage_.sees = [&parts](const std::string& wires) { return parts.target.sees(wires); };
    results::Report& r = record_.report;
    r.plan = parts.plan.name;
    r.file = parts.plan.file;
    r.tags = parts.plan.tags;
    r.seed = parts.seed;
    r.timing_profile = timing_profile(parts.nodes);
    r.judged = parts.companion == nullptr;
  }

  RunRecord go(const ProgressSink& progress) {
    {
      Stopwatch total(record_.report.host.total_s);
      guarded([&] {
        if (start()) loop(progress);
      });
      guarded([&] { end(); });
    }
    record_.report.host.world_s = lockstep_.host_times().world_s;
    record_.report.host.target_wait_s = lockstep_.host_times().target_wait_s;
    record_.report.virtual_s = static_cast<double>(stage_.now_ns) * 1e-9;
    record_.report.digest = digest_.hex();
    results::conclude(record_.report);
    return std::move(record_);
  }

 private:
  // What has been seen so far is kept whatever is thrown.
  template <typename Part>
  void guarded(Part part) {
    try {
      part();
    } catch (...) {
      end_for(error_of_current_exception());
    }
  }

  bool start() {
    Stopwatch watch(record_.report.host.start_s);
    if (auto started = lockstep_.start(); !started) return ended_by(started.error());
    record_.report.versions = parts_.target.versions();
    for (const DrawnPart& part : parts_.world.drawn_parts()) {
      record_.report.parts.push_back({part.name, part.value, part.unit});
    }
    record_.report.doubts = parts_.world.doubts();
    file_row();
    return true;
  }

  void loop(const ProgressSink& progress) {
    while (act() && accompany() && step()) {
      if (!progress || stage_.now_ns % kProgress_ns != 0) continue;
      progress({static_cast<double>(stage_.now_ns) * 1e-9, script_.step_name(), parts_.world});
    }
  }

  // The script's turn. False: the run is over.
  bool act() {
    Stopwatch watch(record_.report.host.script_s);
    if (stage_.now_ns >= parts_.plan.timeout_ns && parts_.companion == nullptr) return time_out();
    const auto state = script_.advance();
    if (!state) return end_for(state.error());
    completed_ = state.value() == plan::Script::State::done;
    return !completed_ || parts_.companion != nullptr;
  }

  bool accompany() {
    if (parts_.companion == nullptr) return true;
    const auto goes_on = parts_.companion->turn(stage_.now_ns, parts_.world);
    return goes_on ? goes_on.value() : end_for(goes_on.error());
  }

  bool step() {
    const auto arrived = lockstep_.step([this](const io::Batch& sent) {
      Stopwatch watch(record_.report.host.logging_s);
      file_batch(sent);
    });
    Stopwatch watch(record_.report.host.logging_s);
    if (!arrived) return ended_by(arrived.error());
    stage_.now_ns = lockstep_.now_ns();
    file_row();
    log_texts();
    if (parts_.companion != nullptr) {
      parts_.companion->on_happened(stage_.now_ns, lockstep_.happened(), parts_.world);
    }
    if (!file_batch(lockstep_.happened()) || !firmware_is_well()) return false;
    if (interrupted_by() != 0) return interrupted();
    if (arrived.value() == TargetState::running) return true;
    return stopped_early(arrived.value());
  }

  // What the firmware says of itself, for the page and run.json.
  void log_texts() {
    const std::vector<std::string>& texts = parts_.world.told_texts();
    for (; texts_logged_ < texts.size(); ++texts_logged_) {
      record_.report.log.push_back(
          {static_cast<double>(stage_.now_ns) * 1e-9, "firmware", texts[texts_logged_]});
    }
  }

  // The target gave up. What it still told counts; its time stays where it last was, since nothing is
  // known of what came behind.
  bool ended_by(const Error& error) {
    file_batch(lockstep_.happened());
    return interrupted_by() != 0 ? interrupted() : end_for(error);
  }

  bool firmware_failed() const {
    const results::Reason* reason = results::deciding(record_.report.reasons);
    return reason != nullptr && reason->blame == results::Blame::firmware;
  }

  // Says what is wrong with it.
  bool firmware_is_well() {
    for (std::size_t i = 0; i < parts_.nodes.size(); ++i) {
      const results::EventLog& log = logs_[i];
      if (!log.cpu_faults.empty()) return core_fault(parts_.nodes[i], log.cpu_faults.front());
      const char* watchdog = parts_.plan.nodes[i].may_reset ? nullptr : bitten(log.resets);
      if (watchdog != nullptr) return watchdog_reset(parts_.nodes[i], watchdog);
    }
    return true;
  }

  void end() {
    lockstep_.stop();
    file_batch(lockstep_.happened());
    if (!firmware_failed()) firmware_is_well();  // its last words may be a fault
    results::Report& report = record_.report;
    for (std::size_t i = 0; i < parts_.nodes.size(); ++i) report_node(parts_.nodes[i], logs_[i]);
    // Guards and windows are judged also when the run has failed: their figures help to see why.
    for (const Error& error : script_.finish(completed_)) end_for(error);
    report_pace(parts_.target.held_pace(), static_cast<double>(stage_.now_ns) * 1e-9, report);
    if (completed_ && report.judged) judge_faults();
    if (completed_ && report.judged) judge_evidence();
    for (std::size_t i = 0; i < parts_.nodes.size(); ++i) {
      for (const results::TextRecord& f : logs_[i].findings) {
        report.findings.push_back(
            {static_cast<double>(f.t_ns) * 1e-9, parts_.nodes[i].qualified(f.where), f.what});
      }
    }
  }

  // What one board had to say of itself.
  void report_node(const Node& node, const results::EventLog& log) {
    results::Report& report = record_.report;
    if (report.statistics_json.empty()) report.statistics_json = log.statistics;
    if (!node.name.empty()) report.boards.emplace_back(node.name, log.statistics);
    log_clocks(log, node.qualified("RCC"), report);
    for (results::TaskRow& row : task_table(node.board.watch, log)) {
      row.name = node.qualified(row.name);
      report.tasks.push_back(std::move(row));
    }
    for (results::InterruptRow& row : interrupt_table(log)) {
      row.handler = node.qualified(row.handler);
      report.interrupts.push_back(std::move(row));
    }
  }

  // Only a run that came to its end shows that a fault found nobody to act on.
  void judge_faults() {
    for (const results::FaultRow& fault : record_.report.faults) {
      if (fault.applied_s >= 0.0) continue;
      end_for({ErrorKind::bad_input, parts_.plan.file,
               "fault " + fault.kind + " on " + fault.target + " was applied by nobody",
               "is it timed within the run, and does its place see any traffic?"});
    }
  }

  // A pass says something of firmware that runs.
  void judge_evidence() {
    for (std::size_t i = 0; i < acted_.size(); ++i) {
      if (acted_[i]) continue;
      const std::string& name = parts_.nodes[i].name;
      end_with(results::Blame::not_shown,
               (name.empty() ? "the image" : "the image of " + name) +
                   " was never seen to run: no byte on a bus, no call of a watched function, "
                   "no interrupt served");
    }
    if (!script_.has_looked()) {
      end_with(
          results::Blame::not_shown,
          "the plan asserts nothing about the running image: it reads no signal, no answer and "
          "no window");
    }
  }

  // Always false, for `return end_with(...)`.
  bool end_with(results::Blame blame, const std::string& what) {
    record_.report.reasons.push_back({blame, what});
    return false;
  }

  bool end_for(const Error& error) {
    record_.report.reasons.push_back(results::reason_of(error));
    return false;
  }

  void must_hold(const std::string& name, const std::string& note) {
    results::Expectation e;
    e.name = name;
    e.how = "holds";
    e.place = parts_.plan.place;
    e.t_s = static_cast<double>(stage_.now_ns) * 1e-9;
    e.note = note;
    e.measured = std::numeric_limits<double>::quiet_NaN();
    e.margin = e.measured;
    script_.add(std::move(e));
  }

  bool interrupted() {
    return end_with(results::Blame::host,
                    std::string("interrupted by signal ") + signal_word(interrupted_by()));
  }

  bool time_out() {
    char limit[40];
    std::snprintf(limit, sizeof limit, "%g s", static_cast<double>(parts_.plan.timeout_ns) * 1e-9);
    const std::string where =
        script_.step_name().empty() ? "" : " in step '" + script_.step_name() + "'";
    must_hold("plan ends before its timeout", "still waiting" + where);
    return end_with(
        results::Blame::firmware,
        "still waiting" + where + " at the plan's timeout of " + limit + " virtual time");
  }

  bool core_fault(const Node& node, const results::CpuFaultRecord& record) {
    results::CpuFaultRow row = describe(record);
    row.where = node.qualified(row.where);
    record_.report.cpu_faults.push_back(row);
    must_hold("the firmware runs without a fault", row.name + " in " + row.where);
    return end_with(results::Blame::firmware, "firmware fault: " + row.name + " in " + row.where);
  }

  bool watchdog_reset(const Node& node, const char* watchdog) {
    const std::string whose = node.name.empty() ? "" : node.name + ": ";
    const std::string what = whose + "reset by the " + watchdog + " watchdog";
    must_hold("the firmware keeps its watchdogs fed", what);
    return end_with(results::Blame::firmware, "firmware fault: " + what);
  }

  bool stopped_early(TargetState state) {
    if (state == TargetState::over_limit) {
      must_hold("the bench stays within its limits", parts_.target.why_ended());
      return end_with(results::Blame::firmware, parts_.target.why_ended());
    }
    const char* what =
        state == TargetState::cpu_locked ? "the core locked up" : "the board switched itself off";
    must_hold("the firmware runs to the end of the plan", what);
    return end_with(results::Blame::firmware, what);
  }

  void file_row() {
    rows_.append(lockstep_.row(), parts_.world.ages_ns());
    if (parts_.messages != nullptr) parts_.messages->add_row(stage_.now_ns, lockstep_.row());
  }

  bool file_batch(const io::Batch& batch) {
    if (parts_.messages != nullptr) parts_.messages->add(batch);
    digest_.add_bytes(batch.bytes().data(), batch.bytes().size());
    io::Reader r(batch.bytes());
    while (r.next()) {
      const std::size_t board = r.header().board;
      if (board >= logs_.size()) {
        return end_for({ErrorKind::internal, "", "a message of a board that is not there", ""});
      }
      acted_[board] = acted_[board] || is_act_of_firmware(r);
      logs_[board].add(r);
    }
    if (r.complete()) return true;
    return end_for({ErrorKind::internal, "", "a batch of messages was cut short", ""});
  }

  Result<Done> inject(const FaultSpec& spec) {
    const auto kind = io::fault_kind(spec.kind);
    if (!kind)
      return Error{ErrorKind::bad_input, "", "unknown kind of fault '" + spec.kind + "'", ""};
    io::FaultCommand command;
    command.number = spec.number;
    command.kind = static_cast<std::uint32_t>(*kind);
    command.start_ns = spec.start_ns;
    command.end_ns = spec.end_ns;
    std::tie(command.bus, command.address) = on_wire(spec.place);
    command.axis = spec.axis;
    command.value = spec.value;
    io::Batch order;
    order.add(io::Kind::fault, static_cast<std::uint16_t>(spec.number), stage_.now_ns, command,
              spec.kind.data(), static_cast<std::uint32_t>(spec.kind.size()));
    io::add_for_board(order, spec.board, lockstep_.to_send());
    return Done{};
  }

  const RunParts& parts_;
  RunRecord record_;
  plan::SignalRows rows_;
  std::vector<results::EventLog> logs_;  // of the nodes
  plan::Stage stage_;
  plan::Script script_;
  Lockstep lockstep_;
  Digest digest_;
  bool completed_ = false;  // the script has returned
  std::size_t texts_logged_ = 0;
  std::vector<bool> acted_;  // of the nodes: their firmware was seen to run
};

}  // namespace

RunRecord execute(const RunParts& parts, const ProgressSink& progress) {
  return Run(parts).go(progress);
}

}  // namespace whirl
